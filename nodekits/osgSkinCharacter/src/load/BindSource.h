// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source/CharacterSource.h"

#include <osgSkin/Binding>
#include <osgSkinBind/BindReport>
#include <osgSkinBind/Progress>

namespace osgSkin {

/// Binds the body to the rest skeleton, by regions or by painted weights as the source says.
///
/// \param source with body and rest skeleton
/// \param progress of the binding; may be empty
/// \param report filled in
/// \return the binding, vertex by vertex of the body's mesh
/// \throw Error with the file and the reason
Binding bindSource(CharacterSource& source, const Progress& progress, BindReport& report);

} // namespace osgSkin
