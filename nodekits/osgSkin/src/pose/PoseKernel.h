// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/BendTwist>
#include <osgSkin/GlmTypes>
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

/// A pose that is being set, several joints at a time.
struct PoseCall {
    static constexpr std::size_t kAtOnce = 8; ///< joints, at most

    std::size_t count; ///< joints, and numbers in a row; at least kAtOnce
    const int* parents;
    const double* rest; ///< by PoseAccess::RestRow
    double* rows;       ///< by PoseAccess::Row
    bool continued;     ///< see Pose::Twist
};

/// Of what a skinning matrix makes of a cube.
constexpr double kSmallestVolume = 1e-27;

/// Rows of numbers that PoseFrames take for each joint.
constexpr std::size_t kFrameRows = 13;

/// What the skinning matrices of a pose are: x -> offset + scale * rotation * x, in rows behind one
/// another: the rotation's columns, offset, scale. As matrices: which part of a quaternion is to be
/// found first differs from joint to joint, but for a joint's own rotation it is nearly always the
/// same one.
struct PoseFrames {
    double* rows; ///< of joint 0
    std::size_t stride;

    /// Numbers before joint 0 of each row; the last of them is what has no parent's parent.
    static constexpr std::size_t kBefore = PoseCall::kAtOnce;
};

/// Takes skinning matrices G_j apart.
///
/// \param skinning one for each joint
/// \param call its rows are left as they are
/// \param frames set; room for as many joints in each row, and kBefore before them
/// \return false where one of them cannot be followed, see Pose::set()
bool readFrames(const glm::dmat4* skinning, const PoseCall& call,
                const PoseFrames& frames) noexcept;

/// Sets a pose from those: D_j = G_parent^-1 G_j, split into bend and twist (eq. 1 to 4).
///
/// \return whether it is another pose than before
bool splitFrames(const PoseCall& call, const PoseFrames& frames) noexcept;

/// The same from D_j.
///
/// \param own one for each joint
bool splitMaps(const PoseCall& call, const JointMap* own) noexcept;

/// trySplitBendTwist() for what is known to be right: a finite unit quaternion q and a finite unit
/// vector w, both to the last digits.
BendTwist splitUnit(const glm::dquat& q, const glm::dvec3& w) noexcept;

} // namespace osgSkin
