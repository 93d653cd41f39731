// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_OUTERSKIN_H
#define OSGSKINBIND_ELASTIC_OUTERSKIN_H

#include "elastic/energy/HingeCore.h"
#include "elastic/lattice/SkinPatch.h"

#include <Eigen/Geometry>

#include <vector>

namespace osgSkin::elastic {

/// How firmly the outer side is held, in units of the flesh's mu and the limb's radius.
struct OuterSizes {
    double stiffness = 200.0;         ///< mu / r an area
    double least = 0.97, most = 1.02; ///< times the distance at rest, between which it is free
    double from = 0.4, whole = 0.7;   ///< cosine of the angle from the outermost line
    double reach = 1.0, end = 1.7;    ///< along the limb: held wholly, and no more
};

/// What ties the skin of a hinge's outer side to the bones below: tendons over knee cap and elbow,
/// which lie on the bone however far the joint bends. Flesh that keeps its volume would swell
/// there, and where the fold draws it inwards it would cave in. Const after construction.
class OuterSkin {
public:
    /// \param skin at rest, joint space
    /// \param hinge null for other joints, whose skin is free
    OuterSkin(const SkinPatch& patch, const Points& skin, const std::vector<Bone>& bones,
              const HingeCore* hinge, const OuterSizes& sizes);

    /// The bones once the joint has turned.
    std::vector<Bone> posed(const Eigen::Quaterniond& turn) const;

    /// Energy of the nodes' positions; its gradient is added.
    double value(const Points& nodes, const std::vector<Bone>& posed, Points& gradient) const;

private:
    struct Held {
        std::size_t vertex = 0; ///< of the patch
        double distance = 0.0;  ///< from the bones, at rest
        double stiffness = 0.0; ///< times area
    };

    const SkinPatch& _patch;
    OuterSizes _sizes;
    std::vector<Bone> _bones;
    std::vector<Held> _held;
};

} // namespace osgSkin::elastic

#endif
