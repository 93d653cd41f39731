// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source/CharacterSource.h"

#include <osgSkin/Binding>
#include <osgSkinBind/BindWeights>

#include <cstddef>

namespace osgSkin {

/// Puts right what regions cannot know of a body of several shells: what a hand holds belongs to
/// the hand, however near it comes to a leg, and a head that is a shell of its own is one piece.
///
/// With painted weights, a shell that is painted wholly for one joint of a hand or a head, at or
/// below it, follows that joint alone; one painted for several joints of a head, the head. Without,
/// a shell most of whose vertices are in a head's region follows the head, but for the largest.
///
/// \param source with its body and its skeleton
/// \param weights of the body's mesh; empty where there are none
/// \param binding of the body, by regions; changed
/// \return the number of shells that were changed
std::size_t keepShells(const CharacterSource& source, const VertexWeights& weights,
                       Binding& binding);

} // namespace osgSkin
