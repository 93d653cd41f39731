// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_HINGECORE_H
#define OSGSKINBIND_ELASTIC_HINGECORE_H

#include "elastic/energy/Bone.h"

#include <Eigen/Geometry>

#include <vector>

namespace osgSkin::elastic {

/// The ball within a hinge: condyles with the knee cap, or the elbow's point. It turns by half the
/// angle, and lies close to the skin of the outer side, which would cave in without it.
struct HingeCore {
    Point centre = Point::Zero();
    double radius = 0.0;
};

struct HingeSizes {
    double radius = 0.5; ///< of the ball
    double below = 0.15; ///< the skin of the outer side
};

/// \param rotations of the joint, unit: what they have in common says which side is the outer one
/// \return a ball at the joint's centre where nothing says that
HingeCore hingeCore(const Points& skin, const std::vector<Bone>& bones,
                    const std::vector<Eigen::Quaterniond>& rotations, const HingeSizes& sizes);

} // namespace osgSkin::elastic

#endif
