// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/Correctives>
#include <osgSkin/Pose>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bake {

/// How much of each joint's rotation a helper joint takes, in the order of the product
/// (osgSkin::productOrder()). Joints without a share are left out.
using Ratios = std::vector<osgSkin::Influence>;

/// A pose as maps of rest space, for joints and for partial rotations.
class PosedJoints {
public:
    /// \param joints of the pose's binding; must outlive this object
    PosedJoints(const std::vector<osgSkin::BoundJoint>& joints, const osgSkin::Pose& pose);

    /// A joint's own map D_j, as far as the ratios say.
    osgSkin::JointMap own(const osgSkin::Influence& ratio) const;
    /// The product of the maps of all joints in `ratios`.
    osgSkin::JointMap product(const Ratios& ratios) const;

    const osgSkin::JointTransform& operator[](std::size_t joint) const { return _turns[joint]; }

private:
    const std::vector<osgSkin::BoundJoint>& _joints;
    std::vector<osgSkin::JointTransform> _turns;
};

/// a after b.
osgSkin::JointMap operator*(const osgSkin::JointMap& a, const osgSkin::JointMap& b);
glm::dvec3 operator*(const osgSkin::JointMap& map, const glm::dvec3& x);
osgSkin::JointMap inverse(const osgSkin::JointMap& map);

/// A joint that carries a part of other joints' bends and twists.
struct HelperJoint {
    Ratios ratios;
    std::uint32_t joint = 0;  ///< that it mostly helps, index in Binding::joints
    std::uint32_t parent = 0; ///< the nearest joint above that it follows wholly
};

/// The weights of a joint's correctives, or an input's, in a pose.
using ModeWeights = std::array<double, osgSkin::CorrectiveJoint::kMaxModes>;
ModeWeights modeWeights(const osgSkin::Pose& pose, const osgSkin::CorrectiveJoint& joint,
                        const osgSkin::Binding& binding);

/// A skin for linear blending that moves as a binding does.
struct LinearSkin {
    struct Weight {
        std::uint32_t joint = 0; ///< in Binding::joints, and behind these in `helpers`
        float weight = 0.0f;
    };
    std::vector<HelperJoint> helpers;
    std::vector<std::vector<Weight>> vertices; ///< each one's weights, the largest first; sum 1
    /// The largest distance from the binding's own vertices in the poses of the fit, in radii of
    /// the limb at the vertex.
    double worst = 0.0;
};

struct LinearSkinOptions {
    std::size_t weights = 4; ///< per vertex, at most
    std::size_t helpers = 8; ///< at most this number times the number of joints that bend skin
};

/// Fits helper joints and weights, so that linear blending follows the partial rotations of a
/// binding. Helpers are ratios of vertices, chosen one after another where the skin is farthest
/// off; weights are those with the least squares of distances over the poses.
///
/// Vertices are moved by correctives first, which linear blending must have as morph targets.
///
/// \param binding valid
/// \param rest the vertices' positions, rest space
/// \param poses of the binding's joints; without any, no helpers are made
LinearSkin fitLinearSkin(const osgSkin::Binding& binding, const std::vector<glm::dvec3>& rest,
                         const std::vector<osgSkin::Pose>& poses, const LinearSkinOptions& options);

/// The radius of the limb at each joint, rest space: the median distance of the skin that takes
/// between a quarter and three quarters of its bend from the axis of its twist.
std::vector<double> limbRadii(const osgSkin::Binding& binding, const std::vector<glm::dvec3>& rest);

} // namespace bake
