// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_FILLEDGRID_H
#define OSGSKINBIND_ELASTIC_FILLEDGRID_H

#include "elastic/skin/RestSkin.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgSkin::elastic {

/// Cubic cells in a ball around the joint, each with 3 x 3 x 3 samples that are within the skin or
/// not. A cell that two limbs share without touching in it (thighs below the crotch) comes as two
/// copies, one for each connected piece of its filled samples, so that they do not grow together
/// (virtual nodes: Molino, Bao & Fedkiw 2004).
class FilledGrid {
public:
    static constexpr int kFine = 3; ///< samples along a cell's edge
    static constexpr std::int32_t kEmpty = -1;

    /// A cell, or one of several copies of it.
    struct Copy {
        Eigen::Vector3i place; ///< of the cell; its lowest corner lies at edge * place
    };

    /// \param edge of the cells
    /// \param reach radius of the ball; cells count by their centres
    FilledGrid(const RestSkin& skin, double edge, double reach);

    double edge() const { return _edge; }
    double reach() const { return _reach; }
    const std::vector<Copy>& copies() const { return _copies; }

    /// The copy that owns the sample nearest to the point, which may lie up to a few samples off;
    /// kEmpty where there is none.
    std::int32_t copyNear(const Point& point) const;

    /// The copy that owns the sample in whose small cube the point lies; kEmpty where it is not
    /// filled.
    std::int32_t copyAt(const Point& point) const;

    /// Whether a point is within the skin, where that is known without asking the skin: it passes
    /// nowhere through the small cube of the sample.
    std::optional<bool> isInside(const Point& point) const;

    /// Calls join(a, b, axis) for copies that touch, b being the next one along the axis.
    template <typename Join>
    void forEachTouch(const Join& join) const;

private:
    std::size_t indexOf(const Eigen::Vector3i& fine) const {
        const auto at = fine.cast<std::size_t>();
        const auto samples = static_cast<std::size_t>(_samples);
        return (at.z() * samples + at.y()) * samples + at.x();
    }
    Point sampleAt(const Eigen::Vector3i& fine) const;
    Eigen::Vector3i fineAt(const Point& point) const;
    bool contains(const Eigen::Vector3i& fine) const;
    void classify(const RestSkin& skin);
    void fillAroundVertices(const RestSkin& skin);
    void makeCopies();
    void flood(const Eigen::Vector3i& from, const Eigen::Vector3i& cell, std::int32_t copy);
    bool inBall(const Eigen::Vector3i& cell) const;

    double _edge, _reach;
    int _half;                         ///< cells from the middle to one end
    int _samples;                      ///< along an axis
    std::vector<std::int32_t> _copyOf; ///< of each sample
    std::vector<bool> _sure;           ///< of each sample: its whole cube is on one side
    std::vector<Copy> _copies;
};

template <typename Join>
void FilledGrid::forEachTouch(const Join& join) const {
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
        for (int z = 0; z < _samples; ++z)
            for (int y = 0; y < _samples; ++y)
                for (int x = 0; x < _samples; ++x) {
                    const Eigen::Vector3i here(x, y, z), next = here + step;
                    if (here[axis] % kFine != kFine - 1 || !contains(next)) continue;
                    const std::int32_t a = _copyOf[indexOf(here)];
                    const std::int32_t b = _copyOf[indexOf(next)];
                    if (a != kEmpty && b != kEmpty) join(a, b, axis);
                }
    }
}

} // namespace osgSkin::elastic

#endif
