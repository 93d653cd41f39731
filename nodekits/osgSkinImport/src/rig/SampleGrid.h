// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAMPLEGRID_H
#define OSGSKINIMPORT_SAMPLEGRID_H 1

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Even samples of tracks whose keys may stand anywhere: 30 a second or more, and where keys keep
/// to some rate up to 240, at every key. Where they keep to none, 120 a second; then each key is
/// within half a step of a sample, which is to take it (see step()).
class SampleGrid {
public:
    /// \param times of all keys, in seconds; finite, at least one
    explicit SampleGrid(std::vector<double> times);

    std::size_t samples() const { return _samples; }
    double step() const { return _step; } ///< seconds between samples; 0 for a single one
    double time(std::size_t sample) const { return _first + _step * static_cast<double>(sample); }

private:
    double _first = 0.0, _step = 0.0;
    std::size_t _samples = 1;
};

} // namespace osgSkin

#endif
