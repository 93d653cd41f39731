// SPDX-License-Identifier: MIT
#include "SkinWeights.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace compare {

void SkinWeights::add(const std::vector<JointWeight>& vertex) {
    for (const JointWeight& entry : vertex)
        if (entry.weight != 0.0) entries.push_back(entry);
    first.push_back(static_cast<std::uint32_t>(entries.size()));
}

void SkinWeights::validate(std::size_t joints) const {
    if (first.empty() || first.front() != 0 || first.back() != entries.size())
        throw std::invalid_argument("skin weights: the offsets do not span the entries");
    for (std::size_t v = 0; v < vertexCount(); ++v) {
        const std::string vertex = "skin weights: vertex " + std::to_string(v);
        if (first[v + 1] < first[v] || first[v + 1] > entries.size())
            throw std::invalid_argument(vertex + ": the offsets decrease");
        double sum = 0.0;
        for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
            const JointWeight& entry = entries[i];
            if (entry.joint >= joints)
                throw std::invalid_argument(vertex + ": no joint " + std::to_string(entry.joint));
            if (!std::isfinite(entry.weight) || entry.weight < 0.0)
                throw std::invalid_argument(vertex + ": a weight is negative or not finite");
            sum += entry.weight;
        }
        if (std::abs(sum - 1.0) > 1e-6)
            throw std::invalid_argument(vertex + ": the weights sum to " + std::to_string(sum) +
                                        ", expected 1");
    }
}

std::vector<glm::dvec3> transformPoints(const std::vector<glm::dmat4>& matrices,
                                        const std::vector<glm::dvec3>& points) {
    if (matrices.size() != points.size())
        throw std::invalid_argument("transform points: expected a matrix for each point");
    std::vector<glm::dvec3> result;
    result.reserve(points.size());
    for (std::size_t v = 0; v < points.size(); ++v)
        result.emplace_back(matrices[v] * glm::dvec4(points[v], 1.0));
    return result;
}

} // namespace compare
