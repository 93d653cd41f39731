// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "file/JsonReader.h"

#include <osgSkinBind/FitSkeleton>

namespace osgSkin {

/// What `"skeleton": { "fit": true, ... }` says, without the up axis.
/// \throw Error with file, JSON path and what was expected
FitOptions readFit(const JsonReader& reader);

} // namespace osgSkin
