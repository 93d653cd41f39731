// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowTiming.h"

#include <vector>

namespace mannequin {

/// A value (metres or degrees) at a time in seconds.
struct Key {
    double time;
    double value;
};

/// A smooth periodic curve through keys that does not overshoot.
///
/// A monotone piecewise cubic (Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246) is
/// constant between equal keys, so that a planted foot does not move. It is then convolved with the
/// biweight kernel (1 - u^2)^2 of half-width `softness`, which makes the acceleration continuous.
/// This extends every movement by `softness` at both ends.
class Channel {
public:
    Channel() = default;

    /// \param softness half-width of the smoothing kernel in seconds; 0 disables smoothing
    /// \param keys in order of time, within [0, period); the curve repeats with that period
    Channel(double softness, std::vector<Key> keys, double period = loopSeconds());

    double at(double time) const;

private:
    double cubicAt(double time) const;

    double softness_ = 0;
    double period_ = 1;
    std::vector<Key> keys_; ///< one period, plus one key at each end
    std::vector<double> slopes_;
};

} // namespace mannequin
