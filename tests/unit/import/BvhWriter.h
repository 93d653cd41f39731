// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Motion>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>

/// Writes a motion as a BVH file with its own zero pose.
/// \param motion to write
/// \param path of the file
/// \param inChannels writes the joints' offsets in position channels, and zeros in OFFSET
inline void writeBvh(const osgSkin::Motion& motion, const std::string& path,
                     bool inChannels = false) {
    const osgSkin::RestSkeleton& skeleton = motion.skeleton;
    std::ofstream out(path);
    out.precision(12);
    out << "HIERARCHY\n";
    std::vector<std::size_t> order; // depth first, as in the file
    const auto offsetOf = [&](const osgSkin::RestJoint& joint) {
        if (joint.parent < 0) return joint.centre;
        return joint.centre - skeleton.joints[std::size_t(joint.parent)].centre;
    };
    const std::function<void(int)> write = [&](int j) {
        const osgSkin::RestJoint& joint = skeleton.joints[std::size_t(j)];
        const bool root = joint.parent < 0;
        const glm::dvec3 offset = inChannels ? glm::dvec3(0.0) : offsetOf(joint);
        order.push_back(std::size_t(j));
        out << (root ? "ROOT " : "JOINT ") << joint.name << "\n{\nOFFSET " << offset.x << " "
            << offset.y << " " << offset.z << "\nCHANNELS "
            << (root || inChannels ? "6 Xposition Yposition Zposition " : "3 ")
            << "Zrotation Yrotation Xrotation\n";
        for (const int child : skeleton.children(j)) write(child);
        if (joint.tip) {
            const glm::dvec3 tip = *joint.tip - joint.centre;
            out << "End Site\n{\nOFFSET " << tip.x << " " << tip.y << " " << tip.z << "\n}\n";
        }
        out << "}\n";
    };
    write(0);
    out << "MOTION\nFrames: " << motion.frames << "\nFrame Time: " << motion.frameTime << "\n";
    for (std::size_t f = 0; f < motion.frames; ++f) {
        for (const std::size_t j : order) {
            const glm::dvec3 position =
                j == 0 ? motion.rootPositions[f] : offsetOf(skeleton.joints[j]);
            if (j == 0 || inChannels)
                out << " " << position.x << " " << position.y << " " << position.z;
            const glm::dmat3 m = glm::mat3_cast(motion.rotation(f, j)); // m[column][row]
            out << " " << glm::degrees(std::atan2(m[0][1], m[0][0])) << " "
                << glm::degrees(std::asin(std::clamp(-m[0][2], -1.0, 1.0))) << " "
                << glm::degrees(std::atan2(m[1][2], m[2][2]));
        }
        out << "\n";
    }
}
