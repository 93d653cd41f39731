// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_HINGECORE_H
#define OSGSKINBIND_ELASTIC_HINGECORE_H

#include "elastic/energy/Bone.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace osgSkin::elastic {

/// The ball within a hinge: condyles with the knee cap, or the elbow's point. It lies close to the
/// skin of the outer side, which would cave in without it, and fans out from one bone to the other.
struct HingeCore {
    Point centre = Point::Zero();
    double radius = 0.0;
    Point along = Point::Zero();    ///< the limb, unit; zero where that is not known
    double halfWidth = 0.0;         ///< of what turns with neither bone alone, along the limb
    Point outwards = Point::Zero(); ///< to the fold's outer side, unit; zero where not known

    bool contains(const Point& point) const { return (point - centre).norm() < radius; }

    /// How much of the joint's turn a point of the ball takes.
    double shareAt(const Point& point) const {
        return std::clamp(0.5 + 0.5 * point.dot(along) / halfWidth, 0.0, 1.0);
    }
};

struct HingeSizes {
    double radius = 0.5; ///< of the ball
    double below = 0.1;  ///< the skin of the outer side
    /// See HingeCore: of less, the outer side caves in; of more, it swells beside the ball.
    double halfWidth = 2.5;
};

/// \param rotations of the joint, unit: what they have in common says which side is the outer one
/// \return a ball at the joint's centre where nothing says that
HingeCore hingeCore(const Points& skin, const std::vector<Bone>& bones,
                    const std::vector<Eigen::Quaterniond>& rotations, const HingeSizes& sizes);

} // namespace osgSkin::elastic

#endif
