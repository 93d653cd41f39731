// SPDX-License-Identifier: GPL-3.0-or-later
#include "muscles/Calibrate.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using Heights = MuscleSkin::Heights;

constexpr int kRounds = 8;

/// What is lowered is at most this many times what a spindle lowers.
constexpr double kMostLowered = 2.5;

/// Spindle with what it lifts times `up` and what it lowers times `down`.
Heights scaled(const Heights& spindle, double up, double down) {
    Heights result;
    for (const double h : spindle) result.push_back(h > 0.0 ? up * h : down * h);
    return result;
}

Heights sum(Heights a, const Heights& b, double amount) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += amount * b[i];
    return a;
}

} // namespace

MuscleSkin::Heights calibrate(const MuscleSkin& skin, const Heights& spindle,
                              const Heights& already, double amount, double girth) {
    const double before = skin.girth(already), volume = skin.volume(already);
    const double highest =
        spindle.empty() ? 0.0 : *std::max_element(spindle.begin(), spindle.end());
    if (!(before > 0.0) || !(girth > before) || !(highest > 0.0)) return {};
    double up = (girth - before) / highest / amount, down = up;
    for (int round = 0; round < kRounds; ++round) {
        const double grown = skin.girth(sum(already, scaled(spindle, up, down), amount)) - before;
        if (!(grown > 0.0)) return {};
        up *= (girth - before) / grown;
        // The volume is nearly linear in what is lowered.
        const double without = skin.volume(sum(already, scaled(spindle, up, 0.0), amount)) - volume;
        const double lost =
            without + volume - skin.volume(sum(already, scaled(spindle, up, up), amount));
        down = lost > 0.0 ? up * std::min(kMostLowered, std::max(0.0, without / lost)) : up;
    }
    return scaled(spindle, up, down);
}

} // namespace osgSkin
