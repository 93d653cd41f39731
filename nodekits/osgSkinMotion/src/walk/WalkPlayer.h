// SPDX-License-Identifier: MIT
#pragma once

#include "clips/JointMaps.h"
#include "walk/GaitState.h"

#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/Gaits>

#include <osg/BoundingBox>
#include <osg/Matrixd>

#include <array>
#include <limits>
#include <vector>

namespace osgSkin {

/// Poses a figure that goes as a GaitState says. Walker space, see Gaits.
class WalkPlayer : public ClipPlayer, private GaitState {
public:
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

    using Feet = std::array<Foot, 2>;

    struct Stance {
        std::vector<JointSample> joints;
        Feet feet;
    };

    /// \param gaits must outlive it
    explicit WalkPlayer(const Gaits& gaits);

    /// Finds the joints where the figure goes so; pose() shows them. Feet that carried before keep
    /// their place.
    /// \param dt seconds since the last call
    /// \param feet of another figure that goes so, which it takes over; null: its own
    void follow(const GaitState& gait, double dt, const Feet* feet = nullptr);

    Stance stance() const { return {_joints, _feet}; }

    /// Takes joints that are known.
    void show(const std::vector<JointSample>& joints);

    /// Sets the skins' bounds in all poses, one for each; null: they are computed for each pose.
    void setBounds(const std::vector<osg::BoundingBox>* bounds) { _bounds = bounds; }

    double hipsHeight() const { return _height; } ///< above the floor
    double meanLeg() const { return _leg; }       ///< from hip to ankle
    double unit() const { return _unit; }         ///< walker units for one of rest space

    /// The matrix of a joint that moves with others, from rest space to walker space.
    osg::Matrixd matrixOf(std::size_t joint) const;

    /// Plays a clip on the upper body once.
    bool playClip(const SampledClip& clip, double fade);

    /// Whether it plays a clip on the upper body.
    bool isPlaying() const { return getLayer(kPartLayer).clip != nullptr; }

    /// Whether it makes a step on the spot.
    bool isStepping() const { return _feet[0].step >= 0.0 || _feet[1].step >= 0.0; }

protected:
    const JointSample* posedJoints() const override { return _joints.data(); }
    const osg::BoundingBox* knownBounds(std::size_t skin) const override {
        return _bounds && !isPlaying() ? &(*_bounds)[skin] : nullptr;
    }

private:
    void blendGaits();
    void moveFeet(double dt, double phaseStep);
    void plant(Foot& foot, std::size_t side);
    void stayAt(Foot& foot, const glm::dvec3& pivot);
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

    const glm::dmat4 _toWalker; ///< from rest space
    const glm::dquat _fromRest; ///< its rotation
    double _unit = 1.0;         ///< walker units for one of rest space
    /// The height of the standing soles.
    double _floor = std::numeric_limits<double>::infinity();
    std::array<double, 2> _radius{}; ///< of the balls of the feet: their heights above the soles
    double _leg = 0.0;               ///< from hip to ankle
    const std::vector<osg::BoundingBox>* _bounds = nullptr;

    Feet _feet;
    std::vector<JointSample> _joints; ///< of the present pose
    std::vector<JointMap> _whole;     ///< the same, with the joints above
};

} // namespace osgSkin
