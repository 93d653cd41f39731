// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_COARSEGRAPH_H
#define OSGSKINBINDER_MESH_COARSEGRAPH_H

#include "mesh/HeatGraph.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The same skin with about a seventh of the vertices, for fields much wider than its edges.
///
/// Each group of fine vertices, a vertex and its neighbours, becomes one coarse vertex at their
/// centroid. Three groups that meet in a triangle give a coarse triangle. Edges longer than twice
/// the mean do not join a group, so sparse skin stays as it is.
class CoarseGraph {
public:
    /// \param fine must outlive this
    explicit CoarseGraph(const HeatGraph& fine);

    const HeatGraph& graph() const { return _graph; }

    /// A field on the fine skin, averaged over each group.
    std::vector<double> restricted(const std::vector<double>& field) const;
    /// A field on the coarse skin, interpolated; constant if the coarse one is.
    std::vector<double> interpolated(const std::vector<double>& field) const;

private:
    void makeGroups();
    void connectGroups();

    const HeatGraph& _fine;
    HeatGraph _graph;
    std::vector<std::uint32_t> _groupOf; ///< coarse vertex of each fine one
};

} // namespace osgSkin

#endif
