// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinMotion/Gaits>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace osgSkin {

/// At most a step nearer.
inline double towards(double from, double to, double most) {
    return from + std::clamp(to - from, -most, most);
}

/// How a figure goes by its displacement: which gait, and at which phase. It has no pose.
/// Walker space, see Gaits.
class GaitState {
public:
    /// From standing to walking, and from there to running: how long strides of small figures are,
    /// so that a few shared poses are like those of all.
    static constexpr std::size_t kLevels = 6;

    /// \param gaits must outlive it
    /// \param height of the hips above the floor
    GaitState(const Gaits& gaits, double height);

    /// Gives it a start, a stride and a standing pose of its own.
    /// \param number of the figure among those of its kind; 0: as the clips say
    void vary(unsigned int number);

    /// Moves the figure on from where it was.
    ///
    /// \param place from walker space to the space of the ground
    /// \param toWalker its inverse
    /// \param dt seconds since the last call
    /// \param speed along the heading; null: as the places say
    void move(const glm::dmat4& place, const glm::dmat4& toWalker, double dt,
              const double* speed = nullptr);

    /// Stands where it is, as if it had never moved.
    void stand();

    /// Sets whether its strides come to a level while it keeps its speed.
    void keepLevels(bool keeps) { _keepsLevels = keeps; }

    /// Plays the standing clip.
    void breathe(double dt) { _standingTime += dt; }

    /// Stands at a time of the standing clip.
    void show(double standingTime);

    /// Goes with strides and at a phase of the caller's choice.
    /// \param step share of the cycle by which it has just gone on; below 0: backwards
    void show(double walking, double running, double phase, double step);

    double phase() const { return _phase; }
    double speed() const { return _direction * _pace; }
    double walking() const { return _walking; } ///< 0 stands, 1 goes with full strides
    double running() const { return _running; } ///< 0 walks, 1 runs
    /// From 0, standing, to 2 kLevels, running.
    double effort() const { return double(kLevels) * _walking * (1.0 + _running); }
    /// Whether it is so far from all levels that its pose cannot be told by them.
    bool isBetween() const { return std::abs(effort() - std::round(effort())) > 0.15; }
    bool goesBack() const { return _direction < 0.0; }
    double standingTime() const { return _standingTime; }

    /// Whether it is idle: a move() without displacement would change nothing.
    bool isStill() const { return _walking == 0.0 && _pace == 0.0 && _newWay == 0.0; }

protected:
    static constexpr double kGaitTime = 0.3; ///< seconds from standing to walking, and to running

    double stride() const;
    bool isStopped() const;

    const Gaits* _gaits;
    glm::dvec3 _forward; ///< in which it looks
    glm::dmat4 _place{1.0};
    bool _isPlaced = false;
    bool _hasJumped = true;  ///< in the last move
    double _height;          ///< of the hips above the floor
    double _pace = 0.0;      ///< along the ground, smoothed, whatever the direction
    double _direction = 1.0; ///< -1 where it goes backwards
    double _newWay = 0.0;    ///< since the last call with a time
    double _still = 0.0;     ///< seconds since it last moved
    double _walking = 0.0;
    double _running = 0.0;
    double _phase = 0.0;
    double _phaseStep = 0.0; ///< of the last move
    double _standingTime = 0.0;

private:
    double measureWay(const glm::dmat4& place, const glm::dmat4& toWalker);
    void measureSpeed(double way, double dt);
    void chooseGait(double dt);

    /// Brings a share to the next level while what is wanted stays near it.
    struct Level {
        double now = 0.0, off = 0.0; ///< off: from what is wanted
        double follow(double wanted, double dt, bool keeps);
    };

    Level _walkingLevel, _runningLevel;
    bool _keepsLevels = false;
    std::size_t _firstFoot = 1; ///< that steps out
    double _firstSwing = 0.5;   ///< share of its swing that it begins with
    double _stepsPerWay = 1.0;  ///< relative to the clips, below full strides
    double _ownStanding = 0.0;  ///< share of the standing clip in which it stands after a walk
};

} // namespace osgSkin
