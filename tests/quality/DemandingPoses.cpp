// SPDX-License-Identifier: MIT
#include "DemandingPoses.h"

#include <osgSkin/GlmTypes>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <functional>

namespace quality {
namespace {

const glm::dvec3 kX(1.0, 0.0, 0.0), kY(0.0, 1.0, 0.0), kZ(0.0, 0.0, 1.0);

glm::dquat rotation(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

/// The shortest rotation from one unit direction to another.
glm::dquat shortest(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis), cosine = glm::dot(from, to);
    if (sine > 1e-9) return glm::angleAxis(std::atan2(sine, cosine), axis / sine);
    if (cosine > 0.0) return {1.0, 0.0, 0.0, 0.0};
    return rotation(180.0, glm::cross(from, std::abs(from.z) < 0.9 ? kZ : kX));
}

} // namespace

int firstChild(const osgSkin::RestSkeleton& rig, int joint) {
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        if (rig.joints[j].parent == joint) return static_cast<int>(j);
    return -1;
}

BodyPose::BodyPose(const osgSkin::RestSkeleton& rig)
    : _rig(&rig), _local(rig.joints.size(), glm::dquat(1.0, 0.0, 0.0, 0.0)) {}

glm::dquat BodyPose::world(int joint) const {
    glm::dquat result(1.0, 0.0, 0.0, 0.0);
    for (int j = joint; j >= 0; j = _rig->joints[static_cast<std::size_t>(j)].parent)
        result = _local[static_cast<std::size_t>(j)] * result;
    return result;
}

glm::dvec3 BodyPose::bone(const std::string& joint) const {
    const int found = _rig->find(joint);
    if (found < 0) return kY;
    const osgSkin::RestJoint& own = _rig->joints[static_cast<std::size_t>(found)];
    const int child = firstChild(*_rig, found);
    const glm::dvec3 end = child >= 0 ? _rig->joints[static_cast<std::size_t>(child)].centre
                                      : own.tip.value_or(own.centre + kY);
    return glm::normalize(end - own.centre);
}

BodyPose& BodyPose::rotate(const std::string& joint, const glm::dvec3& axis, double degrees) {
    const int found = _rig->find(joint);
    if (found < 0) return *this;
    glm::dquat& q = _local[static_cast<std::size_t>(found)];
    q = rotation(degrees, axis) * q;
    return *this;
}

BodyPose& BodyPose::aim(const std::string& joint, const glm::dvec3& direction, double roll) {
    const int found = _rig->find(joint);
    if (found < 0) return *this;
    const glm::dquat parent = world(_rig->joints[static_cast<std::size_t>(found)].parent);
    const glm::dvec3 wanted = glm::conjugate(parent) * glm::normalize(direction);
    _local[static_cast<std::size_t>(found)] =
        rotation(roll, wanted) * shortest(bone(joint), wanted);
    return *this;
}

BodyPose& BodyPose::twist(const std::string& joint, double degrees, const std::string& along) {
    const int found = _rig->find(joint);
    if (found < 0) return *this;
    glm::dquat& q = _local[static_cast<std::size_t>(found)];
    q = q * rotation(degrees, bone(along.empty() ? joint : along));
    return *this;
}

BodyPose& BodyPose::flex(const std::string& joint, double flexion) {
    const int found = _rig->find(joint);
    if (found < 0) return *this;
    const osgSkin::RestJoint& own = _rig->joints[static_cast<std::size_t>(found)];
    const glm::dvec3 upper =
        glm::normalize(own.centre - _rig->joints[static_cast<std::size_t>(own.parent)].centre);
    const glm::dvec3 lower = bone(joint);
    const double atRest = std::acos(glm::clamp(glm::dot(upper, lower), -1.0, 1.0));
    const bool knee = joint.find("Leg") != std::string::npos;
    _local[static_cast<std::size_t>(found)] =
        rotation(flexion - glm::degrees(atRest), knee ? kX : glm::cross(upper, lower));
    return *this;
}

std::vector<glm::dmat4> BodyPose::skinning() const {
    std::vector<glm::dmat4> result;
    const glm::dmat4 unit(1.0);
    for (std::size_t j = 0; j < _local.size(); ++j) {
        const glm::dvec3& centre = _rig->joints[j].centre;
        const glm::dmat4 own = glm::translate(unit, centre) * glm::mat4_cast(_local[j]) *
                               glm::translate(unit, -centre);
        const int parent = _rig->joints[j].parent;
        result.push_back(parent < 0 ? own : result[static_cast<std::size_t>(parent)] * own);
    }
    return result;
}

namespace {

struct Side {
    std::string name;
    double out; ///< along x: 1 to the left, -1 to the right
};

void bothSides(const std::function<void(const Side&)>& pose) {
    for (const Side& side : {Side{"Left", 1.0}, Side{"Right", -1.0}}) pose(side);
}

void raiseClavicle(BodyPose& pose, const Side& side, double up, double ahead = 0.0) {
    pose.rotate(side.name + "Shoulder", kZ, side.out * up);
    pose.rotate(side.name + "Shoulder", kY, -side.out * ahead);
}

void arm(BodyPose& pose, const Side& side, const glm::dvec3& direction, double elbow = 8.0) {
    pose.aim(side.name + "Arm", {side.out * direction.x, direction.y, direction.z});
    pose.flex(side.name + "ForeArm", elbow);
}

void armsDown(BodyPose& pose) {
    bothSides([&](const Side& side) { arm(pose, side, {0.12, -1.0, 0.0}, 15.0); });
}

void armsOut(BodyPose& pose) {
    bothSides([&](const Side& side) { arm(pose, side, kX); });
}

void leg(BodyPose& pose, const Side& side, const glm::dvec3& direction, double knee) {
    pose.aim(side.name + "UpLeg", {side.out * direction.x, direction.y, direction.z});
    pose.flex(side.name + "Leg", knee);
}

void bendSpine(BodyPose& pose, const glm::dvec3& axis, double lower, double middle, double upper) {
    pose.rotate("LowerBack", axis, lower)
        .rotate("Spine", axis, middle)
        .rotate("Spine1", axis, upper);
}

void bendNeck(BodyPose& pose, const glm::dvec3& axis, double lower, double middle, double head) {
    pose.rotate("Neck", axis, lower).rotate("Neck1", axis, middle).rotate("Head", axis, head);
}

struct Recipe {
    const char* name;
    const char* centre;
    double height, azimuth, elevation;
    void (*make)(BodyPose&);
};

const Recipe kRecipes[] = {
    {"arms up", "Spine1", 0.86, 10, 5,
     [](BodyPose& pose) {
         bothSides([&](const Side& side) {
             raiseClavicle(pose, side, 25.0);
             arm(pose, side, {0.12, 1.0, 0.05});
         });
     }},
    {"arms down", "Spine1", 0.56, 15, 5, armsDown},
    {"arms ahead", "Spine1", 0.55, 35, 10,
     [](BodyPose& pose) {
         bothSides([&](const Side& side) {
             raiseClavicle(pose, side, 0.0, 12.0);
             arm(pose, side, {0.15, 0.0, 1.0});
         });
     }},
    {"arm across", "Spine1", 0.5, 10, 10,
     [](BodyPose& pose) {
         const Side left{"Left", 1.0};
         raiseClavicle(pose, left, 0.0, 20.0);
         arm(pose, left, {-0.7, 0.05, 0.75});
         arm(pose, {"Right", -1.0}, {0.12, -1.0, 0.0}, 15.0);
     }},
    {"arms crossed", "Spine1", 0.5, 15, 10,
     [](BodyPose& pose) {
         bothSides([&](const Side& side) {
             raiseClavicle(pose, side, 0.0, 15.0);
             arm(pose, side, {-0.25, side.out > 0.0 ? -0.15 : 0.05, 1.0}, 105.0);
         });
     }},
    {"shrug", "Spine1", 0.46, 5, 5,
     [](BodyPose& pose) {
         bothSides([&](const Side& side) { raiseClavicle(pose, side, 30.0); });
         armsDown(pose);
     }},
    {"elbow", "LeftForeArm", 0.28, -10, 25,
     [](BodyPose& pose) {
         bothSides([&](const Side& side) { arm(pose, side, {1.0, -0.1, 0.1}, 140.0); });
     }},
    {"wrist twist", "LeftHand", 0.24, 0, 15,
     [](BodyPose& pose) {
         armsOut(pose);
         pose.twist("LeftHand", 170.0, "LeftForeArm").twist("RightHand", 90.0, "RightForeArm");
     }},
    {"wrist bent", "LeftHand", 0.2, 0, 10,
     [](BodyPose& pose) {
         armsOut(pose);
         bothSides([&](const Side& side) {
             pose.rotate(side.name + "Hand", glm::cross(pose.bone(side.name + "ForeArm"), kY),
                         side.out * 80.0);
         });
     }},
    {"arm twist", "Spine1", 0.62, 10, 15,
     [](BodyPose& pose) {
         armsOut(pose);
         pose.twist("LeftArm", 90.0).twist("RightArm", -90.0);
     }},
    {"throw", "Spine1", 0.55, 10, 5,
     [](BodyPose& pose) {
         bendSpine(pose, kY, 15.0, 15.0, 15.0);
         pose.aim("LeftArm", {0.95, 0.15, -0.25}).twist("LeftArm", -95.0).flex("LeftForeArm", 90.0);
         pose.aim("RightArm", {-0.5, 0.0, 0.85}).flex("RightForeArm", 30.0);
     }},
    {"torso twist", "Spine", 0.55, 20, 5,
     [](BodyPose& pose) {
         bendSpine(pose, kY, 20.0, 20.0, 20.0);
         armsOut(pose);
     }},
    {"torso aside", "Spine", 0.6, 0, 5,
     [](BodyPose& pose) {
         bendSpine(pose, kZ, 15.0, 15.0, 15.0);
         armsDown(pose);
     }},
    {"torso forward", "Spine", 0.6, 75, 5,
     [](BodyPose& pose) {
         bendSpine(pose, kX, 30.0, 30.0, 30.0);
         armsDown(pose);
     }},
    {"head turned", "Neck1", 0.28, 0, 5,
     [](BodyPose& pose) {
         bendNeck(pose, kY, 30.0, 20.0, 20.0);
         armsDown(pose);
     }},
    {"head down", "Neck1", 0.28, 40, 0,
     [](BodyPose& pose) {
         bendNeck(pose, kX, 20.0, 15.0, 15.0);
         armsDown(pose);
     }},
    {"sitting", "Hips", 0.6, 50, 15,
     [](BodyPose& pose) {
         bothSides([&](const Side& side) { leg(pose, side, {0.12, 0.0, 1.0}, 90.0); });
         armsDown(pose);
     }},
    {"squat", "Hips", 0.7, 50, 10,
     [](BodyPose& pose) {
         bendSpine(pose, kX, 12.0, 12.0, 0.0);
         pose.rotate("Hips", kX, 15.0);
         bothSides([&](const Side& side) {
             leg(pose, side, {0.45, 0.2, 0.9}, 140.0);
             pose.rotate(side.name + "Foot", kX, -25.0);
             arm(pose, side, {0.3, -0.2, 1.0});
         });
     }},
    {"knees to chest", "Hips", 0.62, 70, 5,
     [](BodyPose& pose) {
         bendSpine(pose, kX, 20.0, 20.0, 15.0);
         bothSides([&](const Side& side) {
             leg(pose, side, {0.12, 0.75, 0.66}, 150.0);
             arm(pose, side, {0.3, -0.4, 0.9}, 60.0);
         });
     }},
    {"leg aside", "Hips", 0.62, 0, 0,
     [](BodyPose& pose) {
         leg(pose, {"Left", 1.0}, {1.0, -0.18, 0.0}, 5.0);
         armsOut(pose);
     }},
    {"high kick", "Hips", 0.75, 40, 5,
     [](BodyPose& pose) {
         leg(pose, {"Left", 1.0}, {0.05, 0.5, 0.87}, 5.0);
         pose.flex("RightLeg", 12.0);
         bothSides([&](const Side& side) { arm(pose, side, {0.8, -0.5, -0.4 * side.out}, 60.0); });
     }},
    {"knee", "LeftLeg", 0.36, 70, 5,
     [](BodyPose& pose) {
         pose.flex("LeftLeg", 140.0).flex("RightLeg", 90.0);
         armsDown(pose);
     }},
    {"crawl", "Spine", 0.75, 70, 15,
     [](BodyPose& pose) {
         pose.rotate("Hips", kX, 85.0).rotate("Neck", kX, -25.0).rotate("Head", kX, -30.0);
         bothSides([&](const Side& side) {
             arm(pose, side, {0.1, -1.0, 0.1});
             leg(pose, side, {0.12, -1.0, 0.05}, 90.0);
             pose.rotate(side.name + "Foot", kX, 45.0);
         });
     }},
    {"fist", "LeftHand", 0.18, 10, 15, [](BodyPose& pose) {
         armsOut(pose);
         bothSides([&](const Side& side) {
             const glm::dvec3 across = glm::cross(pose.bone(side.name + "FingerBase"), -kY);
             pose.rotate(side.name + "FingerBase", across, 70.0);
             pose.rotate(side.name + "HandFinger1", across, 80.0);
         });
     }}};

} // namespace

std::vector<DemandingPose> demandingPoses(const osgSkin::RestSkeleton& rig) {
    std::vector<DemandingPose> result;
    for (const Recipe& recipe : kRecipes) {
        BodyPose pose(rig);
        recipe.make(pose);
        result.push_back({{recipe.name, pose.skinning()},
                          recipe.centre,
                          recipe.height,
                          recipe.azimuth,
                          recipe.elevation});
    }
    return result;
}

BodyPose sittingPose(const osgSkin::RestSkeleton& rig) {
    BodyPose pose(rig);
    bothSides([&](const Side& side) { leg(pose, side, {0.12, 0.0, 1.0}, 90.0); });
    armsDown(pose);
    return pose;
}

} // namespace quality
