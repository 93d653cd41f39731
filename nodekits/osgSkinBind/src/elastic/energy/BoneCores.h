// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_BONECORES_H
#define OSGSKINBIND_ELASTIC_BONECORES_H

#include "elastic/energy/Bone.h"
#include "elastic/energy/HingeCore.h"
#include "elastic/lattice/VoxelLattice.h"
#include "elastic/skin/RestSkin.h"

#include <Eigen/Geometry>

#include <vector>

namespace osgSkin::elastic {

/// What a core is and how firmly it holds, in units of the flesh's mu and the limb's radius.
struct CoreSizes {
    double thickness = 0.15;   ///< of the way from bone to skin
    double endsBefore = 0.5;   ///< the joint
    double stiffness = 1000.0; ///< mu / r^2 a volume
};

/// Bones as soft cores in the flesh: Gauss points near a bone are drawn to where it takes them.
/// Const after construction.
class BoneCores {
public:
    /// A Gauss point that a bone holds.
    struct Held {
        std::uint32_t cell = 0, point = 0;
        Point rest;
        double stiffness = 0.0; ///< times volume
        double share = 0.0;     ///< of the joint's turn, 0 to 1
    };

    /// \param hinge null for other joints
    BoneCores(const VoxelLattice& lattice, const RestSkin& skin, const std::vector<Bone>& bones,
              const HingeCore* hinge, const CoreSizes& sizes);

    const std::vector<Held>& held() const { return _held; }

    /// Where the bones take what they hold, once the joint has turned by `turn`.
    Points goals(const Eigen::Quaterniond& turn) const;

    /// Energy of the nodes' positions; its gradient is added.
    double value(const Points& nodes, const Points& goals, Points& gradient) const;

private:
    const VoxelLattice& _lattice;
    std::vector<Held> _held;
};

} // namespace osgSkin::elastic

#endif
