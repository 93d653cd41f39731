// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "file/JsonReader.h"

#include <osgSkinBind/BindOptions>

namespace osgSkin {

/// "muscles" of a `.skin` file: true or false, or a list of own ones, in which `true` stands for
/// the automatic ones.
/// \throw Error where it is none of these
void readMuscles(const JsonReader& reader, BindOptions& bind);

} // namespace osgSkin
