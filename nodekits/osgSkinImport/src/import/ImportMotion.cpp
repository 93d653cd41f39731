// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMotion>

#include "assimp/AssimpScene.h"
#include "assimp/SampleTracks.h"
#include "assimp/SceneSkeleton.h"
#include "osg/OsgScene.h"
#include "text/BvhCheck.h"
#include "text/FileText.h"

#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Motion>

#include <osg/Notify>
#include <osgDB/FileNameUtils>

#include <cmath>
#include <optional>

namespace osgSkin {
namespace {

/// Checks the file before Assimp sees it; BVH files say what they hold.
std::optional<BvhSummary> check(const std::string& path) {
    if (osgDB::getLowerCaseFileExtension(path) == "bvh") return checkBvh(path, readText(path));
    requireReadable(path);
    return std::nullopt;
}

bool isFinite(const glm::dquat& q) {
    return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Refuses what no text check sees: numbers that overflow in Assimp, and broken binary files.
void validate(const Motion& motion, const std::string& path) {
    const std::size_t joints = motion.skeleton.joints.size();
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const std::string place = "frame " + std::to_string(f) + ": ";
        if (!isFinite(motion.rootPositions[f]))
            failFile(path, place + "the root's place is not finite");
        for (std::size_t j = 0; j < joints; ++j)
            if (!isFinite(motion.rotation(f, j)))
                failFile(path, place + "joint " + quoted(motion.skeleton.joints[j].name) +
                                   " has a rotation that is not finite");
    }
}

void dropFirst(Motion& motion, std::size_t count) {
    const auto rotations = static_cast<std::ptrdiff_t>(count * motion.skeleton.joints.size());
    motion.rotations.erase(motion.rotations.begin(), motion.rotations.begin() + rotations);
    motion.rootPositions.erase(motion.rootPositions.begin(),
                               motion.rootPositions.begin() + static_cast<std::ptrdiff_t>(count));
    motion.frames -= count;
}

} // namespace

Motion importMotion(const std::string& path, std::size_t skipFrames) {
    const std::optional<BvhSummary> bvh = check(path);
    if (bvh && bvh->frames == 0) failFile(path, "no frame, expected at least one");
    Assimp::Importer importer;
    const aiScene& scene = readAssimpScene(importer, path);
    if (scene.mNumAnimations == 0) failFile(path, "no animation, expected at least one");

    if (scene.mNumAnimations > 1)
        OSG_NOTICE << path << ": " << scene.mNumAnimations << " animations, of which the first, \""
                   << scene.mAnimations[0]->mName.C_Str() << "\", is read" << std::endl;
    Motion motion = sampleTracks(*scene.mAnimations[0], skeletonOf(scene, path), path);
    motion.name = osgDB::getStrippedName(path);
    // Assimp holds the time as a float.
    if (bvh) motion.frameTime = bvh->frameTime;
    validate(motion, path);
    if (skipFrames >= motion.frames)
        failFile(path, std::to_string(motion.frames) + " frame(s), expected more than the " +
                           std::to_string(skipFrames) + " to skip");
    dropFirst(motion, skipFrames);
    return motion;
}

} // namespace osgSkin
