// SPDX-License-Identifier: MIT
#include <osgSkinRig/Motion>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

namespace osgSkin {

void Motion::addFrame(const glm::dvec3& root, const std::vector<glm::dquat>& local) {
    if (local.size() != skeleton.joints.size())
        throw Error("motion \"" + name + "\": " + std::to_string(local.size()) +
                    " rotations in a sample, expected " + std::to_string(skeleton.joints.size()));
    rotations.insert(rotations.end(), local.begin(), local.end());
    rootPositions.push_back(root);
    ++frames;
}

void Motion::addFrame(const osg::Vec3d& root, const std::vector<osg::Quat>& local) {
    std::vector<glm::dquat> converted;
    converted.reserve(local.size());
    for (const osg::Quat& rotation : local) converted.push_back(toGlm(rotation));
    addFrame(toGlm(root), converted);
}

} // namespace osgSkin
