// SPDX-License-Identifier: MIT
#pragma once

#include "Subdivide.h"

#include <osgSkin/Correctives>

#include <vector>

namespace bench {

/// The correctives of new vertices as means of the old ones'. None where there are none.
osgSkin::Correctives blend(const osgSkin::Correctives& correctives,
                           const std::vector<Blend>& vertices);

} // namespace bench
