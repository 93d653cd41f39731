// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_TWISTPROFILE_H
#define OSGSKINBIND_TWISTPROFILE_H

#include "joints/JointPlan.h"
#include "limbs/BoundarySpan.h"
#include "mesh/WeldedMesh.h"

#include <array>
#include <vector>

namespace osgSkin {

/// How a hand's twist builds up along the forearm.
///
/// A twist shears the skin by its rate times the limb's radius. Eq. 5 is fastest in the middle; an
/// edge that spans a fast stretch of a large twist cuts across the limb. Here the rate goes with
/// the inverse of the limb's radius, so that the shear is the same everywhere, and fades in and out
/// at the boundaries.
class TwistProfile {
public:
    /// \param mesh the skin
    /// \param joint the hand
    /// \param region along its pole bone
    /// \param onBone bend field of the joint that moves the pole bone
    /// \param beyond bend field of the joint at the bone's end: its skin does not count for
    ///        the radius
    TwistProfile(const WeldedMesh& mesh, const PlannedJoint& joint, const BoundarySpan& region,
                 const std::vector<double>& onBone, const std::vector<double>& beyond);

    /// Ratio, 0 to 1, at t: 0 at the upper boundary, 1 at the lower; flat beyond both.
    double operator()(double t) const;

private:
    static constexpr std::size_t kSteps = 64;
    std::array<double, kSteps + 1> _ratio{};
};

} // namespace osgSkin

#endif
