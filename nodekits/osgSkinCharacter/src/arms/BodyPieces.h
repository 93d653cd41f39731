// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_ARMS_BODYPIECES_H
#define OSGSKINCHARACTER_ARMS_BODYPIECES_H

#include <osgSkin/Binding>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/Clip>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// The part of the body of a joint or a vertex, as far as arms meet it.
enum class BodyPiece : signed char { Trunk, Head, LeftThigh, RightThigh, LeftArm, RightArm, Other };

/// The joints in a pose, skeleton space.
struct PosedJoints {
    std::vector<glm::dvec3> rest;      ///< their centres at rest
    std::vector<glm::dquat> rotations; ///< relative to rest
    std::vector<glm::dvec3> centres;

    /// The rest pose.
    explicit PosedJoints(const RestSkeleton& skeleton);

    /// A sample of a clip of that skeleton, with the root joint where it is at rest.
    void set(const RestSkeleton& skeleton, const Clip& clip, std::size_t frame);

    /// The posed position of a rest point that moves with `joint`.
    glm::dvec3 place(const glm::dvec3& point, std::size_t joint) const {
        return centres[joint] + rotations[joint] * (point - rest[joint]);
    }
};

/// An arm: its joints, and points of its skin at rest.
struct ArmPiece {
    struct Point {
        glm::dvec3 place{0.0};
        std::size_t joint = 0; ///< that it moves with
        double along = 2.0;    ///< 0 at the shoulder to 1 at the elbow; 2 from there on
    };
    std::size_t upper = 0, lower = 0; ///< joints
    double length = 0.0;              ///< from the upper arm's joint to the wrist
    std::vector<Point> points;        ///< spread over the skin; none where the arm is not known
    Point palm;                       ///< the middle of the hand's skin
};

/// A body in pieces, by its joints' roles and its vertices' regions. Helper joints belong to their
/// parents' pieces; chains of them (hair, tails, capes) are no part of the body.
struct BodyPieces {
    std::vector<BodyPiece> ofJoint;
    std::vector<ArmPiece> arms; ///< left and right; none where both are unknown

    /// \param rest valid
    /// \param roles of its joints
    /// \param mesh in rest space
    /// \param binding of `mesh` to `rest`
    BodyPieces(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
               const Binding& binding);

    /// The length of an arm.
    double armLength() const { return std::max(arms[0].length, arms[1].length); }
};

} // namespace osgSkin

#endif
