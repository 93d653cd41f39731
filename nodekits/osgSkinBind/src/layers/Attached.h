// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ATTACHED_H
#define OSGSKINBIND_ATTACHED_H

#include "layers/ShellSurface.h"

#include <cstdint>

namespace osgSkin {

/// A vertex that lies on another shell.
struct Attached {
    std::uint32_t vertex;
    SurfacePoint on;
    double gap;  ///< distance from it
    double hold; ///< above 0; 1 where it goes wholly with what it lies on
};

} // namespace osgSkin

#endif
