// SPDX-License-Identifier: MIT
#include "model/GradientBlocks.h"

#include "model/SkinModelAccess.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// A ratio's gradient along a vertex's u and v.
struct Components {
    double u, v;
};

struct LinkComponents {
    Components bend, twist;
};

Components along(const SkinDirections& directions, const glm::vec3& gradient) {
    const glm::dvec3 g(gradient);
    return {glm::dot(g, directions.u), glm::dot(g, directions.v)};
}

/// The gradients of a bound vertex's partial influences, outermost first.
std::vector<LinkComponents> componentsOf(const Binding& binding, std::uint32_t vertex,
                                         const SkinDirections& directions) {
    std::vector<LinkComponents> result;
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].isPartial())
            result.push_back({along(directions, binding.gradients[i].bend),
                              along(directions, binding.gradients[i].twist)});
    return result;
}

double largestOf(const LinkComponents& c) {
    return std::max(
        {std::abs(c.bend.u), std::abs(c.bend.v), std::abs(c.twist.u), std::abs(c.twist.v)});
}

/// So large that the largest component, rounded down, still fits; the same for what comes of that.
double unitFor(double largest) {
    if (!(largest > 0.0)) return 1.0;
    int exponent;
    std::frexp(largest * (1.0 + 1e-6), &exponent);
    return std::ldexp(1.0, std::clamp(exponent, -100, 100) - 15);
}

std::int16_t rounded(double value) {
    constexpr double kMost = 32767.0;
    return static_cast<std::int16_t>(std::lrint(std::clamp(value, -kMost, kMost)));
}

} // namespace

SkinDirections skinDirections(const glm::vec3& normal) {
    const glm::dvec3 n(normal);
    const double length = glm::length(n);
    const glm::dvec3 unit = length > 0.0 ? n / length : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 u = anyPerpendicular(unit);
    return {u, glm::cross(unit, u)};
}

GradientBlocks::GradientBlocks(const SkinModel& model, const Binding& binding,
                               const std::vector<std::uint32_t>& source) {
    double largest = 0.0;
    for (std::uint32_t v = 0; v < source.size(); ++v)
        for (const LinkComponents& link :
             componentsOf(binding, source[v], skinDirections(model.normals()[v])))
            largest = std::max(largest, largestOf(link));
    unit = unitFor(largest);

    for (const SkinModel::Group& group : model.groups()) {
        const std::size_t blockRows = rowsPerBlock(group.partialCount);
        const std::size_t blocks = (group.vertexCount + kBlock - 1) / kBlock;
        const std::size_t firstDirection = directions.size();
        const glm::dmat3 frame = restFrame(model, group);
        firstRow.push_back(rows.size());
        firstReach.push_back(reach.size());
        directions.resize(firstDirection + blocks * kDirectionRows, BlockRow{});
        rows.resize(rows.size() + blocks * blockRows, GradientRow{});
        reach.resize(reach.size() + group.partialCount, Reach{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const std::uint32_t v = model.order()[group.firstVertex + row];
            const SkinDirections at = skinDirections(model.normals()[v]);
            const glm::dvec3 u = at.u * frame; // transposed: into the frame
            BlockRow* direction = &directions[firstDirection + row / kBlock * kDirectionRows];
            for (int axis = 0; axis < 3; ++axis)
                direction[axis].lane[row % kBlock] = static_cast<float>(u[axis]);
            GradientRow* to = rows.data() + firstRow.back() + row / kBlock * blockRows;
            const auto put = [&](double number) { (to++)->lane[row % kBlock] = rounded(number); };
            const std::vector<LinkComponents> links = componentsOf(binding, source[v], at);
            // Joints further in turn the vertex, too: what they keep is its distance from theirs.
            double distance = 0.0;
            glm::dvec3 from(model.positions()[v]);
            std::size_t k = links.size();
            for (std::uint32_t i = group.firstLink + group.linkCount; i-- > group.firstLink;) {
                const glm::dvec3& centre = model.joints()[model.links()[i].joint].centre;
                distance += glm::distance(centre, from);
                from = centre;
                if (!model.links()[i].partial) continue;
                Reach& most = reach[firstReach.back() + --k];
                const auto take = [&](const Components& c, float& farthest) {
                    put(c.u / unit);
                    put(c.v / unit);
                    farthest =
                        std::max(farthest, static_cast<float>(distance * std::hypot(c.u, c.v)));
                };
                take(links[k].bend, most.bend);
                take(links[k].twist, most.twist);
            }
        }
    }
}

std::vector<RatioGradient> gradientsOf(const SkinModel& model) {
    std::vector<RatioGradient> result;
    const GradientBlocks* blocks = SkinModelAccess::gradients(model);
    if (!blocks) return result;
    for (std::size_t g = 0; g < model.groups().size(); ++g) {
        const SkinModel::Group& group = model.groups()[g];
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const SkinDirections at =
                skinDirections(model.normals()[model.order()[group.firstVertex + row]]);
            const GradientRow* from =
                blocks->blockOf(model, g, row) + GradientBlocks::rowsPerBlock(group.partialCount);
            for (std::uint32_t i = 0; i < group.linkCount; ++i) {
                RatioGradient& to = result.emplace_back();
                if (!model.links()[group.firstLink + i].partial) continue;
                from -= 4;
                const auto vector = [&](const GradientRow* rows) {
                    return glm::vec3(blocks->unit * (double(rows[0].lane[row % kBlock]) * at.u +
                                                     double(rows[1].lane[row % kBlock]) * at.v));
                };
                to = {vector(from), vector(from + 2)};
            }
        }
    }
    return result;
}

} // namespace osgSkin
