// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/DeformJob>
#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <cstddef>

namespace osgSkin {

/// Whether a pose moves nothing: all joints are as they rest, and all inputs 0.
bool isAtRest(const SkinModel& model, const Pose& pose) noexcept;

/// Writes the rest vertices to a job's outputs, to the last bit: kernels keep them in their groups'
/// own frames, and rounding would show on the way back.
///
/// \param job valid
/// \param first in SkinModel::order()
/// \param end the one behind the last
void copyRest(const DeformJob& job, std::size_t first, std::size_t end) noexcept;

} // namespace osgSkin
