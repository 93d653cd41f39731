// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/GlmTypes>

#include <osg/Array>

#include <cstring>
#include <vector>

namespace osgSkin {

inline unsigned int floatBits(float x) {
    unsigned int word;
    std::memcpy(&word, &x, sizeof word);
    return word;
}

inline osg::Vec4ui packedTexel(const glm::vec3& v, unsigned int word) {
    return {floatBits(v.x), floatBits(v.y), floatBits(v.z), word};
}

/// Appends the first texels of a GpuModel: one to be filled in later, and the joints.
inline void packJoints(const std::vector<BoundJoint>& joints, osg::Vec4uiArray& texels) {
    texels.push_back(osg::Vec4ui(0, 0, 0, 0));
    for (const BoundJoint& joint : joints) {
        texels.push_back(packedTexel(joint.centre, static_cast<unsigned int>(joint.parent)));
        texels.push_back(packedTexel(joint.twistAxis, 0));
    }
}

} // namespace osgSkin
