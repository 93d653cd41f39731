// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/Regions.h"

#include "regions/AssignUnreached.h"
#include "regions/ClaimRegions.h"
#include "regions/FloodRegions.h"
#include "regions/RemoveIslands.h"
#include "regions/SeedRegions.h"
#include "regions/SpreadRegions.h"
#include "regions/TrimRegions.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// Fractions of the time that have passed when the steps begin, measured at 280,000 vertices.
constexpr double kFloodingBegins = 0.3;
constexpr double kBordersBegin = 0.9;

/// Distance of a point to a bone; a last bone goes on to its last sample.
double distanceToDigit(const PlannedJoint& joint, const glm::dvec3& point) {
    PlannedJoint bone = joint;
    if (bone.child < 0 && !bone.samples.empty())
        bone.boneLength =
            std::max(bone.boneLength, glm::distance(bone.centre, bone.samples.back()));
    return distanceToBone(bone, point);
}

/// Gives the joints of fingers and toes the skin beyond them that is of joints above, and farther
/// from the bones of these. A rig may have one finger for four.
void extendDigits(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf) {
    std::vector<std::vector<std::uint32_t>> digitsBelow(joints.size());
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].digit || !joints[j].holdsRegion) continue;
        for (std::size_t above = j; joints[above].digit;) {
            above = static_cast<std::size_t>(joints[above].parent);
            digitsBelow[above].push_back(j);
        }
    }
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        const std::uint32_t owner = jointOf[v];
        double nearest = distanceToBone(joints[owner], p);
        for (const std::uint32_t j : digitsBelow[owner]) {
            if (glm::dot(p - joints[j].centre, planeNormal(joints[j])) <= 0.0) continue;
            const double distance = distanceToDigit(joints[j], p);
            if (distance >= nearest) continue;
            nearest = distance;
            jointOf[v] = j;
        }
    }
}

/// Gives joints the skin beyond them, and no other: what else they have goes to the regions beside
/// it.
void giveBeyond(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                std::vector<std::uint32_t>& jointOf) {
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (joints[j].beyond.empty()) continue;
        const std::vector<bool> isBelow = subtreeOf(joints, j);
        std::vector<bool> isBeyond(jointOf.size(), false);
        for (const std::uint32_t v : joints[j].beyond) isBeyond[v] = true;
        for (std::size_t v = 0; v < jointOf.size(); ++v) {
            if (isBeyond[v] && !isBelow[jointOf[v]])
                jointOf[v] = j;
            else if (!isBeyond[v] && isBelow[jointOf[v]])
                jointOf[v] = Regions::kNone;
        }
        // Not from the extremity's side: it is unlabelled for that long.
        std::vector<std::uint32_t> others = jointOf;
        for (const std::uint32_t v : joints[j].beyond) others[v] = Regions::kNone;
        spreadRegions(mesh, others);
        for (std::size_t v = 0; v < jointOf.size(); ++v)
            if (jointOf[v] == Regions::kNone) jointOf[v] = others[v];
        assignUnreached(mesh, joints, jointOf);
    }
}

} // namespace

Regions findRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                    const Progress& progress) {
    const auto tell = [&progress](const char* what, double fraction) {
        if (progress) progress({what, fraction});
    };
    tell("Delaunay step", 0.0);
    Regions regions = seedRegions(mesh, joints);
    regions.seedOf = regions.jointOf;
    std::vector<bool> isSeed(mesh.vertexCount());
    for (std::size_t v = 0; v < isSeed.size(); ++v)
        isSeed[v] = regions.jointOf[v] != Regions::kNone;

    tell("flooding", kFloodingBegins);
    floodRegions(mesh, regions.jointOf);
    tell("borders of regions", kBordersBegin);
    assignUnreached(mesh, joints, regions.jointOf);
    claimRegions(mesh, joints, regions.jointOf);
    // What moves with a rigid joint is one region, the rigid joint's.
    for (std::uint32_t& joint : regions.jointOf)
        if (joints[joint].rigid >= 0) joint = static_cast<std::uint32_t>(joints[joint].rigid);
    trimRegions(mesh, joints, regions.jointOf);
    removeIslands(mesh, isSeed, regions.jointOf);
    extendDigits(mesh, joints, regions.jointOf); // whose regions may have several parts
    giveBeyond(mesh, joints, regions.jointOf);
    return regions;
}

} // namespace osgSkin
