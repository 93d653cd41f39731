// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace mannequin {

/// A value at a time: seconds; metres or degrees.
struct Key {
    double time;
    double value;
};

/// A periodic curve through keys that neither overshoots nor jerks.
///
/// A monotone piecewise cubic (Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246) holds
/// still between equal keys, so that a planted foot stays planted; it is then averaged with the
/// biweight kernel (1 - u^2)^2 of half-width `softness`, which makes the acceleration continuous.
/// Averaging widens every movement by `softness` at both ends.
class Channel {
public:
    Channel() = default;

    /// \param softness half-width of the averaging kernel in seconds; 0 for none
    /// \param keys by rising time within [0, loopSeconds()); the curve repeats with that period
    Channel(double softness, std::vector<Key> keys);

    double at(double time) const;

private:
    double cubicAt(double time) const;

    double softness_ = 0;
    std::vector<Key> keys_; ///< with one key more at each end than one period needs
    std::vector<double> slopes_;
};

} // namespace mannequin
