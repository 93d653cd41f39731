// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgSkin {

/// Patches of skin that stand for their vertices when a pose's bounds are computed.
///
/// A patch is a flat cylinder about its centre and normal, in rest space, with the mean ratios of
/// its vertices: with those it moves rigidly. A vertex whose ratio of some joint differs by d from
/// the mean turns by up to d times that joint's angle more, at no more than its reach from the
/// joint's centre.
struct BoundsProxy {
    /// Patches side by side whose vertices follow the same joints.
    struct Run {
        std::uint32_t firstPatch;
        std::uint32_t patchCount;
        std::uint32_t firstJoint; ///< in `joints`
        std::uint32_t jointCount; ///< those followed in part
        std::size_t firstSlack;   ///< in `slack`: for each joint, patchCount floats of each kind
        std::uint32_t firstCorrection; ///< in `corrections`
        std::uint32_t correctionCount;
    };

    /// That vertices of a run follow the correctives of a joint.
    struct Correction {
        std::uint32_t joint;    ///< of the correctives'
        std::size_t firstReach; ///< in `reach`: patchCount floats for each mode
    };

    /// What one partial joint adds to a patch's size: the largest deviations from the mean ratios.
    enum Slack {
        BendReach,  ///< times the reach: per radian of bend
        TwistReach, ///< times the reach: per radian of twist
        BendSpread, ///< per unit of translation, and per radian and unit of reach that it adds
        TwistSpread,
        SlackKinds
    };

    /// Patches that a skin is cut into, unless it has more groups than that.
    static constexpr std::size_t kMost = 1536;

    osg::ref_ptr<const SkinModel> centres; ///< centre and normal of each patch, its mean ratios
    std::vector<float> across;             ///< of each patch: the cylinder's radius
    std::vector<float> along;              ///< half its height
    std::vector<Run> runs;
    std::vector<std::uint32_t> joints;
    std::vector<float> slack;
    std::vector<Correction> corrections;
    std::vector<float> reach; ///< length of a patch's largest shares, as they are held
    float rounding;           ///< what single precision may put a vertex off by, near the origin
};

/// Cuts a model's groups into patches; null for a model without vertices.
std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model);

} // namespace osgSkin
