// SPDX-License-Identifier: MIT
#include "Clock.h"

#include <cmath>

namespace viewer {

void Clock::advance(double seconds) {
    if (playing) seek(_time + speed * seconds);
}

void Clock::seek(double seconds) {
    _time = _length > 0.0 ? seconds - _length * std::floor(seconds / _length) : 0.0;
}

} // namespace viewer
