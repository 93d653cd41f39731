// SPDX-License-Identifier: MIT
#pragma once

#include "clips/JointMaps.h"

#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/Gaits>

#include <osg/Matrixd>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace osgSkin {

/// From 0 to 1 without a jerk.
inline double smooth(double share) {
    const double x = std::clamp(share, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

/// At most a step nearer.
inline double towards(double from, double to, double most) {
    return from + std::clamp(to - from, -most, most);
}

/// Poses a figure by the way that it is carried. Walker space, see Gaits.
class WalkPlayer : public ClipPlayer {
public:
    explicit WalkPlayer(const osg::ref_ptr<const Gaits>& gaits);

    /// Moves the figure on from where it was, and finds its joints; pose() shows them.
    ///
    /// \param place from walker space to the space of the ground; not singular
    /// \param dt seconds since the last call
    /// \param speed along the heading; null: as the places say
    void move(const osg::Matrixd& place, double dt, const double* speed = nullptr);

    /// Stands where it is, as if it had never moved.
    void stand();

    /// Plays the standing clip.
    void breathe(double dt) { _standingTime += dt; }

    double phase() const { return _phase; }
    double speed() const { return _direction * _pace; }

    /// Plays a clip on the upper body once.
    bool playClip(const SampledClip& clip, double fade);

    /// Whether another move() without way and with any time would change nothing.
    bool isStill() const;

protected:
    const JointSample* posedJoints() const override { return _joints.data(); }

private:
    static constexpr double kGaitTime = 0.3; ///< seconds from standing to walking, and to running

    enum SolePoint : std::size_t { Heel, Ball, Tip };

    struct Foot {
        bool isPlanted = true;
        bool isPlaced = false;  ///< `spot` and `heading` are known
        SolePoint pivot = Ball; ///< about which it turns and rolls
        osg::Vec3d spot;        ///< where the pivot stands, in the space of the ground
        osg::Vec3d heading;     ///< of the figure when it was planted, in the space of the ground
        osg::Vec3d offset;      ///< from the clips' place of the pivot to its own
        double turn = 0.0;      ///< from the clips' direction to its own, about Z
        double lift = 0.0;      ///< over the clips' height
        double step = -1.0;     ///< share of a step on the spot; below 0: none
        osg::Vec3d stepOffset;  ///< at the step's start
        double stepTurn = 0.0;
    };

    double measureWay(const osg::Matrixd& place);
    void measureSpeed(double way, double dt);
    void chooseGait(double dt);
    void advancePhase(double way);
    void blendGaits();
    void moveFeet(double dt, double phaseStep);
    void plant(Foot& foot, std::size_t side);
    void rollOnto(Foot& foot, std::size_t side, SolePoint point);
    void stepOnTheSpot(double dt);
    void bendLegs();
    void lowerHips(const std::array<osg::Vec3d, 2>& targets);
    osg::Vec3d soleOf(std::size_t side, SolePoint point) const;
    double heightOf(std::size_t side) const;
    SolePoint pivotOf(std::size_t side, SolePoint now) const;
    osg::Vec3d jointOf(std::size_t joint) const;
    void rotateJoint(std::size_t joint, const glm::dquat& world);
    void findLeg(std::size_t first, std::size_t last);
    double legLength(const Gaits::Leg& leg) const;
    double stride() const;
    bool isStopped() const;

    const osg::ref_ptr<const Gaits> _gaits;
    const osg::Vec3d _forward;  ///< in which it looks
    const glm::dquat _toWalker; ///< the rotation of the gaits' toWalker
    double _unit = 1.0;         ///< walker units for one of rest space
    /// The height of the standing soles.
    double _floor = std::numeric_limits<double>::infinity();
    std::array<double, 2> _radius{};  ///< of the balls of the feet: their heights above the soles
    double _height = 0.0, _leg = 0.0; ///< of the hips above the floor; from hip to ankle

    osg::Matrixd _place;
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
