// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source/CharacterSource.h"

#include <osgSkinBind/BindReport>
#include <osgSkinBind/BindWeights>

namespace osgSkin {

/// Tells of a skeleton that is hardly this body's: in another unit, with another axis up, in
/// another place. Such a body can be bound, but to the wrong joints.
///
/// \param source with body and rest skeleton; gets a note
/// \param report of its binding by regions
void tellMisfit(CharacterSource& source, const BindReport& report);

/// The same of a body that is bound by weights from outside: the joints that they name lie around
/// its skin.
///
/// \param source with body and rest skeleton; gets a note
/// \param weights of its vertices
void tellMisfit(CharacterSource& source, const VertexWeights& weights);

/// Tells of a body so far from the origin that skins, which have floats, cannot hold its shape.
///
/// \param source with a body; gets a note
void tellRounding(CharacterSource& source);

} // namespace osgSkin
