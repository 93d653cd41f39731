// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_COARSEGRAPH_H
#define OSGSKINBIND_COARSEGRAPH_H

#include "mesh/HeatGraph.h"

#include <vector>

namespace osgSkin {

/// The same skin with about a seventh of the vertices, for fields much wider than its edges.
///
/// A coarse vertex stands, at their centroid, for a group: a vertex and its neighbours. Where three
/// groups meet in a triangle there is a coarse triangle. Edges longer than twice the mean don't
/// join a group, so that the skin stays as it is where it is sparse already.
class CoarseGraph {
public:
    /// \param fine must outlive this
    explicit CoarseGraph(const HeatGraph& fine);

    const HeatGraph& graph() const { return _graph; }

    /// A field on the fine skin, averaged over what each coarse vertex stands for.
    std::vector<double> restricted(const std::vector<double>& field) const;
    /// A field on the coarse skin, interpolated; constant where the coarse one is.
    std::vector<double> interpolated(const std::vector<double>& field) const;

private:
    void gatherGroups();
    void placeGroups();
    void connectGroups();

    const HeatGraph& _fine;
    HeatGraph _graph;
    std::vector<std::uint32_t> _groupOf; ///< coarse vertex of each fine one
};

} // namespace osgSkin

#endif
