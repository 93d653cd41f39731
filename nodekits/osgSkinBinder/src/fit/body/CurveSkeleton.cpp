// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/CurveSkeleton.h"

#include "fit/body/SurfaceMesh.h"

#include <glm/geometric.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <memory_resource>
#include <new>
#include <queue>
#include <utility>
#include <vector>

namespace osgSkin {

std::vector<std::size_t> CurveSkeleton::Paths::pathFrom(std::size_t point) const {
    std::vector<std::size_t> path{point};
    while (next[path.back()] != path.back()) path.push_back(next[path.back()]);
    return path;
}

CurveSkeleton::Paths CurveSkeleton::pathsTo(std::size_t from,
                                            const std::vector<bool>& blocked) const {
    Paths paths;
    paths.length.assign(points.size(), std::numeric_limits<double>::infinity());
    for (std::size_t p = 0; p < points.size(); ++p) paths.next.push_back(p);
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    paths.length[from] = 0.0;
    open.emplace(0.0, from);
    while (!open.empty()) {
        const auto [length, p] = open.top();
        open.pop();
        if (length > paths.length[p]) continue;
        for (const std::size_t q : neighbours[p]) {
            const double longer = length + glm::distance(points[p], points[q]);
            if (longer >= paths.length[q] || (!blocked.empty() && blocked[q])) continue;
            paths.length[q] = longer;
            paths.next[q] = p;
            open.emplace(longer, q);
        }
    }
    return paths;
}

} // namespace osgSkin

namespace osgSkin::fit {
namespace {

/// Memory whose addresses grow with every allocation; it is freed all at once.
///
/// CGAL's mean curvature flow keeps edges in sets ordered by address, so with the usual allocator
/// the same body would have another skeleton in every process.
class OrderedMemory {
public:
    OrderedMemory() : _buffer(new std::byte[kBytes]), _resource(_buffer.get(), kBytes) {
        current() = &_resource;
    }
    ~OrderedMemory() { current() = nullptr; }
    OrderedMemory(const OrderedMemory&) = delete;
    OrderedMemory& operator=(const OrderedMemory&) = delete;

    /// The one in use in this thread, or null.
    static std::pmr::monotonic_buffer_resource*& current() {
        thread_local std::pmr::monotonic_buffer_resource* memory = nullptr;
        return memory;
    }

private:
    /// Unused pages cost nothing. Beyond this size, addresses grow only within each further block.
    static constexpr std::size_t kBytes = std::size_t(64) << 20;

    std::unique_ptr<std::byte[]> _buffer;
    std::pmr::monotonic_buffer_resource _resource;
};

/// Allocates from OrderedMemory while there is one. Whatever is so allocated must be destroyed
/// before the memory is.
template <typename T>
struct OrderedAllocator {
    using value_type = T;
    template <typename U>
    struct rebind {
        using other = OrderedAllocator<U>;
    };

    OrderedAllocator() = default;
    template <typename U>
    OrderedAllocator(const OrderedAllocator<U>&) {}

    T* allocate(std::size_t n) {
        if (auto* memory = OrderedMemory::current())
            return static_cast<T*>(memory->allocate(n * sizeof(T), alignof(T)));
        return static_cast<T*>(::operator new(n * sizeof(T)));
    }
    void deallocate(T* p, std::size_t) {
        if (!OrderedMemory::current()) ::operator delete(p);
    }

    bool operator==(const OrderedAllocator&) const { return true; }
    bool operator!=(const OrderedAllocator&) const { return false; }
};

} // namespace
} // namespace osgSkin::fit

// The headers above use CGAL's own allocator, those of the flow below this one.
#undef CGAL_ALLOCATOR
#define CGAL_ALLOCATOR(T) osgSkin::fit::OrderedAllocator<T>

#include <CGAL/Mean_curvature_flow_skeletonization.h>
#include <CGAL/boost/graph/iterator.h>

namespace osgSkin::fit {

CurveSkeleton contract(const Mesh& mesh) {
    const OrderedMemory memory;
    using Contraction = CGAL::Mean_curvature_flow_skeletonization<Mesh>;
    Contraction::Skeleton graph;
    Contraction contraction(mesh);
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
