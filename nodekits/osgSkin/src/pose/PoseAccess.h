// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Pose>

#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// What a Pose holds of its joints, as it holds it.
class PoseAccess {
public:
    using Split = Pose::Split;
    using Rest = Pose::Rest;
    using Row = Pose::Row;
    using RestRow = Pose::RestRow;

    /// \param pose has that joint
    /// \param joint its index
    static Split split(const Pose& pose, std::size_t joint) { return pose.splitOf(joint); }
    /// \param pose has that joint
    /// \param joint its index
    static Rest rest(const Pose& pose, std::size_t joint) { return pose.restOf(joint); }

    /// The rows, as many numbers each as there are joints; null where there are none.
    static const double* rows(const Pose& pose) { return pose._rows.data(); }
    static const double* restRows(const Pose& pose) {
        return pose._rest ? pose._rest->rows.data() : nullptr;
    }
    /// -1 of the root.
    static const int* parents(const Pose& pose) {
        return pose._rest ? pose._rest->parents.data() : nullptr;
    }
    /// A row of cosines, one of sines; read only as vectors are.
    static const std::int32_t* azimuths(const double* rows, std::size_t joints) {
        return reinterpret_cast<const std::int32_t*>(rows + Pose::kAzimuth * joints);
    }

    static constexpr std::size_t kAtOnce = Pose::kAtOnce;
    static constexpr std::size_t kRows = Pose::kRows;
    static constexpr std::size_t kNumberRows = Pose::kAzimuth; ///< less the one of azimuths
    static constexpr std::size_t kRestRows = Pose::kRestRows;

    /// Split::azimuthCosine and azimuthSine are in steps of this.
    static constexpr double kAzimuthStep = Pose::kAzimuthStep;
};

} // namespace osgSkin
