// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_FOLDSKIN_H
#define OSGSKINBIND_ELASTIC_FOLDSKIN_H

#include "elastic/lattice/SkinPatch.h"

#include <cstdint>
#include <vector>

namespace osgSkin::elastic {

struct ContactSizes {
    double stiffness = 200.0; ///< mu / r an area
    double gap = 0.12;        ///< that stays between the sides
    double margin = 0.2;      ///< beyond the gap, in which probes are watched
    double spacing = 0.12;    ///< of the probes on the skin
    double sides = 0.15;      ///< ratios differ by this between a fold's two sides
    double apart = 0.15;      ///< pairs this near at rest are one fold's edge, no contact
    double ramp = 0.7;        ///< beyond that, over which the gap grows to its whole
    int fresh = 6;            ///< so many detections forget the ones before
    double leastShare = 0.1;  ///< that a later one has in the touches
};

/// The skin around a joint as FoldContact needs it, at rest. Const after construction.
class FoldSkin {
public:
    /// \param nodeRatios the joint's bend ratio at the lattice's nodes
    FoldSkin(const VoxelLattice& lattice, const RestSkin& skin, const SkinPatch& patch,
             const Eigen::VectorXd& nodeRatios, const ContactSizes& sizes);

    /// A point of the skin that is watched.
    struct Probe {
        std::uint32_t triangle = 0; ///< of the patch
        Point shares;               ///< of its corners
        Point rest;
        double area = 0.0;
        double ratio = 0.0;
    };

    const VoxelLattice& lattice() const { return _lattice; }
    const RestSkin& skin() const { return _skin; }
    const SkinPatch& patch() const { return _patch; }
    const ContactSizes& sizes() const { return _sizes; }
    const std::vector<Probe>& probes() const { return _probes; }
    const Points& restVertices() const { return _rest; } ///< of the patch

    /// The bend ratios of some flesh.
    struct RatioSpan {
        double low = 1.0, high = 0.0;
        void extend(const RatioSpan& other);
    };
    const RatioSpan& ratiosOf(std::uint32_t cell) const { return _ratiosOf[cell]; }

    /// False where flesh belongs to the probe's own side of the fold.
    bool mayTouch(const Probe& probe, const RatioSpan& flesh) const;

    /// The same of a cell's flesh, or where that lies beside the probe at rest.
    bool mayTouch(const Probe& probe, std::uint32_t cell) const;

    /// The bend ratio at a cell's local point.
    double ratioIn(std::uint32_t cell, const Point& local) const;

    /// The bend ratio on a triangle of the patch.
    double ratioOn(std::uint32_t triangle, const Point& shares) const;

    /// RestSkin::inside() of a point whose nearest point on the skin is known.
    /// \param there that point
    bool isInside(const Point& rest, const RestSkin::Nearest& nearest, const Point& there) const;

private:
    void placeProbes();
    void findSides();

    const VoxelLattice& _lattice;
    const RestSkin& _skin;
    const SkinPatch& _patch;
    ContactSizes _sizes;
    Eigen::VectorXd _nodeRatios;
    std::vector<RatioSpan> _ratiosOf; ///< of each cell
    Points _rest;                     ///< the patch's vertices
    std::vector<Probe> _probes;
    std::vector<Point> _outwards; ///< of each triangle of the patch; 0 where both sides are alike
};

} // namespace osgSkin::elastic

#endif
