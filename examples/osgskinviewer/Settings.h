// SPDX-License-Identifier: MIT
#pragma once

#include "Body.h"

#include <cstddef>

namespace viewer {

enum class Colours { Own, Regions, Bend, Twist };

/// What a person may turn on and off.
struct Settings {
    figures::Method method = figures::Method::Ours;
    Colours colours = Colours::Own;
    std::size_t joint = 0;      ///< whose ratios are shown
    bool tensed = false;        ///< all muscles
    bool turnedNormals = false; ///< instead of the surface's
    bool skeleton = false;
    bool wireframe = false;
    bool bounds = false;
    bool help = false;
    bool status = true;
};

} // namespace viewer
