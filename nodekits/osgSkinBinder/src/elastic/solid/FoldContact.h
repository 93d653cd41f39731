// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_SOLID_FOLDCONTACT_H
#define OSGSKINBINDER_ELASTIC_SOLID_FOLDCONTACT_H

#include "elastic/solid/SkinPatch.h"
#include "elastic/solid/VoxelLattice.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin::elastic {

/// Finds the rest positions of a point of the deformed lattice. Cells are sorted into a regular
/// grid of bins.
class DeformedCells {
public:
    DeformedCells(const VoxelLattice& lattice, const Points& nodes);

    static constexpr std::size_t kNoBin = static_cast<std::size_t>(-1);

    std::size_t bins() const { return _first.size() - 1; }

    /// The bin of a point; kNoBin if no cell is near.
    std::size_t binOf(const Point& point) const {
        return _bounds.contains(point) ? index(binAt(point)) : kNoBin;
    }

    /// True if test(bin) is true for a bin that a box overlaps.
    template <typename Test>
    bool anyBin(const Eigen::AlignedBox3d& box, const Test& test) const;

    /// Calls visit(cell) for each cell that reaches into a bin.
    template <typename Visit>
    void forEachIn(std::size_t bin, const Visit& visit) const {
        for (std::uint32_t i = _first[bin]; i < _first[bin + 1]; ++i) visit(_entries[i].cell);
    }

    /// Calls found(cell, local) for each cell that contains the point, until it returns true.
    ///
    /// \param bin the point's
    /// \param matters tells which cells to test; testing takes most of the time
    template <typename Matters, typename Found>
    void find(std::size_t bin, const Point& point, const Matters& matters,
              const Found& found) const;

private:
    Eigen::Vector3i binAt(const Point& point) const;
    std::size_t index(const Eigen::Vector3i& bin) const;
    bool locate(std::uint32_t cell, const Point& point, Point& local) const;

    /// Coefficients of a cell's trilinear map: the lowest corner, and those of x, y, z, xy, yz, zx,
    /// xyz.
    struct Map {
        Point at, x, y, z, xy, yz, zx, xyz;
    };

    /// A cell in a bin, with the box around it.
    struct Entry {
        std::array<float, 3> low, high;
        std::uint32_t cell;

        bool contains(const Eigen::Vector3f& p) const {
            return p.x() >= low[0] && p.x() <= high[0] && p.y() >= low[1] && p.y() <= high[1] &&
                   p.z() >= low[2] && p.z() <= high[2];
        }
    };

    Eigen::AlignedBox3d _bounds;
    Eigen::Vector3i _bins;
    double _binSize;
    std::vector<Map> _maps;            ///< of the cells
    std::vector<std::uint32_t> _first; ///< of each bin; size: bins + 1
    std::vector<Entry> _entries;
};

template <typename Test>
bool DeformedCells::anyBin(const Eigen::AlignedBox3d& box, const Test& test) const {
    if (!box.intersects(_bounds)) return false;
    const Eigen::Vector3i low = binAt(box.min()), high = binAt(box.max());
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x)
                if (test(index({x, y, z}))) return true;
    return false;
}

template <typename Matters, typename Found>
void DeformedCells::find(std::size_t bin, const Point& point, const Matters& matters,
                         const Found& found) const {
    const Eigen::Vector3f rounded = point.cast<float>();
    for (std::uint32_t i = _first[bin]; i < _first[bin + 1]; ++i) {
        const Entry& entry = _entries[i];
        Point local;
        if (entry.contains(rounded) && matters(entry.cell) && locate(entry.cell, point, local) &&
            found(entry.cell, local))
            return;
    }
}

struct ContactSizes {
    double stiffness = 200.0; ///< mu / r per area
    double gap = 0.12;        ///< between the sides
    double margin = 0.2;      ///< beyond the gap, in which probes are tested
    double spacing = 0.2;     ///< of the probes on the skin
    double sides = 0.15;      ///< least difference of ratios between a fold's two sides
    double apart = 0.15; ///< least distance of pairs at rest: nearer ones are at the fold's edge
    double ramp = 0.7;   ///< further distance over which the gap grows to its full size
};

