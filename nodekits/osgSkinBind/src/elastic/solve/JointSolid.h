// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_JOINTSOLID_H
#define OSGSKINBIND_ELASTIC_JOINTSOLID_H

#include "elastic/energy/BoneCores.h"
#include "elastic/energy/ElasticBody.h"
#include "elastic/energy/Fascia.h"
#include "elastic/energy/FoldContact.h"
#include "elastic/energy/OuterSkin.h"
#include "elastic/lattice/RatioField.h"
#include "elastic/lattice/SkinPatch.h"
#include "elastic/solve/Minimise.h"
#include "elastic/solve/Preconditioner.h"

#include <functional>
#include <vector>

namespace osgSkin::elastic {

/// What the solid is made of; everything in units of the limb's radius and the flesh's mu.
struct SolidOptions {
    double edge = 1.0 / 3.0;                 ///< of the cells
    double reach = 4.0;                      ///< of the lattice
    double largestTurn = 0.2617993877991494; ///< radians in one step: 15 degrees
    Flesh flesh;
    double fascia = 1.0; ///< mu / r^2 a volume: of less, deep folds slide; more, they stay plain
    CoreSizes cores;
    HingeSizes hinge;
    ContactSizes contact;
    OuterSizes outer;
    MinimiseLimits limits;
};

/// The body around a joint as an elastic solid, ready to be bent. Const after construction: any
/// number of threads may bend it at once.
class JointSolid {
public:
    /// \param skin in joint space
    /// \param ratios the joint's bend ratio at each of its vertices
    /// \param hinge null for other joints
    /// \throw Unsolvable with a reason
    JointSolid(Points skin, RestSkin::Triangles triangles, const std::vector<double>& ratios,
               const std::vector<Bone>& bones, const HingeCore* hinge, const SolidOptions& options);

    /// Shape at one rotation of the joint.
    struct State {
        Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
        Points nodes;
        bool tangled = false; ///< no way on from here without inverting a cell
        bool stopped = false; ///< the caller of bend() wanted no more
        bool converged = true;
        int steps = 0; ///< of the minimiser, on the way here
    };

    State rest() const;

    /// Bends on to another rotation, in small steps.
    /// \param goOn called after each step; stops the bend where it returns false; may throw
    State bend(const State& from, const Eigen::Quaterniond& to,
               const std::function<bool(const State&)>& goOn) const;

    const VoxelLattice& lattice() const { return _lattice; }
    const SkinPatch& patch() const { return _patch; }
    const ElasticBody& body() const { return _body; }

private:
    Points guess(const State& from, const Eigen::Quaterniond& to) const;
    bool defined(const Points& nodes) const;

    SolidOptions _options;
    RestSkin _skin;
    VoxelLattice _lattice;
    SkinPatch _patch;
    Eigen::VectorXd _ratios; ///< of the nodes
    ElasticBody _body;
    BoneCores _cores;
    Fascia _fascia;
    OuterSkin _outer;
    FoldSkin _fold;
    Preconditioner _preconditioner;
};

} // namespace osgSkin::elastic

#endif
