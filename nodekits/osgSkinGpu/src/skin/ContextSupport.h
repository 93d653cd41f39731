// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osg {
class State;
} // namespace osg

namespace osgSkin {

/// Contexts that skins are computed in; what others draw is deformed by the processor.
constexpr unsigned int kMostContexts = 64;

/// Whether a context can run our compute shaders. From any thread; false before the context has
/// looked at its own extensions, which it does at its first draw.
bool canCompute(const osg::State& state);

/// Notes that a context cannot, whatever it says of itself.
void noteCannotCompute(unsigned int contextId);

/// Whether a buffer of so many texels can be read by the shaders of a context, the current one.
bool canReadTexels(unsigned int contextId, std::size_t texels);

} // namespace osgSkin
