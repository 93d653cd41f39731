// SPDX-License-Identifier: MIT
#include "Blending.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
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

std::vector<glm::dmat4> linearBlendMatrices(const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning) {
    weights.validate(skinning.size());
    std::vector<glm::dmat4> result(weights.vertexCount(), glm::dmat4(0.0));
    for (std::size_t v = 0; v < result.size(); ++v)
        for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i)
            result[v] += weights.entries[i].weight * skinning[weights.entries[i].joint];
    return result;
}

std::vector<glm::dvec3> linearBlend(const std::vector<glm::dvec3>& rest, const SkinWeights& weights,
                                    const std::vector<glm::dmat4>& skinning) {
    return transformPoints(linearBlendMatrices(weights, skinning), rest);
}

namespace {

constexpr double kRigidTolerance = 1e-6;

bool isRigid(const glm::dmat4& m) {
    const glm::dmat3 r(m);
    const glm::dmat3 identity = glm::transpose(r) * r;
    for (int column = 0; column < 3; ++column) {
        if (!std::isfinite(m[3][column])) return false;
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(identity[column][row] - (column == row ? 1.0 : 0.0)) < kRigidTolerance))
                return false;
    }
    return glm::determinant(r) > 0.0;
}

/// The vertex's joint of largest weight; the first one if several are equal.
std::uint32_t heaviest(const SkinWeights& weights, std::size_t v) {
    std::uint32_t best = weights.first[v];
    for (std::uint32_t i = best; i < weights.first[v + 1]; ++i)
        if (weights.entries[i].weight > weights.entries[best].weight) best = i;
    return weights.entries[best].joint;
}

DualQuaternion blend(const SkinWeights& weights, std::size_t v,
                     const std::vector<DualQuaternion>& joints) {
    const DualQuaternion& pivot = joints[heaviest(weights, v)];
    DualQuaternion sum{{0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}};
    for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i) {
        const DualQuaternion& q = joints[weights.entries[i].joint];
        const double sign = glm::dot(pivot.real, q.real) < 0.0 ? -1.0 : 1.0;
        sum.real = sum.real + q.real * (sign * weights.entries[i].weight);
        sum.dual = sum.dual + q.dual * (sign * weights.entries[i].weight);
    }
    // Never zero: the pivot has the largest weight, and no other term opposes it.
    const double length = glm::length(sum.real);
    return {sum.real * (1.0 / length), sum.dual * (1.0 / length)};
}

glm::dmat4 toMatrix(const DualQuaternion& q) {
    glm::dmat4 result = glm::mat4_cast(q.real);
    const glm::dquat translation = q.dual * glm::conjugate(q.real) * 2.0;
    result[3] = glm::dvec4(translation.x, translation.y, translation.z, 1.0);
    return result;
}

} // namespace

DualQuaternion toDualQuaternion(const glm::dmat4& rigid) {
    if (!isRigid(rigid))
        throw std::invalid_argument(
            "dual quaternion: expected a matrix that only turns and shifts");
    const glm::dquat real = glm::normalize(glm::quat_cast(glm::dmat3(rigid)));
    return {real, glm::dquat(0.0, glm::dvec3(rigid[3])) * real * 0.5};
}

std::vector<glm::dmat4> dualQuaternionBlendMatrices(const SkinWeights& weights,
                                                    const std::vector<glm::dmat4>& skinning) {
    weights.validate(skinning.size());
    std::vector<DualQuaternion> joints;
    joints.reserve(skinning.size());
    for (const glm::dmat4& matrix : skinning) joints.push_back(toDualQuaternion(matrix));
    std::vector<glm::dmat4> result;
    result.reserve(weights.vertexCount());
    for (std::size_t v = 0; v < weights.vertexCount(); ++v)
        result.push_back(toMatrix(blend(weights, v, joints)));
    return result;
}

std::vector<glm::dvec3> dualQuaternionBlend(const std::vector<glm::dvec3>& rest,
                                            const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning) {
    return transformPoints(dualQuaternionBlendMatrices(weights, skinning), rest);
}

namespace {

double distance(const glm::dvec3& point, const Segment& bone) {
    const glm::dvec3 along = bone.to - bone.from;
    const double square = glm::dot(along, along);
    const double t =
        square > 0.0 ? std::clamp(glm::dot(point - bone.from, along) / square, 0.0, 1.0) : 0.0;
    return glm::distance(point, bone.from + t * along);
}

double distance(const glm::dvec3& point, const std::vector<Segment>& bones) {
    double least = std::numeric_limits<double>::infinity();
    for (const Segment& bone : bones) least = std::min(least, distance(point, bone));
    return least;
}

} // namespace

double enclosedVolume(const Points& points, const std::vector<std::uint32_t>& triangles) {
    double sum = 0.0;
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
        sum += glm::dot(points[triangles[t]],
                        glm::cross(points[triangles[t + 1]], points[triangles[t + 2]]));
    return sum / 6.0;
}

double loopArea(const Points& points, const std::vector<std::uint32_t>& loop) {
    if (loop.empty()) return 0.0;
    // Relative to a vertex of the loop instead of the origin, for precision.
    const glm::dvec3 origin = points[loop.front()];
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < loop.size(); ++i)
        sum += glm::cross(points[loop[i]] - origin, points[loop[(i + 1) % loop.size()]] - origin);
    return 0.5 * glm::length(sum);
}

std::vector<Edge> faceEdges(const std::vector<std::uint32_t>& sizes,
                            const std::vector<std::uint32_t>& vertices) {
    std::vector<Edge> edges;
    std::size_t corner = 0;
    for (const std::uint32_t size : sizes) {
        for (std::uint32_t k = 0; k < size; ++k) {
            const std::uint32_t a = vertices[corner + k];
            const std::uint32_t b = vertices[corner + (k + 1) % size];
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
        corner += size;
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

EdgeStrain edgeStrain(const Points& rest, const Points& posed, const std::vector<Edge>& edges) {
    std::vector<double> ratios;
    double squares = 0.0;
    for (const Edge& edge : edges) {
        const double length = glm::distance(rest[edge[0]], rest[edge[1]]);
        if (!(length > 0.0)) continue;
        ratios.push_back(glm::distance(posed[edge[0]], posed[edge[1]]) / length);
        squares += (ratios.back() - 1.0) * (ratios.back() - 1.0);
    }
    if (ratios.empty()) return {0.0, 1.0, 1.0};
    std::sort(ratios.begin(), ratios.end());
    const auto count = static_cast<double>(ratios.size());
    const auto rank = static_cast<std::size_t>(std::ceil(0.999 * count)) - 1; // nearest rank
    return {std::sqrt(squares / count), ratios[rank], ratios.back()};
}

double bulge(const Points& rest, const Points& posed, const std::vector<std::uint32_t>& vertices,
             const std::vector<Segment>& restBones, const std::vector<Segment>& posedBones) {
    double largest = 0.0;
    for (const std::uint32_t v : vertices) {
        const double before = distance(rest[v], restBones);
        if (before > 0.0) largest = std::max(largest, distance(posed[v], posedBones) / before);
    }
    return largest;
}

} // namespace compare
