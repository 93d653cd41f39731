// SPDX-License-Identifier: MIT
#pragma once

#include "CutSkin.h"
#include "Methods.h"

namespace quality {

/// Cross-sections of a skin while a single joint turns.
///
/// Each is followed in two ways. The mesh's own: its points stay on their edges, so it also shrinks
/// where a coarse mesh's edges cut across a twist. The method's: its points are vertices, with the
/// mean ratios or weights of their edges' ends, as on an infinitely fine mesh.
class CrossSections {
public:
    /// \param joint the only joint that will turn
    CrossSections(const Subject& subject, std::size_t joint,
                  const std::vector<std::vector<EdgePoint>>& loops);

    struct Least {
        double ofMethod = 1.0, ofMesh = 1.0; ///< smallest A'/A
    };
    /// \param posed the whole skin, deformed by `method` under `skinning`
    Least leastAreas(Method method, const std::vector<glm::dmat4>& skinning,
                     const compare::Points& posed) const;

private:
    std::vector<std::vector<std::uint32_t>> _loops; ///< of points
    std::vector<EdgePoint> _points;
    Subject _fine; ///< the points as vertices
};

} // namespace quality
