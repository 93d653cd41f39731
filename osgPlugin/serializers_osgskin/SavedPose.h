// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>

#include <string>

/// Why a file's skinning matrix cannot be a joint's, or would put vertices where single precision
/// has no numbers. Empty: it can.
std::string whatIsWrongWith(const glm::dmat4& skinning);
