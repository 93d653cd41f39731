// SPDX-License-Identifier: MIT
#include "crowd/CrowdDraws.h"

#include "crowd/CrowdText.h"
#include "model/PackTexels.h"
#include "skin/ComputeStage.h"

#include <osgSkinGpu/CrowdInstance>

#include <osg/BufferObject>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/Program>
#include <osg/RenderInfo>
#include <osg/State>
#include <osg/Uniform>

#include <algorithm>
#include <atomic>
#include <string>

#ifndef GL_RASTERIZER_DISCARD
#define GL_RASTERIZER_DISCARD 0x8C89
#endif
#ifndef GL_R32UI
#define GL_R32UI 0x8236
#endif

namespace osgSkin {

void TexelCheck::drawImplementation(osg::RenderInfo& renderInfo,
                                    const osg::Drawable* drawable) const {
    if (canReadTexels(renderInfo.getContextID(), _texels)) {
        _draw ? _draw->drawImplementation(renderInfo, drawable)
              : drawable->drawImplementation(renderInfo);
        return;
    }
    static std::atomic<bool> wasReported{false};
    if (!wasReported.exchange(true))
        OSG_WARN << "osgSkin: a crowd has a buffer of " << _texels
                 << " texels, more than this driver reads; the crowd is not drawn" << std::endl;
}
namespace {

bool hasTexture(const osg::StateSet* state) {
    return state && state->getTextureAttribute(0, osg::StateAttribute::TEXTURE);
}

/// A material's state for a crowd: without its program, if that does not call osgSkin_vertex() and
/// so draws no members, such as one for normal maps.
osg::ref_ptr<osg::StateSet> forCrowds(osg::StateSet* state) {
    const auto* program =
        state ? dynamic_cast<const osg::Program*>(state->getAttribute(osg::StateAttribute::PROGRAM))
              : nullptr;
    if (!program) return state;
    for (unsigned int s = 0; s < program->getNumShaders(); ++s)
        if (program->getShader(s)->getShaderSource().find("osgSkin_vertex") != std::string::npos)
            return state;
    const osg::ref_ptr<osg::StateSet> result = new osg::StateSet(*state);
    result->removeAttribute(osg::StateAttribute::PROGRAM);
    return result;
}

std::size_t texelsOf(const osg::TextureBuffer& texture) {
    const osg::BufferData* data = texture.getBufferData();
    return data ? data->getTotalDataSize() / sizeof(osg::Vec4f) : 0;
}

} // namespace

CrowdDraws::CrowdDraws(const CrowdCharacter& character, std::size_t capacity, Count count)
    : _capacity(capacity),
      _list(new osg::UIntArray(static_cast<unsigned int>(capacity * character.levelCount()))) {
    const bool isIndirect = count == Count::Indirect; // then the card writes list and commands
    _visible = textureOf(*_list, GL_R32UI, isIndirect ? GL_DYNAMIC_COPY_ARB : GL_STREAM_DRAW_ARB);
    if (isIndirect) {
        _commands = new osg::DefaultIndirectCommandDrawElements;
        _commands->getBufferObject()->setUsage(GL_DYNAMIC_COPY_ARB);
    }
    for (std::size_t level = 0; level < character.levelCount(); ++level)
        for (const CrowdCharacter::Part& part : character.parts())
            _draws.push_back(makeDraw(character, part, level, count));
}

CrowdDraws::Draw CrowdDraws::makeDraw(const CrowdCharacter& character,
                                      const CrowdCharacter::Part& part, std::size_t level,
                                      Count count) {
    const CrowdCharacter::Skin& skin = character.skins()[part.skin];
    const std::vector<GLuint>& indices = part.indices[level];
    const osg::ref_ptr<osg::Geometry> geometry =
        new osg::Geometry(*part.rest, osg::CopyOp::SHALLOW_COPY);
    geometry->removePrimitiveSet(0, geometry->getNumPrimitiveSets());
    const auto size = static_cast<unsigned int>(indices.size());
    if (count == Count::Indirect) {
        const osg::ref_ptr<osg::DrawElementsIndirectUInt> elements =
            new osg::DrawElementsIndirectUInt(GL_TRIANGLES, size, indices.data());
        elements->setIndirectCommandArray(_commands);
        elements->setFirstCommandToDraw(static_cast<unsigned int>(_commands->size()));
        _commands->push_back(osg::DrawElementsIndirectCommand(size, 0, 0, 0, 0));
        geometry->addPrimitiveSet(elements);
    } else {
        geometry->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, size, indices.data(), 1));
    }
    geometry->setUseDisplayList(false);
    geometry->setSupportsDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setUpdateCallback(nullptr);
    geometry->setCullCallback(nullptr);
    geometry->setCullingActive(false);
    geometry->setDrawCallback(
        new TexelCheck(std::max({_capacity * CrowdInstance::kTexels, std::size_t{_list->size()},
                                 texelsOf(*part.model), texelsOf(*skin.clips)}),
                       geometry->getDrawCallback()));
    geometry->setComputeBoundingBoxCallback(new osg::Drawable::ComputeBoundingBoxCallback);

    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setTextureAttribute(kCrowdModelUnit, part.model);
    state->setTextureAttribute(kCrowdClipUnit, skin.clips);
    state->setTextureAttribute(kCrowdVisibleUnit, _visible);
    state->addUniform(new osg::Uniform("osgSkinFirstVisible", static_cast<int>(level * _capacity)));
    state->addUniform(
        new osg::Uniform("osgSkinPaletteSize", static_cast<int>(skin.model->paletteSize())));
    state->addUniform(new osg::Uniform("osgSkinStand", osg::Matrixf(skin.toCharacter)));
    // The state of a skin's rest geometry is already the skin's.
    const osg::ref_ptr<osg::StateSet> own =
        part.joint >= 0 && part.rest->getStateSet() != part.state ? part.rest->getStateSet()
                                                                  : nullptr;
    if (!character.hasCorrectives(level)) state->setDefine("OSGSKIN_PLAIN");
    if (character.isFar(level)) state->setDefine("OSGSKIN_FAR");
    if (hasTexture(part.state) || hasTexture(own)) state->setDefine("OSGSKIN_TEXTURE");
    geometry->setStateSet(state);
    return {forCrowds(part.state), forCrowds(own), geometry, level,
            indices.empty() || count == Count::Direct};
}

