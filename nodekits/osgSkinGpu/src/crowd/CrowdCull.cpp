// SPDX-License-Identifier: MIT
#include "crowd/CrowdCull.h"

#include "crowd/CrowdView.h"
#include "shader/CrowdText.h"
#include "skin/ContextSupport.h"
#include "skin/SharedBarrier.h"

#include <osg/BufferIndexBinding>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/State>
#include <osg/Uniform>

#ifndef GL_COMMAND_BARRIER_BIT
#define GL_COMMAND_BARRIER_BIT 0x00000040
#endif
#ifndef GL_TEXTURE_FETCH_BARRIER_BIT
#define GL_TEXTURE_FETCH_BARRIER_BIT 0x00000008
#endif

namespace osgSkin {

CrowdCull::CrowdCull(const CrowdCharacter& character, const CrowdDraws& draws,
                     osg::TextureBuffer* instances)
    : _commands(draws.commands()), _sizes(character.levelSizes()),
      _parts(static_cast<int>(character.parts().size())),
      _capacity(static_cast<int>(draws.list().size() / character.levelCount())),
      _state(new osg::StateSet) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    const auto ours =
        osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    setBounds(character.bounds());
    setUpBin(*_state, kComputeBin);
    _state->setAttribute(cullProgram(), ours);
    _state->setTextureAttribute(kCrowdInstanceUnit, instances, ours);
    _state->addUniform(new osg::Uniform("osgSkinInstances", static_cast<int>(kCrowdInstanceUnit)),
                       ours);
    _state->setAttribute(new osg::ShaderStorageBufferBinding(kCommandBuffer, _commands), ours);
    _state->setAttribute(new osg::ShaderStorageBufferBinding(kVisibleBuffer, &draws.list()), ours);
}

bool CrowdCull::isIn(osgUtil::CullVisitor& cv) const {
    const auto& bins = cv.getCurrentRenderBin()->getStage()->getRenderBinList();
    const auto bin = bins.find(kComputeBin);
    if (bin == bins.end()) return false;
    for (const osgUtil::StateGraph* graph : bin->second->getStateGraphList())
        for (const auto& leaf : graph->_leaves)
            if (leaf->getDrawable() == this) return true;
    return false;
}

void CrowdCull::drawImplementation(osg::RenderInfo& renderInfo) const {
    osg::State& state = *renderInfo.getState();
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) {
        OSG_WARN << "osgSkin: this driver cannot run the culling shader; the processor culls"
                 << std::endl;
        noteCannotCompute(state.getContextID());
        return;
    }
    const osg::GLBufferObject* commands =
        _commands->getBufferObject()->getGLBufferObject(state.getContextID());
    if (!commands) return;
    state.unbindVertexBufferObject();
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, commands->getGLObjectID());
    gl.glBufferSubData(GL_ARRAY_BUFFER_ARB, 0, _commands->getTotalDataSize(),
                       _commands->getDataPointer());
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);

    const CrowdView view(state.getModelViewMatrix(), state.getProjectionMatrix());
    const auto at = [&](const std::string& name) {
        const GLint place = program->getUniformLocation(name);
        return place >= 0 ? place : program->getUniformLocation(name + "[0]");
    };
    gl.glUniform4fv(at("osgSkinPlanes"), 4, view.planes.front().ptr());
    gl.glUniform4fv(at("osgSkinSphere"), 1, _sphere.ptr());
    gl.glUniform4fv(at("osgSkinEye"), 1, osg::Vec4f(view.eye, view.sizeAtOne).ptr());
    gl.glUniform1i(at("osgSkinIsFlat"), view.isFlat ? 1 : 0);
    const GLint counts[] = {_count, static_cast<GLint>(_sizes.size()), _parts, _capacity};
    gl.glUniform4iv(at("osgSkinCounts"), 1, counts);
    gl.glUniform1fv(at("osgSkinSizes"), static_cast<GLsizei>(_sizes.size()), _sizes.data());
    gl.glDispatchCompute((static_cast<GLuint>(_count) + kCullThreads - 1) / kCullThreads, 1, 1);
    gl.glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

} // namespace osgSkin
