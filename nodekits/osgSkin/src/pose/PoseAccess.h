// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Pose>

#include <cstddef>

namespace osgSkin {

/// What a Pose holds of its joints, as it holds it.
class PoseAccess {
public:
    using Split = Pose::Split;
    using Rest = Pose::Rest;

    /// \param pose has that joint
    /// \param joint its index
    static const Split& split(const Pose& pose, std::size_t joint) { return pose._splits[joint]; }
    /// \param pose has that joint
    /// \param joint its index
    static const Rest& rest(const Pose& pose, std::size_t joint) { return (*pose._rest)[joint]; }

    /// Split::azimuthCosine and azimuthSine are in steps of this.
    static constexpr double kAzimuthStep = Pose::kAzimuthStep;
};

} // namespace osgSkin
