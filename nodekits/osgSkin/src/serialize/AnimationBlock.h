// SPDX-License-Identifier: MIT
//
// Animations in files. Exported for the serializers; applications use osgDB.
#pragma once

#include <osgSkin/Export>

#include <osgAnimation/AnimationManagerBase>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Animations as 32-bit words, without loss.
///
/// Number of animations; of each 0 where it is not in the block, else 1 and: name,
/// duration, start time (doubles, low word first), weight (float), play mode; number of channels,
/// and of each: kind (1 rotations, 2 vectors, 3 floats, 4 doubles), name, name of the target,
/// number of keys, of each key its time (double) and value (x, y, z and w doubles; x, y and z
/// floats; a float; a double). Text is the number of its bytes, then four bytes a word, the first
/// lowest.
///
/// Not in the block are those with other channels (matrices, steps, splines), with user data, or
/// of another class than osgAnimation::Animation.
///
/// \param animations none of them null
OSGSKIN_EXPORT std::vector<std::uint32_t>
packAnimations(const osgAnimation::AnimationList& animations);

/// The animations in `words`, which need not be trusted. Keys are shared with those of other loads
/// (osgSkin/ShareEqualData). Thread safe.
///
/// \return in their order; null for those not in the block
/// \throw osgSkin::Error that names the first error
OSGSKIN_EXPORT osgAnimation::AnimationList
unpackAnimations(const std::vector<std::uint32_t>& words);

} // namespace osgSkin