void CrowdDraws::setCount(std::size_t level, std::size_t members) {
    for (Draw& draw : _draws) {
        if (draw.level != level) continue;
        osg::PrimitiveSet& elements = *draw.geometry->getPrimitiveSet(0);
        elements.setNumInstances(static_cast<int>(members)); // 0 would mean one, not instanced
        draw.isEmpty = members == 0 || elements.getNumIndices() == 0;
    }
}

void CrowdDraws::setBound(const osg::BoundingBox& box) {
    for (const Draw& draw : _draws) {
        draw.geometry->setInitialBound(box);
        draw.geometry->getBound();
    }
}

bool CrowdDraws::isFree() const {
    return std::all_of(_draws.begin(), _draws.end(),
                       [](const Draw& draw) { return draw.geometry->referenceCount() == 1; });
}

void CrowdDraws::cull(osgUtil::CullVisitor& cv) const {
    // The primitives are of the rest pose at the origin, so they must not set near and far.
    const osg::CullSettings::ComputeNearFarMode mode = cv.getComputeNearFarMode();
    const auto inherited = cv.getInheritanceMask();
    cv.setComputeNearFarMode(
        std::min(mode, osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES));
    for (const Draw& draw : _draws)
        if (!draw.isEmpty) cullDraw(draw, cv);
    cv.setComputeNearFarMode(mode);
    cv.setInheritanceMask(inherited);
}

void CrowdDraws::cullDraw(const Draw& draw, osgUtil::CullVisitor& cv) {
    if (draw.material) cv.pushStateSet(draw.material);
    if (draw.own) cv.pushStateSet(draw.own);
    draw.geometry->accept(cv);
    if (draw.own) cv.popStateSet();
    if (draw.material) cv.popStateSet();
}

void CrowdDraws::setCommands(osg::State& state, unsigned int members) const {
    osg::GLBufferObject* const buffer =
        _commands->getBufferObject()->getOrCreateGLBufferObject(state.getContextID());
    if (buffer->isDirty()) buffer->compileBuffer();
    std::vector<osg::DrawElementsIndirectCommand> commands(_commands->begin(), _commands->end());
    for (osg::DrawElementsIndirectCommand& command : commands) command.instanceCount = members;
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    state.unbindVertexBufferObject();
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, buffer->getGLObjectID());
    gl.glBufferSubData(GL_ARRAY_BUFFER_ARB, 0, _commands->getTotalDataSize(), commands.data());
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
}

void CrowdDraws::compileGLObjects(osg::RenderInfo& renderInfo) const {
    osg::State& state = *renderInfo.getState();
    for (const Draw& draw : _draws) draw.geometry->compileGLObjects(renderInfo);
    setCommands(state, 1);
    glEnable(GL_RASTERIZER_DISCARD);
    for (const Draw& draw : _draws) {
        if (draw.isEmpty) continue;
        const osg::StateSet* const states[] = {draw.material, draw.own,
                                               draw.geometry->getStateSet()};
        for (const osg::StateSet* one : states)
            if (one) state.pushStateSet(one);
        state.apply(); // a program has a variant for each set of defines
        draw.geometry->draw(renderInfo);
        for (const osg::StateSet* one : states)
            if (one) state.popStateSet();
    }
    glDisable(GL_RASTERIZER_DISCARD);
    setCommands(state, 0);
}

void CrowdDraws::resizeGLObjectBuffers(unsigned int maxSize) {
    for (const Draw& draw : _draws) draw.geometry->resizeGLObjectBuffers(maxSize);
}

void CrowdDraws::releaseGLObjects(osg::State* state) const {
    for (const Draw& draw : _draws) draw.geometry->releaseGLObjects(state);
}

} // namespace osgSkin
