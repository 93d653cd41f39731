// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMotion>

#include "assimp/AssimpScene.h"
#include "assimp/SampleTracks.h"
#include "assimp/SceneSkeleton.h"
#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <osg/Notify>
#include <osgDB/FileNameUtils>

#include <cmath>

namespace osgSkin {
namespace {

/// Refuses what Assimp lets pass: numbers that overflow, and broken binary files.
void validate(const Motion& motion, const std::string& path) {
    const std::size_t joints = motion.skeleton.joints.size();
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const std::string where = "frame " + std::to_string(f) + ": ";
        if (!isFinite(motion.rootPositions[f]))
            failFile(path, where + "the root's position is not finite");
        for (std::size_t j = 0; j < joints; ++j)
            if (!isFinite(motion.rotation(f, j)))
                failFile(path, where + "joint " + quoted(motion.skeleton.joints[j].name) +
                                   " has a rotation that is not finite");
    }
}

Motion readBvhMotion(const std::string& path) {
    const BvhFile file = readBvh(path);
    if (file.frames == 0) failFile(path, "no frame, expected at least one");
    return makeMotion(file, path);
}

Motion readAssimpMotion(const std::string& path) {
    requireReadable(path);
    Assimp::Importer importer;
    const aiScene& scene = readAssimpScene(importer, path);
    if (scene.mNumAnimations == 0) failFile(path, "no animation, expected at least one");
    if (scene.mNumAnimations > 1)
        OSG_NOTICE << path << ": " << scene.mNumAnimations << " animations, of which the first, \""
                   << scene.mAnimations[0]->mName.C_Str() << "\", is read" << std::endl;
    Motion motion = sampleTracks(*scene.mAnimations[0], readSceneSkeleton(scene, path), path);
    validate(motion, path);
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

Motion importMotion(const std::string& path, std::size_t skipFrames) {
    const bool isBvh = osgDB::getLowerCaseFileExtension(path) == "bvh";
    Motion motion = isBvh ? readBvhMotion(path) : readAssimpMotion(path);
    motion.name = osgDB::getStrippedName(path);
    if (skipFrames >= motion.frames)
        failFile(path, std::to_string(motion.frames) + " frame(s), expected more than the " +
                           std::to_string(skipFrames) + " to skip");
    dropFirst(motion, skipFrames);
    return motion;
}

} // namespace osgSkin
