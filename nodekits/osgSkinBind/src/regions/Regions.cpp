// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/Regions.h"

#include "regions/AssignUnreached.h"
#include "regions/ClaimRegions.h"
#include "regions/FloodRegions.h"
#include "regions/RemoveIslands.h"
#include "regions/SeedRegions.h"
#include "regions/TrimRegions.h"

namespace osgSkin {
namespace {

/// Fractions of the time that have passed when the steps begin, measured at 280,000 vertices.
constexpr double kFloodingBegins = 0.3;
constexpr double kBordersBegin = 0.9;

/// Gives joints the skin beyond them, and no other: what else they have goes to the region above.
void giveBeyond(const std::vector<PlannedJoint>& joints, std::vector<std::uint32_t>& jointOf) {
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (joints[j].beyond.empty()) continue;
        const std::vector<bool> isBelow = subtreeOf(joints, j);
        const auto above = static_cast<std::uint32_t>(regionAbove(joints, j));
        std::vector<bool> isBeyond(jointOf.size(), false);
        for (const std::uint32_t v : joints[j].beyond) isBeyond[v] = true;
        for (std::size_t v = 0; v < jointOf.size(); ++v) {
            if (isBeyond[v] && !isBelow[jointOf[v]]) jointOf[v] = j;
            if (!isBeyond[v] && isBelow[jointOf[v]]) jointOf[v] = above;
        }
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
    giveBeyond(joints, regions.jointOf);
    return regions;
}

} // namespace osgSkin
