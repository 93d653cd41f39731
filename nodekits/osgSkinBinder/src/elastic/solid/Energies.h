// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_SOLID_ENERGIES_H
#define OSGSKINBINDER_ELASTIC_SOLID_ENERGIES_H

#include "elastic/solid/CellEnergy.h"
#include "elastic/solid/RestSkin.h"
#include "elastic/solid/SkinPatch.h"
#include "elastic/solid/VoxelLattice.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace osgSkin::elastic {

/// A bone as a segment, joint space.
struct Bone {
    Point from, to;
    bool moves = false; ///< with the joint, not with its parent
};

/// Bones that begin this near to the joint belong to it, radii.
constexpr double kAtCentre = 1e-3;

inline Point nearestOn(const Bone& bone, const Point& p) {
    const Point along = bone.to - bone.from;
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? std::clamp((p - bone.from).dot(along) / square, 0.0, 1.0) : 0.0;
    return bone.from + t * along;
}

/// The ball in a hinge: the condyles and the knee cap, or the elbow's tip. It lies close to the
/// skin of the outer side, which would cave in without it. Its points rotate with a share that
/// grows from one bone to the other.
struct HingeCore {
    Point centre = Point::Zero();
    double radius = 0.0;
    Point along = Point::Zero();    ///< the limb's direction, unit; zero if not known
    double halfWidth = 0.0;         ///< along the limb, of the part between both bones' rotations
    Point outwards = Point::Zero(); ///< to the fold's outer side, unit; zero if not known

    bool contains(const Point& point) const { return (point - centre).norm() < radius; }

    /// The share of the joint's rotation at a point of the ball.
    double shareAt(const Point& point) const {
        return std::clamp(0.5 + 0.5 * point.dot(along) / halfWidth, 0.0, 1.0);
    }
};

struct HingeSizes {
    double radius = 0.5; ///< of the ball
    double below = 0.1;  ///< depth of the ball below the skin of the outer side
    /// See HingeCore. If less, the outer side caves in; if more, it swells beside the ball.
    double halfWidth = 2.5;
};

/// \param rotations of the joint, unit; their common axis defines the outer side
/// \return a ball at the joint's centre if they define none
HingeCore hingeCore(const Points& skin, const std::vector<Bone>& bones,
                    const std::vector<Eigen::Quaterniond>& rotations, const HingeSizes& sizes);

/// Sizes and stiffness of bone cores, in units of the flesh's mu and the limb's radius.
struct CoreSizes {
    double thickness = 0.15;   ///< share of the distance from bone to skin
    double endsBefore = 0.5;   ///< distance of their ends from the joint
    double stiffness = 1000.0; ///< mu / r^2 per volume
};

/// Bones as soft cores in the flesh: springs pull Gauss points near a bone to where the bone moves
/// them. Const after construction.
class BoneCores {
public:
    /// A Gauss point in a core.
    struct Held {
        std::uint32_t cell = 0, point = 0;
        Point rest;
        double stiffness = 0.0; ///< times volume
        double share = 0.0;     ///< of the joint's rotation, 0 to 1
    };

    /// \param hinge null for other joints
    BoneCores(const VoxelLattice& lattice, const RestSkin& skin, const std::vector<Bone>& bones,
              const HingeCore* hinge, const CoreSizes& sizes);

    const std::vector<Held>& held() const { return _held; }

    /// Where the bones move the held points when the joint is rotated by `turn`.
    Points goals(const Eigen::Quaterniond& turn) const;

    /// Energy of the nodes' positions; its gradient is added.
    double value(const Points& nodes, const Points& goals, Points& gradient) const;

private:
    const VoxelLattice& _lattice;
    std::vector<Held> _held;
};

/// The flesh of a whole lattice. Const after construction.
class ElasticBody {
public:
    ElasticBody(const VoxelLattice& lattice, const Flesh& flesh)
        : _lattice(lattice), _flesh(flesh) {}

    /// Energy of the nodes' positions, infinite if a cell is inverted; its gradient is added.
    double value(const Points& nodes, Points& gradient) const;

    /// Volumes, posed over rest.
    struct Volumes {
        double least = 0.0; ///< the smallest J of a Gauss point; inverted if not above 0
        double whole = 0.0;
    };
    Volumes volumes(const Points& nodes) const;

private:
    const VoxelLattice& _lattice;
    Flesh _flesh;
};

/// Ties the flesh loosely to the bones: weak springs pull it to where the plain skin's rotation
/// moves it. Without them one side of a deep fold could slide along the other at no cost, and the
/// shape would depend on the steps that led to it. Const after construction.
class Fascia {
public:
    /// \param stiffness mu / r^2 per volume
    Fascia(const VoxelLattice& lattice, double stiffness);

    /// Energy of the nodes' positions; its gradient is added.
    /// \param goals of all nodes
    double value(const Points& nodes, const Points& goals, Points& gradient) const;

private:
    Eigen::VectorXd _stiffness; ///< of each node, times its volume
};

/// Limits and stiffness of the outer side, in units of the flesh's mu and the limb's radius.
struct OuterSizes {
    double stiffness = 200.0;         ///< mu / r per area
    double least = 0.97, most = 1.02; ///< free range of the distance, relative to that at rest
    double from = 0.4, whole = 0.7;   ///< cosines of the angle from the outermost line
    double reach = 1.0, end = 1.7;    ///< distance along the limb: wholly held; no longer held
};

/// Ties the skin of a hinge's outer side to the bones below, as tendons over knee cap and elbow do
/// at any bend. Otherwise flesh that keeps its volume would swell there, or cave in where the fold
/// pulls it inwards. Const after construction.
class OuterSkin {
public:
    /// \param skin at rest, joint space
    /// \param hinge null for other joints: their skin is free
    OuterSkin(const SkinPatch& patch, const Points& skin, const std::vector<Bone>& bones,
              const HingeCore* hinge, const OuterSizes& sizes);

    /// The bones when the joint is rotated.
    std::vector<Bone> posed(const Eigen::Quaterniond& turn) const;

    /// Energy of the patch's positions; its gradient is added.
    double value(const Points& skin, const std::vector<Bone>& posed, Points& gradient) const;

private:
    struct Held {
        std::size_t vertex = 0; ///< of the patch
        double distance = 0.0;  ///< from the bones, at rest
        double stiffness = 0.0; ///< times area
    };

    OuterSizes _sizes;
    std::vector<Bone> _bones;
    std::vector<Held> _held;
};

} // namespace osgSkin::elastic

#endif
