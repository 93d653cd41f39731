// SPDX-License-Identifier: MIT
#include <osgSkinRig/VmcPose>

#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// The bones of Unity's humanoid at rest, all at the origin.
const RestSkeleton& humanoid() {
    static const RestSkeleton bones = [] {
        RestSkeleton result;
        const auto add = [&](const std::string& name, const std::string& parent) {
            result.add(name, result.find(parent), glm::dvec3(0.0));
        };
        const auto addChain = [&](std::string parent, const std::vector<std::string>& names,
                                  const std::string& side = {}) {
            for (const std::string& name : names) {
                add(side + name, parent);
                parent = side + name;
            }
        };
        addChain("", {"Hips", "Spine", "Chest", "UpperChest", "Neck", "Head"});
        addChain("Head", {"Jaw"});
        for (const std::string side : {"Left", "Right"}) {
            addChain("Head", {"Eye"}, side);
            addChain("Hips", {"UpperLeg", "LowerLeg", "Foot", "Toes"}, side);
            addChain("UpperChest", {"Shoulder", "UpperArm", "LowerArm", "Hand"}, side);
            for (const std::string finger : {"Thumb", "Index", "Middle", "Ring", "Little"})
                addChain(side + "Hand",
                         {finger + "Proximal", finger + "Intermediate", finger + "Distal"}, side);
        }
        return result;
    }();
    return bones;
}

/// Without these nobody stands.
const char* const kBody[] = {"Spine",        "Head",          "LeftUpperLeg",  "LeftLowerLeg",
                             "LeftFoot",     "RightUpperLeg", "RightLowerLeg", "RightFoot",
                             "LeftLowerArm", "LeftHand",      "RightLowerArm", "RightHand"};

/// From Unity's left-handed space to one with the opposite x axis.
glm::dvec3 fromUnity(const osg::Vec3d& v) {
    return {-v.x(), v.y(), v.z()};
}

glm::dquat fromUnity(const osg::Quat& q) {
    return glm::normalize(glm::dquat(q.w(), q.x(), -q.y(), -q.z()));
}

} // namespace

VmcPose::VmcPose()
    : _positions(humanoid().joints.size(), glm::dvec3(0.0)),
      _rotations(_positions.size(), {1.0, 0.0, 0.0, 0.0}) {}

bool VmcPose::take(const std::string& address, const std::string& name, const osg::Vec3d& position,
                   const osg::Quat& rotation) {
    if (!isInRange(toGlm(position)) || !(std::abs(rotation.length() - 1.0) < 1e-3)) return false;
    if (address == "/VMC/Ext/Root/Pos") {
        _rootPosition = fromUnity(position);
        _rootRotation = fromUnity(rotation);
    } else {
        const int found = address == "/VMC/Ext/Bone/Pos" ? humanoid().find(name) : -1;
        if (found < 0) return false;
        const auto bone = static_cast<std::size_t>(found);
        _positions[bone] = fromUnity(position);
        (bone == 0 ? _hips : _rotations[bone]) = fromUnity(rotation);
    }
    _rotations[0] = _rootRotation * _hips;
    return true;
}

bool VmcPose::hasBody() const {
    return std::all_of(std::begin(kBody), std::end(kBody), [&](const char* name) {
        return glm::length(_positions[static_cast<std::size_t>(humanoid().find(name))]) > 0.0;
    });
}

RestSkeleton VmcPose::skeleton() const {
    RestSkeleton result = humanoid();
    for (std::size_t j = 1; j < _positions.size(); ++j) {
        const RestJoint& parent = result.joints[static_cast<std::size_t>(result.joints[j].parent)];
        result.joints[j].centre = parent.centre + _positions[j];
    }
    double floor = 0.0;
    for (const RestJoint& joint : result.joints) floor = std::min(floor, joint.centre.y);
    for (RestJoint& joint : result.joints) joint.centre.y -= floor;
    return result;
}

glm::dvec3 VmcPose::root() const {
    return _rootPosition + _rootRotation * _positions[0];
}

} // namespace osgSkin
