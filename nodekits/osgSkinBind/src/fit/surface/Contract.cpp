// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/surface/Contract.h"

#include "fit/surface/OrderedAllocator.h"
#include "fit/surface/Simplify.h"

// The headers so far have CGAL's own allocator; those of the flow come below.
#undef CGAL_ALLOCATOR
#define CGAL_ALLOCATOR(T) osgSkin::fit::OrderedAllocator<T>

#include <CGAL/Mean_curvature_flow_skeletonization.h>
#include <CGAL/boost/graph/iterator.h>

namespace osgSkin::fit {
namespace {

using Contraction = CGAL::Mean_curvature_flow_skeletonization<Mesh>;

} // namespace

CurveSkeleton contract(const Mesh& mesh, const std::function<void(double)>& tell) {
    const OrderedMemory memory;
    Contraction::Skeleton graph;
    Contraction contraction(simplified(mesh, tell));
    contraction.contract_until_convergence();
    contraction.convert_to_skeleton(graph);

    CurveSkeleton result;
    for (const auto v : CGAL::make_range(boost::vertices(graph)))
        result.points.push_back(vector(graph[v].point));
    result.neighbours.resize(result.points.size());
    for (const auto e : CGAL::make_range(boost::edges(graph))) {
        result.neighbours[source(e, graph)].push_back(target(e, graph));
        result.neighbours[target(e, graph)].push_back(source(e, graph));
    }
    return result;
}

} // namespace osgSkin::fit
