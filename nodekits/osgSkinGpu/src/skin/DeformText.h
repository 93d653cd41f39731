// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgSkin {

/// The deformation in GLSL 3.30, without a `#version`: osgSkin_deform() and its helpers. Compute
/// and vertex shaders share it, so that their results are equal bit by bit.
const std::string& deformText();

} // namespace osgSkin
