// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <array>
#include <functional>
#include <string>
#include <vector>

/// Small generated skins and the skeletons that go into them.
namespace shapes {

/// A closed cylinder along +y from y = 0 to `length`, radius 1, rings 0.25 apart.
osgSkin::SkinMesh cylinder(double length = 8.0, int sides = 16);

/// Joints one below the other along +y at the given heights; the last one's tip is at `end`.
osgSkin::RestSkeleton chainAlongY(const std::vector<double>& heights, double end);

/// Cells of the unit grid that a solid fills.
using Filled = std::function<bool(int x, int y, int z)>;

/// The surface of all filled cells with indices in [-range, range): one closed skin of quads,
/// `cell` wide, whose corner (i, j, k) lies at cell * (i, j, k).
osgSkin::SkinMesh voxelSurface(const Filled& filled, int range, double cell);

/// A trunk with two arms that hang down close beside it, as cells of 0.25: the trunk |x| < 1,
/// -4 < y < 2; the arms 1.25 < |x| < 2, -4 < y < 2, joined to the trunk from y = 1 up.
osgSkin::SkinMesh hangingArms();

/// hips (0,-3), chest (0,1), and for each side shoulder, elbow and hand down the arm.
osgSkin::RestSkeleton hangingArmsSkeleton();

/// Adds a joint to the skeleton; the parent is named, "" for the root.
void addJoint(osgSkin::RestSkeleton& skeleton, const std::string& name, const std::string& parent,
              const glm::dvec3& centre);

/// The same mesh with a vertex of its own for every corner of every face.
osgSkin::SkinMesh exploded(const osgSkin::SkinMesh& mesh);

/// Both meshes as one, with two shells.
osgSkin::SkinMesh joined(const osgSkin::SkinMesh& a, const osgSkin::SkinMesh& b);

/// A copy of the triangles of a body all of whose corners are to be covered, a distance above it.
/// Its vertices are in the body's order.
osgSkin::SkinMesh garment(const osgSkin::SkinMesh& body,
                          const std::function<bool(const glm::dvec3&)>& isCovered, double distance);

osgSkin::SkinMesh moved(osgSkin::SkinMesh mesh, const glm::dvec3& by, double scale = 1.0);

} // namespace shapes
