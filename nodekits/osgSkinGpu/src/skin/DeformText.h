// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgSkin {

/// The deformation in GLSL 3.30, without a `#version`: osgSkin_deform() and what it calls. Compute
/// and vertex shaders get the same text, so that they give the same bits.
const std::string& deformText();

} // namespace osgSkin
