// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/DeformableSkin>

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

/// The skinning matrices that Pose::set() makes this skin's pose from, one per joint: its
/// rotations, translations and uniform scales.
std::vector<glm::dmat4> skinningOf(const osgSkin::DeformableSkin& skin);

/// Why a file's skinning matrix cannot be a joint's, or would put vertices where single precision
/// has no numbers. Empty: it can.
std::string whatIsWrongWith(const glm::dmat4& skinning);
