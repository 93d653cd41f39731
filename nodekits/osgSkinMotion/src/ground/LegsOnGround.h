// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/GlmTypes>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

namespace osgSkin {

/// A leg of a clip's pose.
struct ClipLeg {
    glm::dvec3 hip, knee, ankle;
    glm::dvec3 knees;               ///< unit, the direction in which the thigh's knee points
    std::array<glm::dvec3, 3> sole; ///< its heel, ball and tip
};

/// A plane that a foot may stand on.
struct GroundPlane {
    glm::dvec3 point;
    glm::dvec3 normal{0.0, 0.0, 1.0}; ///< unit, upwards

    double heightAt(const glm::dvec3& place) const;
};

/// Moves the legs of a figure whose clips were made on a level floor to other ground.
///
/// All vectors are in one space that moves with the figure, Z up.
class LegsOnGround {
public:
    /// Finds the ground above or below a point, whatever its height.
    using FindGround = std::function<std::optional<GroundPlane>(const glm::dvec3& point)>;

    /// The rotations of a leg's bones in the figure's space, from their clip's directions.
    struct Turns {
        glm::dquat thigh{1.0, 0.0, 0.0, 0.0}, shin = thigh, foot = thigh;
    };

    /// \param floor height that the clips stand on
    /// \param leg length, from hip to ankle
    LegsOnGround(double floor, double leg) : _floor(floor), _leg(leg) {}

    /// One frame. The first one stands on the ground at once.
    ///
    /// \param clip the left and the right leg
    /// \param dt seconds since the last step
    /// \param carried from the space of the last step to the present one: how the figure was moved
    /// \param ground is called three to five times for each foot, and three times more at an edge
    void step(const std::array<ClipLeg, 2>& clip, double dt, const glm::dmat4& carried,
              const FindGround& ground);

    /// Of the hips, and all that they carry, along Z.
    double lift() const { return _lift; }
    const Turns& turns(std::size_t side) const { return _feet[side].turns; }

private:
    friend struct AttachmentFile; // the serializers'

    enum SolePoint : std::size_t { Heel, Ball, Tip };
    using SolePoints = std::array<glm::dvec3, 3>;

    struct Foot {
        bool isPlanted = true;
        GroundPlane from, next;     ///< on which it stood, and is to stand; while planted the same
        glm::dvec3 lifted{0.0};     ///< the clip's ball of the foot where it left `from`
        glm::dvec3 shift{0.0};      ///< from the clip's place, off the edges of steps
        double way = 1.0;           ///< share of its way through the air
        double share = 1.0;         ///< of the way to the height of `next`
        double clear = 0.0;         ///< over that way, for edges between
        double error = 0.0;         ///< of the height at which it is shown, to be lost
        double errorSpeed = 0.0;    ///< a second
        glm::dvec3 normal{0, 0, 1}; ///< as it is shown
        SolePoints sole{};          ///< the clip's, of the last step
        glm::dvec3 speed{0.0};      ///< of its ball over the ground, level
        double brake = 0.0;         ///< how much slower it becomes in a second
        double stood = 0.0;         ///< seconds since it was set down
        double slides = 0.0;        ///< seconds for which it has been faster than a standing foot
        glm::dvec3 ankle{0.0};      ///< where the leg should end
        Turns turns;
    };

    static double heightOf(const Foot& foot, const glm::dvec3& place);
    class BelowSole;

    GroundPlane findPlane(const SolePoints& sole, const GroundPlane* chosen,
                          const FindGround& ground, glm::dvec3& shift) const;
    double remainingSwing(const ClipLeg& leg, const Foot& foot, const Foot& other) const;
    void measure(const ClipLeg& leg, Foot& foot, double dt) const;
    void stand(const ClipLeg& leg, Foot& foot, double dt, const FindGround& ground) const;
    void swing(const ClipLeg& leg, Foot& foot, const Foot& other, double dt,
               const FindGround& ground) const;
    void place(const ClipLeg& leg, std::size_t side, double dt, const FindGround& ground);
    double reach(const ClipLeg& leg, const Foot& foot) const;
    double hipsHeight() const;
    void moveHips(const std::array<ClipLeg, 2>& clip, double dt, double carriedUp);
    void bend(const ClipLeg& leg, Foot& foot) const;

    const double _floor, _leg;
    std::array<Foot, 2> _feet;
    std::size_t _newest = 0; ///< the foot that was lifted or set down last
    double _lift = 0.0, _liftSpeed = 0.0;
    bool _isPlaced = false;
};

} // namespace osgSkin
