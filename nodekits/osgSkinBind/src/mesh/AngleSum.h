// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ANGLESUM_H
#define OSGSKINBIND_ANGLESUM_H

#include <cmath>

namespace osgSkin {

/// Sums angles. Arc tangents are slow, so small angles, given by their tangents, are multiplied as
/// complex numbers first.
class AngleSum {
public:
    /// Adds atan2(sine, cosine).
    void add(double sine, double cosine) {
        if (!(std::abs(sine) < kSmall * cosine)) {
            _sum += std::atan2(sine, cosine);
            return;
        }
        const double tangent = sine / cosine, imaginary = _imaginary + _real * tangent;
        _real -= _imaginary * tangent;
        _imaginary = imaginary;
        if (++_count == kMaxCount) flush();
    }
    double value() {
        flush();
        return _sum;
    }

private:
    static constexpr double kSmall = 0.3;
    static constexpr int kMaxCount = 10; ///< less than half a turn together

    void flush() {
        _sum += std::atan2(_imaginary, _real);
        _real = 1.0;
        _imaginary = 0.0;
        _count = 0;
    }

    double _sum = 0.0, _real = 1.0, _imaginary = 0.0;
    int _count = 0;
};

} // namespace osgSkin

#endif
