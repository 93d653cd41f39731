// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Subject.h"

#include <memory>
#include <utility>
#include <vector>

namespace quality {

/// Counts pairs of triangles that cut each other, besides those that do so at rest.
class SelfIntersections {
public:
    explicit SelfIntersections(const Subject& subject);
    ~SelfIntersections();

    /// 0 where fewer pairs cut each other than at rest.
    std::size_t beyondRest(const compare::Points& posed);

    /// The pairs that cut each other, as indices of triangles, the smaller one first, sorted.
    std::vector<std::pair<std::size_t, std::size_t>> pairs(const compare::Points& posed);

private:
    struct Mesh;
    std::unique_ptr<Mesh> _mesh;
    std::size_t _atRest = 0;
};

} // namespace quality
