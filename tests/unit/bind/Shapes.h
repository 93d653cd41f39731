// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <array>
#include <functional>
#include <string>
#include <vector>

/// Small generated skins and skeletons that fit them.
namespace shapes {

/// A closed cylinder along +y from y = 0 to `length`, radius 1, rings 0.25 apart.
osgSkin::SkinMesh cylinder(double length = 8.0, int sides = 16);

/// Joints in a chain along +y at the given heights; the last one's tip is at `end`.
osgSkin::RestSkeleton chainAlongY(const std::vector<double>& heights, double end);

/// Cells of the unit grid that a solid fills.
using Filled = std::function<bool(int x, int y, int z)>;

/// The surface of all filled cells with indices in [-range, range): one closed skin of quads, each
/// `cell` wide; corner (i, j, k) is at cell * (i, j, k).
osgSkin::SkinMesh voxelSurface(const Filled& filled, int range, double cell);

/// A trunk with two arms that hang down close beside it, in cells of 0.25: the trunk |x| < 1, -4 <
/// y < 2; the arms 1.25 < |x| < 2, -4 < y < 2, joined to the trunk from y = 1 up.
osgSkin::SkinMesh hangingArms();

/// hips (0,-3), chest (0,1), and on each side shoulder, elbow and hand down the arm.
osgSkin::RestSkeleton hangingArmsSkeleton();

/// Adds a joint to the skeleton, below the named parent ("" for the root).
void addJoint(osgSkin::RestSkeleton& skeleton, const std::string& name, const std::string& parent,
              const glm::dvec3& centre);

/// The same mesh with a separate vertex for every corner of every face.
osgSkin::SkinMesh exploded(const osgSkin::SkinMesh& mesh);

/// Both meshes in one, as two shells.
osgSkin::SkinMesh joined(const osgSkin::SkinMesh& a, const osgSkin::SkinMesh& b);

/// A copy of the body's triangles whose corners are all to be covered, a distance above the body.
/// Its vertices are in the body's order.
osgSkin::SkinMesh garment(const osgSkin::SkinMesh& body,
                          const std::function<bool(const glm::dvec3&)>& isCovered, double distance);

osgSkin::SkinMesh moved(osgSkin::SkinMesh mesh, const glm::dvec3& by, double scale = 1.0);

/// A square of triangles, two units wide, about the origin in the plane z = 0.
osgSkin::SkinMesh sheet(std::uint32_t side);

} // namespace shapes
