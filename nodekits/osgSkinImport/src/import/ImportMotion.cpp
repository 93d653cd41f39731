// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMotion>

#include "assimp/AssimpScene.h"
#include "assimp/SceneSkeleton.h"
#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "gltf/plain/PlainGltf.h"
#include "rig/ClipNames.h"
#include "rig/SampleTracks.h"
#include "rig/TrackOffsets.h"
#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <osgDB/FileNameUtils>

#include <cmath>

namespace osgSkin {
namespace {

/// Refuses what Assimp lets pass: numbers that overflow, and broken binary files.
void validate(const Motion& motion, const std::string& path) {
    const std::size_t joints = motion.skeleton.joints.size();
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const std::string where = "frame " + std::to_string(f) + ": ";
        if (!isInRange(motion.rootPositions[f]))
            failFile(path, where + "the root's position is not finite, or beyond -1e18 to 1e18");
        for (std::size_t j = 0; j < joints; ++j)
            if (!isFinite(motion.rotation(f, j)))
                failFile(path, where + "joint " + inQuotes(motion.skeleton.joints[j].name) +
                                   " has a rotation that is not finite");
    }
}

Motion readBvhMotion(const std::string& path, const std::string& clip, const ReadLimits& limits) {
    if (!clip.empty()) findClip({osgDB::getStrippedName(path)}, clip, path); // one, called so
    const BvhFile file = readBvh(path, limits);
    if (file.frames == 0) failFile(path, "no frame, expected at least one");
    return makeMotion(file, path);
}

/// The first animation that moves joints, and tells of the others that do.
std::size_t firstClip(const aiScene& scene, const std::vector<std::string>& names,
                      const std::string& path) {
    std::size_t first = 0, count = 0;
    for (std::size_t a = 0; a < names.size(); ++a) {
        if (scene.mAnimations[a]->mNumChannels == 0) continue;
        if (count++ == 0) first = a;
    }
    if (count > 1)
        tellOf(path, std::to_string(count) + " animations, of which the first, \"" + names[first] +
                         "\", is read");
    return first;
}

Motion readAssimpMotion(const std::string& path, const std::string& clip,
                        const ReadLimits& limits) {
    const std::size_t bytes = requireReadable(path, limits);
    if (holdsMeshesOnly(path))
        failFile(path, "no animation in files of its kind, expected one of another");
    Assimp::Importer importer;
    const aiScene& scene = readAssimpScene(importer, path, limits);
    if (scene.mNumAnimations == 0) failFile(path, "no animation, expected at least one");
    const std::vector<std::string> names = clipNames(scene);
    const std::size_t chosen =
        clip.empty() ? firstClip(scene, names, path) : findClip(names, clip, path);
    if (scene.mAnimations[chosen]->mNumChannels == 0)
        failFile(path,
                 "clip " + inQuotes(names[chosen]) + " moves no joint, expected one that does");
    auto& owned = const_cast<aiScene&>(scene); // the importer's, which nobody else sees
    takeTrackOffsets(*scene.mAnimations[chosen], *owned.mRootNode);
    Motion motion = sampleTracks(*scene.mAnimations[chosen], readSceneSkeleton(scene, path, limits),
                                 limits.samplesOf(bytes), path);
    validate(motion, path);
    motion.name = names[chosen];
    motion.yIsUp = isGltfName(path);
    return motion;
}

void dropFirst(Motion& motion, std::size_t count) {
    const auto rotations = static_cast<std::ptrdiff_t>(count * motion.skeleton.joints.size());
    motion.rotations.erase(motion.rotations.begin(), motion.rotations.begin() + rotations);
    motion.rootPositions.erase(motion.rootPositions.begin(),
                               motion.rootPositions.begin() + static_cast<std::ptrdiff_t>(count));
    motion.frames -= count;
}

} // namespace

Motion importMotion(const std::string& path, std::size_t skipFrames, const std::string& clip,
                    const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const bool isBvh = osgDB::getLowerCaseFileExtension(path) == "bvh";
    Motion motion =
        isBvh ? readBvhMotion(path, clip, limits) : readAssimpMotion(path, clip, limits);
    if (isBvh || clip.empty()) motion.name = osgDB::getStrippedName(path);
    if (skipFrames >= motion.frames)
        failFile(path, std::to_string(motion.frames) + " frame(s), expected more than the " +
                           std::to_string(skipFrames) + " to skip");
    dropFirst(motion, skipFrames);
    return motion;
}

} // namespace osgSkin
