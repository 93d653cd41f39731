// SPDX-License-Identifier: MIT
#include "skin/SkinSlot.h"

#include "shader/ComputeProgram.h"
#include "skin/SharedBarrier.h"

#include <osgSkinGpu/GpuPalette>

#include <osg/BufferIndexBinding>
#include <osg/BufferObject>
#include <osg/Uniform>

namespace osgSkin {
namespace {

/// Whatever the scene above a skin sets or overrides is for drawing, not for this.
constexpr osg::StateAttribute::GLModeValue kOurs =
    osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;

/// A buffer object of the array's own, so that it begins where the buffer does.
void ownBuffer(osg::Array& array, GLenum usage) {
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    buffer->setUsage(usage);
    array.setVertexBufferObject(buffer);
}

osg::ref_ptr<osg::TextureBuffer> readable(osg::Array& array, GLenum usage) {
    ownBuffer(array, usage);
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer(&array);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    return texture;
}

osg::ref_ptr<osg::Vec4Array> restTangents(const osg::Array& from) {
    osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array;
    if (const auto* four = dynamic_cast<const osg::Vec4Array*>(&from))
        tangents->asVector() = four->asVector();
    else if (const auto* three = dynamic_cast<const osg::Vec3Array*>(&from))
        for (const osg::Vec3& t : *three) tangents->push_back(osg::Vec4(t, 1.0f));
    return tangents;
}

} // namespace

SkinSlot::SkinSlot(const DeformableSkin& skin, const osg::ref_ptr<const GpuModel>& model)
    : _geometry(skin.makeDrawnGeometry()),
      _palette(new osg::Vec4Array(static_cast<unsigned int>(model->paletteSize()))),
      _dispatch(new SkinDispatch(model)), _state(new osg::StateSet) {
    const int attribute = skin.getTangentAttribute();
    setUpBin(*_state, kComputeBin);
    _state->setAttribute(computeProgram(attribute >= 0), kOurs);
    addInput(kModelUnit, "osgSkinModel", model->texture());
    addInput(kPaletteUnit, "osgSkinPalette", readable(*_palette, GL_STREAM_DRAW_ARB));
    addOutput(kPositionBuffer, *_geometry->getVertexArray());
    addOutput(kNormalBuffer, *_geometry->getNormalArray());
    if (attribute < 0) return;
    const auto index = static_cast<unsigned int>(attribute);
    const osg::ref_ptr<osg::Vec4Array> rest =
        restTangents(*skin.getRestGeometry()->getVertexAttribArray(index));
    addInput(kTangentUnit, "osgSkinTangents", readable(*rest, GL_STATIC_DRAW_ARB));
    addOutput(kTangentBuffer, *_geometry->getVertexAttribArray(index));
}

void SkinSlot::addInput(unsigned int unit, const char* name, osg::TextureBuffer* texture) {
    _state->setTextureAttribute(unit, texture, kOurs);
    _state->addUniform(new osg::Uniform(name, static_cast<int>(unit)), kOurs);
}

void SkinSlot::addOutput(unsigned int index, osg::Array& array) {
    ownBuffer(array, GL_DYNAMIC_COPY_ARB);
    _state->setAttribute(new osg::ShaderStorageBufferBinding(index, &array), kOurs);
}

void SkinSlot::setPose(const GpuModel& model, const Pose& pose, unsigned int number) {
    writePalette(model, pose, _palette->asVector().data());
    _palette->dirty();
    _dispatch->setPose(number);
}

void SkinSlot::compileGLObjects(osg::RenderInfo& renderInfo) const {
    _geometry->compileGLObjects(renderInfo);
}

void SkinSlot::resizeGLObjectBuffers(unsigned int maxSize) {
    _geometry->resizeGLObjectBuffers(maxSize);
    _dispatch->resizeGLObjectBuffers(maxSize);
    _state->resizeGLObjectBuffers(maxSize);
}

void SkinSlot::releaseGLObjects(osg::State* state) const {
    _geometry->releaseGLObjects(state);
    _dispatch->releaseGLObjects(state);
    _state->releaseGLObjects(state);
}

} // namespace osgSkin
