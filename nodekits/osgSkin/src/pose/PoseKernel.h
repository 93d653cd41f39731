// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/BendTwist>
#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>

#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// The internal data of a Pose.
class PoseAccess {
public:
    using Split = Pose::Split;
    using Rest = Pose::Rest;
    using Row = Pose::Row;
    using RestRow = Pose::RestRow;

    static Split split(const Pose& pose, std::size_t joint) { return pose.splitOf(joint); }
    static Rest rest(const Pose& pose, std::size_t joint) { return pose.restOf(joint); }

    /// By Row, one number per joint in each; null without joints.
    static const double* rows(const Pose& pose) { return pose._rows.data(); }
    static const double* restRows(const Pose& pose) {
        return pose._rest ? pose._rest->rows.data() : nullptr;
    }
    /// -1 for the root.
    static const int* parents(const Pose& pose) {
        return pose._rest ? pose._rest->parents.data() : nullptr;
    }
    /// A row of cosines and one of sines; to be read by vector loads only.
    static const std::int32_t* azimuths(const double* rows, std::size_t joints) {
        return reinterpret_cast<const std::int32_t*>(rows + Pose::kAzimuth * joints);
    }

    static constexpr std::size_t kAtOnce = Pose::kAtOnce;
    static constexpr std::size_t kRows = Pose::kRows;
    static constexpr std::size_t kNumberRows = Pose::kAzimuth; ///< without the azimuths
    static constexpr std::size_t kRestRows = Pose::kRestRows;

    /// The unit of Split::azimuthCosine and azimuthSine.
    static constexpr double kAzimuthStep = Pose::kAzimuthStep;
};

/// The arguments for setting a pose, several joints at a time.
struct PoseCall {
    static constexpr std::size_t kAtOnce = 8; ///< joints, at most

    std::size_t count; ///< of joints, and of numbers in a row; at least kAtOnce
    const int* parents;
    const double* rest; ///< by PoseAccess::RestRow
    double* rows;       ///< by PoseAccess::Row
    bool continued;     ///< see Pose::Twist
};

/// The least determinant of a skinning matrix; the largest is its inverse.
constexpr double kSmallestVolume = 1e-27;

/// Rows of PoseFrames.
constexpr std::size_t kFrameRows = 13;

/// A pose's skinning matrices as maps x -> offset + scale * rotation * x, in rows: the rotation's
/// columns, offset, scale. Matrices rather than quaternions: which component of a quaternion is the
/// largest differs from joint to joint, but is nearly always w for a joint's own rotation.
struct PoseFrames {
    double* rows; ///< of joint 0
    std::size_t stride;

    /// Numbers before joint 0 of each row; the last is the identity, the root's parent.
    static constexpr std::size_t kBefore = PoseCall::kAtOnce;
};

/// Decomposes skinning matrices G_j.
///
/// \param skinning one for each joint
/// \param call its rows are not changed
/// \param frames set; each row has kBefore numbers before its joints
/// \return false where one cannot be used, see Pose::set()
bool readFrames(const glm::dmat4* skinning, const PoseCall& call,
                const PoseFrames& frames) noexcept;

/// Sets a pose from these: D_j = G_parent^-1 G_j, split into bend and twist (eq. 1 to 4).
///
/// \return whether the pose has changed
bool splitFrames(const PoseCall& call, const PoseFrames& frames) noexcept;

/// The same from D_j, one for each joint.
bool splitMaps(const PoseCall& call, const JointMap* own) noexcept;

/// splitBendTwist() without checks: q and w must be finite and of unit length to the last digits.
BendTwist splitUnit(const glm::dquat& q, const glm::dvec3& w) noexcept;

} // namespace osgSkin
