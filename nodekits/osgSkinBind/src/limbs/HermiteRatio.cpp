// SPDX-License-Identifier: GPL-3.0-or-later
#include "limbs/HermiteRatio.h"

#include <algorithm>

namespace osgSkin {

double hermiteRatio(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace osgSkin
