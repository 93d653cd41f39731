// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Matrixd>
#include <osg/Quat>
#include <osg/Vec3d>

#include <array>
#include <cstddef>
#include <functional>

namespace osgSkin {

/// A leg of a clip's pose. The sole's points are those of the standing figure's.
struct ClipLeg {
    osg::Vec3d hip, knee, ankle;
    osg::Vec3d heel, ball, tip; ///< of the sole
    osg::Vec3d knees;           ///< unit, the direction in which the thigh's knee points
};

/// A plane that a foot may stand on.
struct GroundPlane {
    osg::Vec3d point;
    osg::Vec3d normal{0.0, 0.0, 1.0}; ///< unit, upwards

    double heightAt(const osg::Vec3d& place) const;
};

/// Moves the legs of a figure whose clips were made on a level floor to other ground.
///
/// All vectors are in one space that moves with the figure, Z up.
class LegsOnGround {
public:
    /// Finds the ground above or below a point, whatever its height.
    /// \return false where there is none
    using FindGround = std::function<bool(const osg::Vec3d& point, GroundPlane& ground)>;

    /// The rotations of a leg's bones in the figure's space, from their clip's directions.
    struct Turns {
        osg::Quat thigh, shin, foot;
    };

    /// \param floor height that the clips stand on
    /// \param leg length, from hip to ankle
    LegsOnGround(double floor, double leg) : _floor(floor), _leg(leg) {}

    /// Begins again: the next step stands on the ground at once.
    void restart() { _isPlaced = false; }

    /// One frame.
    ///
    /// \param clip the left and the right leg
    /// \param dt seconds since the last step
    /// \param carried from the space of the last step to the present one: how the figure was moved
    /// \param ground is called three times for each foot
    void step(const std::array<ClipLeg, 2>& clip, double dt, const osg::Matrixd& carried,
              const FindGround& ground);

    /// Of the hips, and all that they carry, along Z.
    double lift() const { return _lift; }
    const Turns& turns(std::size_t side) const { return _feet[side].turns; }

private:
    struct Foot {
        bool isPlanted = true;
        GroundPlane from, next;     ///< on which it stood, and is to stand; while planted the same
        osg::Vec3d lifted;          ///< the clip's ball of the foot where it left `from`
        osg::Vec3d shift;           ///< from the clip's place, off the edges of steps
        double share = 1.0;         ///< of the way to the height of `next`
        double error = 0.0;         ///< of the height at which it is shown, to be lost
        double errorSpeed = 0.0;    ///< a second
        osg::Vec3d normal{0, 0, 1}; ///< as it is shown
        double height = 0.0;        ///< of the ground, as it is shown
        osg::Vec3d heel, ball, tip; ///< the clip's, of the last step
        osg::Vec3d speed;           ///< over the ground, level
        double brake = 0.0;         ///< how much slower it becomes in a second
        double stood = 0.0;         ///< seconds since it was set down
        double slides = 0.0;        ///< seconds for which it has been faster than a standing foot
        double way = 1.0;           ///< share of its way through the air
        double clear = 0.0;         ///< over the way from `from` to `next`, for edges between
        osg::Vec3d ankle;           ///< where the leg should end
        Turns turns;
    };

    /// A sole, and the ground below it.
    struct Sole {
        osg::Vec3d heel, ball, tip;
        GroundPlane atHeel, atBall, atTip;
        bool hasHeel = false, hasBall = false, hasTip = false;
    };

    static Sole findSole(const osg::Vec3d& heel, const osg::Vec3d& ball, const osg::Vec3d& tip,
                         const FindGround& ground);
    GroundPlane findPlane(const Sole& sole, bool& isOnEdge) const;
    GroundPlane chooseStep(const Sole& sole, const GroundPlane* chosen, const FindGround& ground,
                           osg::Vec3d& shift) const;
    bool supports(const Sole& sole, const GroundPlane& plane) const;
    double shareOn(const GroundPlane& plane, const osg::Vec3d& from, const osg::Vec3d& to,
                   const FindGround& ground) const;
    static double heightOf(const Foot& foot, const osg::Vec3d& ball);
    double wayLeft(const ClipLeg& leg, const Foot& foot, const Foot& other) const;
    void stand(const ClipLeg& leg, Foot& foot, double dt, const FindGround& ground);
    void swing(const ClipLeg& leg, Foot& foot, const Foot& other, double dt,
               const FindGround& ground);
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
