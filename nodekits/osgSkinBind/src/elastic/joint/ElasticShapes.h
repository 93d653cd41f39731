// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_ELASTICSHAPES_H
#define OSGSKINBIND_ELASTIC_ELASTICSHAPES_H

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgSkin {

/// The elastic solid at one rotation of the joint.
struct ElasticSample {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    /// Empty where the shape is good. Else why it must not be fitted: the solid tangled or
    /// penetrates, and `positions` is what came nearest, or empty.
    std::string reason;
    std::vector<glm::dvec3> positions; ///< of ElasticShapes::vertices, rest space, parent at rest

    bool converged = false; ///< came to rest; where it did not, it is about as near as it gets
    int steps = 0;          ///< of the minimiser, on the way from the sample before
    /// Pairs of triangles within reach that cut each other, beyond rest: here, and in the plain
    /// skin.
    std::size_t crossings = 0, plainCrossings = 0;
    double leastJacobian = 0.0; ///< smallest volume ratio at a point of the lattice; above 0
    double volumeRatio = 0.0;   ///< of all flesh, posed over rest
    double seconds = 0.0;       ///< of one processor
};

/// What solveElasticJoint() found.
struct ElasticShapes {
    std::string joint;
    std::string reason; ///< empty where it could be solved; else why not, and nothing below is set

    std::vector<std::uint32_t> vertices; ///< of the skin, within reach; rising
    std::vector<glm::dvec3> rest;        ///< their rest positions
    double reach = 0.0;                  ///< from the joint's centre; the rim there is pinned
    /// In the order asked for; behind them what was solved in place of bad ones, on the way there.
    std::vector<ElasticSample> samples;
    std::size_t cells = 0, nodes = 0; ///< of the lattice
    double seconds = 0.0;             ///< of one processor
};

} // namespace osgSkin

#endif
