// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>

#include <string>

/// Describes why a skinning matrix from a file is invalid for a joint, or would move vertices out
/// of the range of single precision. Empty if the matrix is valid.
std::string whatIsWrongWith(const glm::dmat4& skinning);
