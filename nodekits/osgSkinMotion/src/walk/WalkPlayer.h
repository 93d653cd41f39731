// SPDX-License-Identifier: MIT
#pragma once

#include "clips/JointMaps.h"

#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/Gaits>

#include <osg/ref_ptr>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace osgSkin {

/// At most a step nearer.
inline double towards(double from, double to, double most) {
    return from + std::clamp(to - from, -most, most);
}

/// Poses a figure from its displacement. Walker space, see Gaits.
class WalkPlayer : public ClipPlayer {
public:
    explicit WalkPlayer(const osg::ref_ptr<const Gaits>& gaits);

    /// Moves the figure on from where it was, and finds its joints; pose() shows them.
    ///
    /// \param place from walker space to the space of the ground; not singular
    /// \param dt seconds since the last call
    /// \param speed along the heading; null: as the places say
    void move(const glm::dmat4& place, double dt, const double* speed = nullptr);

    /// Stands where it is, as if it had never moved.
    void stand();

    /// Plays the standing clip.
    void breathe(double dt) { _standingTime += dt; }

    double phase() const { return _phase; }
    double speed() const { return _direction * _pace; }

    /// Plays a clip on the upper body once.
    bool playClip(const SampledClip& clip, double fade);

    /// Whether the walker is idle: a move() without displacement would change nothing.
    bool isStill() const;

protected:
    const JointSample* posedJoints() const override { return _joints.data(); }

private:
    static constexpr double kGaitTime = 0.3; ///< seconds from standing to walking, and to running

    enum SolePoint : std::size_t { Heel, Ball, Tip };

    struct Foot {
        bool isPlanted = true;
        bool isPlaced = false;   ///< `spot` and `heading` are known
        SolePoint pivot = Ball;  ///< about which it turns and rolls
        glm::dvec3 spot{0.0};    ///< where the pivot stands, in the space of the ground
        glm::dvec3 heading{0.0}; ///< of the figure when it was planted, in the space of the ground
        glm::dvec3 offset{0.0};  ///< from the clips' place of the pivot to its own
        double turn = 0.0;       ///< from the clips' direction to its own, about Z
        double lift = 0.0;       ///< over the clips' height
        double step = -1.0;      ///< share of a step on the spot; below 0: none
        glm::dvec3 stepOffset{0.0}; ///< at the step's start
        double stepTurn = 0.0;
    };

    double measureWay(const glm::dmat4& place);
    void measureSpeed(double way, double dt);
    void chooseGait(double dt);
    void advancePhase(double way);
    void blendGaits();
    void moveFeet(double dt, double phaseStep);
    void plant(Foot& foot, std::size_t side);
    void rollOnto(Foot& foot, std::size_t side, SolePoint point);
    void stepOnTheSpot(double dt);
    void bendLegs();
    void lowerHips(const std::array<glm::dvec3, 2>& targets);
    glm::dvec3 soleOf(std::size_t side, SolePoint point) const;
    double heightOf(std::size_t side) const;
    SolePoint pivotOf(std::size_t side, SolePoint now) const;
    glm::dvec3 jointOf(std::size_t joint) const;
    void rotateJoint(std::size_t joint, const glm::dquat& world);
    void findLeg(std::size_t first, std::size_t last);
    double legLength(const Gaits::Leg& leg) const;
    double stride() const;
    bool isStopped() const;

    const osg::ref_ptr<const Gaits> _gaits;
    const glm::dmat4 _toWalker; ///< from rest space
    const glm::dquat _fromRest; ///< its rotation
    const glm::dvec3 _forward;  ///< in which it looks
    double _unit = 1.0;         ///< walker units for one of rest space
    /// The height of the standing soles.
    double _floor = std::numeric_limits<double>::infinity();
    std::array<double, 2> _radius{};  ///< of the balls of the feet: their heights above the soles
    double _height = 0.0, _leg = 0.0; ///< of the hips above the floor; from hip to ankle

    glm::dmat4 _place{1.0};
    bool _isPlaced = false;
    double _pace = 0.0;      ///< along the ground, smoothed, whatever the direction
    double _direction = 1.0; ///< -1 where it goes backwards
    double _newWay = 0.0;    ///< since the last call with a time
    double _still = 0.0;     ///< seconds since it last moved
    double _walking = 0.0;   ///< 0 stands, 1 goes with full strides
    double _running = 0.0;   ///< 0 walks, 1 runs
    double _phase = 0.0;
    double _standingTime = 0.0;
    std::array<Foot, 2> _feet;
    std::vector<JointSample> _joints; ///< of the present pose
    std::vector<JointMap> _whole;     ///< the same, with the joints above
};

} // namespace osgSkin
