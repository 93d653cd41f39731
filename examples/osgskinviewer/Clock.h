// SPDX-License-Identifier: MIT
#pragma once

namespace viewer {

/// Where a motion stands: plays, pauses, runs at any speed either way, begins again at its end.
class Clock {
public:
    explicit Clock(double seconds = 0.0) : _length(seconds) {}

    void advance(double seconds); ///< of real time
    void seek(double seconds);    ///< to a place in the motion, wrapped into it
    double time() const { return _time; }
    double length() const { return _length; }

    bool playing = true;
    double speed = 1.0; ///< negative: backwards

private:
    double _length; ///< 0: nothing moves
    double _time = 0.0;
};

} // namespace viewer
