// SPDX-License-Identifier: MIT
#include "skin/ContextSupport.h"

#include <osg/GLExtensions>
#include <osg/State>

#include <array>
#include <atomic>

#ifndef GL_MAX_TEXTURE_BUFFER_SIZE
#define GL_MAX_TEXTURE_BUFFER_SIZE 0x8C2B
#endif

namespace osgSkin {
namespace {

std::array<std::atomic<bool>, kMostContexts>& failed() {
    static std::array<std::atomic<bool>, kMostContexts> contexts{};
    return contexts;
}

} // namespace

bool canCompute(const osg::State& state) {
    const unsigned int id = state.getContextID();
    if (id >= kMostContexts || failed()[id]) return false;
    // Asking for the extensions needs the context; those that are known may be read by any thread.
    const osg::GLExtensions* extensions = osg::GLExtensions::Get(id, false);
    // A driver without compute shaders may give their functions' addresses all the same.
    return extensions && extensions->glslLanguageVersion >= 4.3f &&
           osg::isGLExtensionOrVersionSupported(id, "GL_ARB_compute_shader", 4.3f) &&
           osg::isGLExtensionOrVersionSupported(id, "GL_ARB_shader_storage_buffer_object", 4.3f) &&
           extensions->glDispatchCompute && extensions->glMemoryBarrier;
}

void noteCannotCompute(unsigned int contextId) {
    if (contextId < kMostContexts) failed()[contextId] = true;
}

bool canReadTexels(unsigned int contextId, std::size_t texels) {
    static std::array<std::atomic<GLint>, kMostContexts> known{}; // a driver may be slow to ask
    GLint most = contextId < kMostContexts ? known[contextId].load() : 0;
    if (most == 0) {
        glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
        if (contextId < kMostContexts) known[contextId] = most;
    }
    return most > 0 && texels <= static_cast<std::size_t>(most);
}

} // namespace osgSkin
