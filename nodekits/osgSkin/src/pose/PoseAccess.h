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

    /// The rows, stride() from one to the next; null where there are no joints.
    static const double* rows(const Pose& pose) { return pose._rows.data(); }
    static const double* restRows(const Pose& pose) {
        return pose._rest ? pose._rest->rows.data() : nullptr;
    }
    /// -1 of the root.
    static const int* parents(const Pose& pose) {
        return pose._rest ? pose._rest->parents.data() : nullptr;
    }
    /// A row of cosines, one of sines.
    static const std::int32_t* azimuths(const Pose& pose) { return pose._azimuths.data(); }
    /// A multiple of kAtOnce.
    static std::size_t stride(const Pose& pose) { return pose._stride; }

    static constexpr std::size_t kAtOnce = Pose::kAtOnce;
    static constexpr std::size_t kRows = Pose::kRows;
    static constexpr std::size_t kRestRows = Pose::kRestRows;

    /// Split::azimuthCosine and azimuthSine are in steps of this.
    static constexpr double kAzimuthStep = Pose::kAzimuthStep;
};

} // namespace osgSkin