/// The skin around a joint at rest, for FoldContact. Const after construction.
class FoldSkin {
public:
    /// \param nodeRatios the joint's bend ratio at the lattice's nodes
    FoldSkin(const VoxelLattice& lattice, const RestSkin& skin, const SkinPatch& patch,
             const Eigen::VectorXd& nodeRatios, const ContactSizes& sizes);

    /// A point of the skin that is tested for contact.
    struct Probe {
        Point shares; ///< barycentric coordinates
        Point rest;
        double area = 0.0;
        double ratio = 0.0;
    };

    const VoxelLattice& lattice() const { return _lattice; }
    const RestSkin& skin() const { return _skin; }
    const SkinPatch& patch() const { return _patch; }
    const ContactSizes& sizes() const { return _sizes; }
    /// For each triangle of the patch.
    const std::vector<std::vector<Probe>>& probes() const { return _probes; }
    const Points& restVertices() const { return _rest; } ///< of the patch

    /// The range of bend ratios of some flesh.
    struct RatioSpan {
        double low = 1.0, high = 0.0;
        void extend(const RatioSpan& other);
    };
    const RatioSpan& ratiosOf(std::uint32_t cell) const { return _ratiosOf[cell]; }

    /// False if flesh belongs to the skin's own side of the fold.
    bool mayTouch(const RatioSpan& skin, const RatioSpan& flesh) const;

    /// The same for a cell's flesh; also false if it is near the probe at rest.
    bool mayTouch(const Probe& probe, std::uint32_t cell) const;

    /// The bend ratio at a position in a cell.
    double ratioIn(std::uint32_t cell, const Point& local) const;

    /// The bend ratio on a triangle of the patch.
    double ratioOn(std::uint32_t triangle, const Point& shares) const;

    /// RestSkin::inside() for a point whose nearest point on the skin is known.
    /// \param there the nearest point
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
    std::vector<std::vector<Probe>> _probes;
    std::vector<Point> _outwards; ///< normals of the patch's triangles; 0 if both sides are alike
};

/// Contact between the two sides of a joint's fold, found in material space (McAdams et al. 2011).
///
/// A probe on one side's skin, or a little ahead of it, may be inside the other side's flesh. Then
/// its rest position in that flesh is found, and the probe must keep a gap from the skin's point
/// nearest to it. Sides are distinguished by their bend ratios, not by the nearest bone, which
/// would cause spikes on the limb's flank. Not thread-safe: use one object for each thread.
class FoldContact {
public:
    /// \param skin must outlive this object
    explicit FoldContact(const FoldSkin& skin) : _skin(skin) {}

    /// Finds the probes that touch the other side.
    void detect(const Points& nodes);

    /// Energy of the contacts that detect() found; its gradient is added.
    /// \param vertices of the patch
    double value(const Points& vertices, Points& gradient) const;

private:
    using Probe = FoldSkin::Probe;

    struct Touch {
        std::array<std::uint32_t, 6>
            corners{}; ///< of the patch: the probe's, then the other side's
        std::array<double, 6>
            shares{}; ///< the weighted sum of corners is the vector between the two
        Point normal; ///< outwards from the other side
        double gap = 0.0;
        double stiffness = 0.0;
    };

    /// The deformed flesh and skin.
    struct Flesh {
        DeformedCells cells;
        std::vector<FoldSkin::RatioSpan> ratios; ///< of each bin
        Points vertices, normals;                ///< of the patch
    };

    bool mayTouch(std::uint32_t triangle, const Flesh& flesh) const;
    void probe(std::uint32_t triangle, const Probe& probe, const Flesh& flesh);
    bool look(std::uint32_t triangle, const Probe& probe, const Point& at, const Point& normal,
              const Flesh& flesh, Touch& result) const;
    bool touch(std::uint32_t triangle, const Probe& probe, const Point& rest, const Point& facing,
               const Flesh& flesh, Touch& result) const;
    Point on(std::uint32_t triangle, const Point& shares, const Points& vertices) const;

    const FoldSkin& _skin;
    std::vector<Touch> _touches;
};

} // namespace osgSkin::elastic

#endif
