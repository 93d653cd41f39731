// SPDX-License-Identifier: MIT
#include <osgSkinRig/Motion>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <glm/gtc/quaternion.hpp>

#include <cmath>

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

void Motion::validate() const {
    skeleton.validate();
    const std::string label = "motion \"" + name + "\": ";
    const std::size_t joints = skeleton.joints.size();
    if (frames == 0) throw Error(label + "no frame, expected at least one");
    if (!(frameTime > 0.0) || !std::isfinite(frameTime))
        throw Error(label + "expected a positive frame time");
    if (rootPositions.size() != frames || rotations.size() % joints != 0 ||
        rotations.size() / joints != frames)
        throw Error(label + "its arrays do not fit " + std::to_string(frames) + " frames");
    for (const auto& [joint, positions] : moves)
        if (joint == 0 || joint >= joints || positions.size() != frames)
            throw Error(label + "its moves do not fit its joints and " + std::to_string(frames) +
                        " frames");
    for (const auto& [morph, weights] : morphs)
        if (weights.size() != frames)
            throw Error(label + "expected a weight of \"" + morph + "\" for each of " +
                        std::to_string(frames) + " frames");
    for (std::size_t f = 0; f < frames; ++f) {
        const auto at = [&] { return label + "frame " + std::to_string(f) + ": "; };
        if (!isInRange(rootPositions[f]))
            throw Error(at() + "the root's position is not finite, or beyond -1e18 to 1e18");
        for (std::size_t j = 0; j < joints; ++j) {
            const glm::dquat& q = rotation(f, j);
            if (!(std::abs(glm::dot(q, q) - 1.0) <= 2e-3)) // for NaN, too
                throw Error(at() + "joint \"" + skeleton.joints[j].name +
                            "\" has a rotation that is not unit");
        }
    }
}

} // namespace osgSkin
