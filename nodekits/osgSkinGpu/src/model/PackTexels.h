// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/GlmTypes>

#include <osg/Array>
#include <osg/BufferObject>
#include <osg/TextureBuffer>
#include <osg/ref_ptr>

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

/// A texture buffer of an array, which gets a buffer object of its own.
inline osg::ref_ptr<osg::TextureBuffer> textureOf(osg::Array& array, GLint format,
                                                  GLenum usage = GL_STATIC_DRAW_ARB) {
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    buffer->setUsage(usage);
    array.setVertexBufferObject(buffer);
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer(&array);
    texture->setInternalFormat(format);
    return texture;
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
