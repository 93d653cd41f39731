// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/Regions.h"

#include "mesh/InsideSkin.h"
#include "mesh/NearestPoints.h"
#include "regions/FloodRegions.h"
#include "regions/RemoveIslands.h"
#include "regions/SeedRegions.h"
#include "regions/SpreadRegions.h"
#include "regions/TrimRegions.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace osgSkin {
namespace {

/// Fractions of the time that have passed when the steps begin, measured at 280,000 vertices.
constexpr double kFloodingBegins = 0.3;
constexpr double kBordersBegin = 0.9;

struct NearBone {
    std::uint32_t joint = 0; ///< the root, where no joint may hold a region
    double distance = std::numeric_limits<double>::infinity();
};

NearBone nearestBone(const glm::dvec3& p, const std::vector<PlannedJoint>& joints) {
    NearBone best;
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const double distance = distanceToBone(joints[j], p);
        if (distance < best.distance) best = {j, distance};
    }
    return best;
}

/// Labels what flooding cannot reach: vertices like the nearest labelled vertex or the nearest
/// bone, whichever is nearer. So a button goes with the skin below it, and a lined coat that has no
/// body in it with the bones.
void assignUnreached(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                     std::vector<std::uint32_t>& jointOf) {
    std::vector<std::uint32_t> labelled, unreached;
    for (std::uint32_t v = 0; v < jointOf.size(); ++v)
        (jointOf[v] == Regions::kNone ? unreached : labelled).push_back(v);
    if (unreached.empty()) return;

    std::vector<std::uint32_t> nearest;
    if (!labelled.empty()) nearest = nearestPoints(mesh.positions, labelled, unreached);
    for (std::size_t i = 0; i < unreached.size(); ++i) {
        const glm::dvec3& p = mesh.positions[unreached[i]];
        const NearBone bone = nearestBone(p, joints);
        const bool isSkinNearer =
            !nearest.empty() && glm::distance(p, mesh.positions[nearest[i]]) < bone.distance;
        jointOf[unreached[i]] = isSkinNearer ? jointOf[nearest[i]] : bone.joint;
    }
}

/// Gives joints that claim a region the vertices nearer to them than to the neighbouring joint of
/// the chain whose label they have.
void claimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf) {
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].claims) continue;
        const std::size_t above = regionAbove(joints, j);
        for (std::size_t v = 0; v < jointOf.size(); ++v) {
            const std::uint32_t owner = jointOf[v];
            if (owner != above && (owner == j || regionAbove(joints, owner) != j)) continue;
            if (glm::distance(mesh.positions[v], joints[j].centre) <
                glm::distance(mesh.positions[v], joints[owner].centre))
                jointOf[v] = j;
        }
    }
}

/// Of the samples in a shell, the share that a joint must have for the shell to be its own: the
/// bone that leads to it may end there.
constexpr double kOwnShare = 0.7;

/// Gives a closed shell to the joint that nearly all samples in it are of: a box of a blocky
/// figure, an eye. A joint with all its samples in such shells has no other skin.
void giveShells(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints, Regions& regions) {
    if (mesh.shells < 2) return;
    std::vector<std::map<std::uint32_t, std::size_t>> samplesIn(mesh.shells); // of each joint
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        const std::uint32_t joint =
            joints[j].rigid >= 0 ? static_cast<std::uint32_t>(joints[j].rigid) : j;
        for (const glm::dvec3& sample : joints[j].samples)
            for (const std::uint32_t shell : shellsAround(mesh, sample)) ++samplesIn[shell][joint];
    }
    std::vector<std::uint32_t> owner(mesh.shells, Regions::kNone);
    std::vector<bool> hasShell(joints.size(), false), hasOther(joints.size(), false);
    for (std::uint32_t shell = 0; shell < mesh.shells; ++shell) {
        std::size_t all = 0;
        for (const auto& [joint, count] : samplesIn[shell]) all += count;
        for (const auto& [joint, count] : samplesIn[shell]) {
            const bool isOwn = double(count) >= kOwnShare * double(all);
            if (isOwn) owner[shell] = joint;
            (isOwn ? hasShell : hasOther)[joint] = true;
        }
    }
    regions.isWhole.assign(regions.jointOf.size(), false);
    for (std::size_t v = 0; v < regions.jointOf.size(); ++v) {
        if (mesh.shellOf[v] == WeldedMesh::kNoShell) continue;
        const std::uint32_t joint = owner[mesh.shellOf[v]], now = regions.jointOf[v];
        regions.isWhole[v] = joint != Regions::kNone;
        if (joint != Regions::kNone)
            regions.jointOf[v] = regions.seedOf[v] = joint;
        else if (hasShell[now] && !hasOther[now])
            regions.jointOf[v] = regions.seedOf[v] = Regions::kNone;
    }
    spreadRegions(mesh, regions.jointOf);
    assignUnreached(mesh, joints, regions.jointOf);
}

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

/// Gives a joint the skin beyond it, and no other of that shell: what else it has there goes to the
/// regions beside it. Nothing changes on a shell that is all its own, or has nothing of its own.
void giveBeyond(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                std::uint32_t joint, std::vector<std::uint32_t>& jointOf) {
    const std::vector<std::uint32_t>& beyond = joints[joint].beyond;
    const std::vector<bool> isBelow = subtreeOf(joints, joint);
    const std::uint32_t shell = mesh.shellOf[beyond.front()];
    bool hasOwn = false, hasOther = false;
    for (std::size_t v = 0; v < jointOf.size(); ++v)
        if (mesh.shellOf[v] == shell) (isBelow[jointOf[v]] ? hasOwn : hasOther) = true;
    if (!hasOwn || !hasOther) return;

    std::vector<std::uint32_t> others = jointOf; // without the extremity's side
    for (const std::uint32_t v : beyond) {
        others[v] = Regions::kNone;
        if (!isBelow[jointOf[v]]) jointOf[v] = joint;
    }
    const auto isToGo = [&](std::size_t v) {
        return mesh.shellOf[v] == shell && isBelow[jointOf[v]] &&
               !std::binary_search(beyond.begin(), beyond.end(), v);
    };
    for (std::size_t v = 0; v < jointOf.size(); ++v)
        if (isToGo(v)) others[v] = Regions::kNone;
    spreadRegions(mesh, others);
    for (std::size_t v = 0; v < jointOf.size(); ++v)
        if (isToGo(v) && others[v] != Regions::kNone) jointOf[v] = others[v];
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
    giveShells(mesh, joints, regions);
    for (std::uint32_t j = 0; j < joints.size(); ++j)
        if (!joints[j].beyond.empty()) giveBeyond(mesh, joints, j, regions.jointOf);
    removeIslands(mesh, isSeed, regions.jointOf);
    extendDigits(mesh, joints, regions.jointOf); // whose regions may have several parts
    return regions;
}

} // namespace osgSkin
