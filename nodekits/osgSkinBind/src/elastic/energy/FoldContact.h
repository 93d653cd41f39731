// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_FOLDCONTACT_H
#define OSGSKINBIND_ELASTIC_FOLDCONTACT_H

#include "elastic/lattice/DeformedCells.h"
#include "elastic/lattice/RatioField.h"
#include "elastic/lattice/SkinPatch.h"

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

/// Contact between the two sides of a joint's fold, found in material space (McAdams et al. 2011):
/// a probe on one side's skin, or a little ahead of it, that has come to lie in the other side's
/// flesh is looked up at rest, and what is nearest on the skin there is what it has to keep off.
/// Sides are told by how differently they follow the joint, not by the nearest bone: that would put
/// spikes on the limb's flank. What is nearest jumps as flesh slides, and a minimiser that is told
/// anew each time would never come to rest: after a few detections the touches become the mean of
/// all since. One object for each thread.
class FoldContact {
public:
    FoldContact(const VoxelLattice& lattice, const RestSkin& skin, const SkinPatch& patch,
                const Eigen::VectorXd& nodeRatios, const ContactSizes& sizes);

    /// Forgets all touches and detections: for another bend.
    void restart();

    /// Finds anew which probes touch.
    void detect(const Points& nodes);

    /// Energy of the touches that detect() has found; its gradient is added.
    double value(const Points& nodes, Points& gradient) const;

    std::size_t touches() const { return _touches.size(); }

private:
    struct Probe {
        std::uint32_t triangle = 0; ///< of the patch
        Point shares;               ///< of its corners
        Point rest;
        double area = 0.0;
        double ratio = 0.0;
    };
    /// Of a cell's nodes.
    struct RatioSpan {
        double low = 1.0, high = 0.0;
    };
    struct Touch {
        std::uint32_t probe = 0, triangle = 0; ///< triangle: of the other side
        Point shares, normal;                  ///< where it is touched, and outwards from there
        double gap = 0.0;
        double weight = 1.0; ///< falls with each detection since
    };

    bool look(std::uint32_t probe, const Point& at, const DeformedCells& cells,
              const Points& normals, Touch& result) const;
    /// False where look() would find nothing in the cell.
    bool mayTouch(const Probe& probe, std::uint32_t cell) const;
    bool touch(std::uint32_t probe, const Point& rest, const Points& normals, Touch& result) const;
    double ratioAt(std::uint32_t triangle, const Point& shares) const;
    Point on(std::uint32_t triangle, const Point& shares, const Points& vertices) const;

    const VoxelLattice& _lattice;
    const RestSkin& _skin;
    const SkinPatch& _patch;
    ContactSizes _sizes;
    Eigen::VectorXd _nodeRatios;
    std::vector<RatioSpan> _ratiosOf; ///< of each cell
    std::vector<Probe> _probes;
    std::vector<Touch> _touches;
    int _detections = 0;
};

} // namespace osgSkin::elastic

#endif
