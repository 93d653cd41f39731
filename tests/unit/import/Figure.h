// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Clip>
#include <osgSkinRig/Motion>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <string>
#include <vector>

/// Small hand-made figures, for tests without files.

inline glm::dquat turnDegrees(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

/// A body with only its left arm and leg. The arm hangs `armDegrees` below the horizontal.
inline osgSkin::RestSkeleton makeFigure(double armDegrees, double size = 1.0) {
    const glm::dvec3 arm = turnDegrees(-armDegrees, {0, 0, 1}) * glm::dvec3(1, 0, 0);
    osgSkin::RestSkeleton figure;
    const auto add = [&](const char* name, int parent, const glm::dvec3& place) {
        figure.joints.push_back({name, parent, size * place, {}});
    };
    add("Hips", -1, {0, 10, 0});
    add("Spine", 0, {0, 12, 0});
    add("Head", 1, {0, 16, 0});
    add("LeftShoulder", 1, {0.5, 15, 0});
    add("LeftArm", 3, {2, 15, 0});
    add("LeftForeArm", 4, glm::dvec3(2, 15, 0) + 3.0 * arm);
    add("LeftHand", 5, glm::dvec3(2, 15, 0) + 5.0 * arm);
    add("LHipJoint", 0, {0, 10, 0});
    add("LeftUpLeg", 7, {1, 9, 0});
    add("LeftLeg", 8, {1, 5, 0});
    add("LeftFoot", 9, {1, 1, 0});
    figure.joints[2].tip = size * glm::dvec3(0, 18, 0);
    figure.joints[6].tip = size * (glm::dvec3(2, 15, 0) + 6.0 * arm);
    figure.joints[10].tip = size * glm::dvec3(1, 0, 2);
    return figure;
}

/// A motion of `figure` that stays in the zero pose.
inline osgSkin::Motion standStill(const osgSkin::RestSkeleton& figure, std::size_t frames) {
    osgSkin::Motion motion;
    motion.name = "still";
    motion.skeleton = figure;
    motion.frameTime = 0.04;
    motion.frames = frames;
    motion.rotations.assign(frames * figure.joints.size(), glm::dquat(1, 0, 0, 0));
    motion.rootPositions.assign(frames, figure.joints[0].centre);
    return motion;
}

/// World-space orientations and positions of a clip's joints in one sample.
struct Placed {
    std::vector<glm::dquat> turns;
    std::vector<glm::dvec3> places;
};

inline Placed place(const osgSkin::RestSkeleton& rig, const glm::dquat* local,
                    const glm::dvec3& root) {
    Placed result;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int parent = rig.joints[j].parent;
        if (parent < 0) {
            result.turns.push_back(local[j]);
            result.places.push_back(root);
            continue;
        }
        const auto p = static_cast<std::size_t>(parent);
        result.turns.push_back(result.turns[p] * local[j]);
        result.places.push_back(result.places[p] +
                                result.turns[p] * (rig.joints[j].centre - rig.joints[p].centre));
    }
    return result;
}

inline Placed place(const osgSkin::Clip& clip, const osgSkin::RestSkeleton& rig,
                    std::size_t frame) {
    return place(rig, &clip.rotations[frame * clip.joints], clip.rootPositions[frame]);
}

inline Placed place(const osgSkin::Motion& motion, std::size_t frame) {
    return place(motion.skeleton, &motion.rotation(frame, 0), motion.rootPositions[frame]);
}

/// Angle between two directions, degrees.
inline double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Angle of the rotation between two orientations, degrees.
inline double angleBetween(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return glm::degrees(2.0 * std::atan2(glm::length(glm::dvec3(d.x, d.y, d.z)), std::abs(d.w)));
}
