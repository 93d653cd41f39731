// SPDX-License-Identifier: MIT
#include "model/GradientBlocks.h"

#include "model/SkinBlocks.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

/// A lower limit for lengths, for vertices without a normal.
constexpr double kMinLength = 1e-9;

/// A ratio's gradient along a vertex's u and v.
struct Components {
    double u, v;
};

struct LinkComponents {
    Components bend{0.0, 0.0}, twist{0.0, 0.0};
};

Components along(const SkinDirections& directions, const glm::vec3& gradient) {
    const glm::dvec3 g(gradient);
    return {glm::dot(g, directions.u), glm::dot(g, directions.v)};
}

/// The gradients of a bound vertex's partial influences, for each partial link of its group,
/// outermost first.
std::vector<LinkComponents> componentsOf(const Binding& binding, std::uint32_t vertex,
                                         const SkinModel& model, const SkinModel::Group& group,
                                         const SkinDirections& directions) {
    std::vector<LinkComponents> result;
    for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i) {
        if (!model.links()[i].partial) continue;
        LinkComponents& link = result.emplace_back();
        const Influence* own = influenceOf(binding, vertex, model.links()[i].joint);
        if (!own || !own->isPartial()) continue; // of a group joined with another
        const RatioGradient& gradient =
            binding.gradients[static_cast<std::size_t>(own - binding.influences.data())];
        link = {along(directions, gradient.bend), along(directions, gradient.twist)};
    }
    return result;
}

/// The smallest power of two with which the largest component, rounded, fits into 16 bits.
double unitFor(double largest) {
    if (!(largest > 0.0)) return 1.0;
    int exponent;
    std::frexp(largest * (1.0 + 1e-6), &exponent);
    return std::ldexp(1.0, std::clamp(exponent, -100, 100) - 15);
}

std::int16_t rounded(double value) {
    constexpr double kMax = 32767.0;
    return static_cast<std::int16_t>(std::lrint(std::clamp(value, -kMax, kMax)));
}

/// Components beyond this multiple of their ninth decile are clamped: a ratio that steps within an
/// edge would coarsen the normals of the whole skin.
constexpr double kSteep = 64.0;

/// \param sizes of all components; zeros are removed
double unitOf(std::vector<double>& sizes) {
    sizes.erase(std::remove(sizes.begin(), sizes.end(), 0.0), sizes.end());
    if (sizes.empty()) return 1.0;
    const auto high = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 9 / 10);
    std::nth_element(sizes.begin(), high, sizes.end());
    return unitFor(std::min(*std::max_element(high, sizes.end()), kSteep * *high));
}

/// The units that components are rounded to, one after the other; usually one. Rounding by the last
/// changes nothing any more, so that gradients read from a model give the same model again.
std::vector<double> unitsOf(std::vector<double> sizes) {
    constexpr std::size_t kMax = 4;
    std::vector<double> units;
    while (units.size() < kMax) {
        const double unit = unitOf(sizes);
        if (!units.empty() && unit == units.back()) break;
        units.push_back(unit);
        for (double& size : sizes) size = unit * rounded(size / unit);
    }
    return units;
}

std::int16_t rounded(double component, const std::vector<double>& units) {
    std::int16_t result = 0;
    for (const double unit : units) {
        result = rounded(component / unit);
        component = unit * result;
    }
    return result;
}

glm::dvec3 inFrame(const glm::vec3& normal, const glm::dmat3& frame) {
    return glm::dvec3(glm::vec3(glm::dvec3(normal) * frame)); // as in SkinBlocks
}

/// The i-th of directions spread over half a sphere, in a sunflower's spiral.
constexpr int kDirections = 24;
BlockAcross directionAt(int i) {
    const double z = (i + 0.5) / kDirections, r = std::sqrt(1.0 - z * z);
    const double turn = i * glm::pi<double>() * (3.0 - std::sqrt(5.0));
    return {{static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
             static_cast<float>(z)}};
}

glm::dvec3 vectorOf(const BlockAcross& across) {
    return {across.across[0], across.across[1], across.across[2]};
}

/// The square of the sine of the smallest angle between a direction and the normals.
double leastAngle(const std::vector<glm::dvec3>& normals, const BlockAcross& direction) {
    double least = 1.0;
    for (const glm::dvec3& n : normals) {
        const glm::dvec3 v = glm::cross(n, vectorOf(direction));
        if (n != glm::dvec3(0.0)) least = std::min(least, glm::dot(v, v));
    }
    return least;
}

/// kAlongFrame where it is at least 30 degrees from all normals, else the direction whose smallest
/// angle to them is largest.
BlockAcross acrossAll(const std::vector<glm::dvec3>& normals) {
    if (leastAngle(normals, kAlongFrame) >= 0.25) return kAlongFrame;
    BlockAcross best{};
    double bestLeast = -1.0;
    for (int i = 0; i < kDirections; ++i) {
        const BlockAcross candidate = directionAt(i);
        const double least = leastAngle(normals, candidate);
        if (least <= bestLeast) continue;
        bestLeast = least;
        best = candidate;
    }
    return best;
}

std::vector<BlockAcross> acrossOfBlocks(const SkinModel& model) {
    std::vector<BlockAcross> result;
    std::vector<glm::dvec3> normals; // of a block
    for (const SkinModel::Group& group : model.groups()) {
        const glm::dmat3 frame = restFrame(model, group);
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            normals.push_back(
                inFrame(model.normals()[model.order()[group.firstVertex + row]], frame));
            if (normals.size() < kBlock && row + 1 < group.vertexCount) continue;
            result.push_back(acrossAll(normals));
            normals.clear();
        }
    }
    return result;
}

} // namespace

SkinDirections skinDirections(const glm::vec3& normal, const glm::dmat3& frame,
                              const BlockAcross& across) {
    const glm::dvec3 n = inFrame(normal, frame);
    const glm::dvec3 v = glm::cross(n, vectorOf(across));
    return {frame * glm::cross(v, n), frame * v};
}

const BlockAcross& GradientBlocks::acrossOf(const SkinModel& model, std::size_t group,
                                            std::uint32_t row) const noexcept {
    return across[SkinModelAccess::blocks(model).firstBlock[group] + row / kBlock];
}

GradientBlocks::GradientBlocks(const SkinModel& model, const Binding& binding,
                               const std::vector<std::uint32_t>& source)
    : across(acrossOfBlocks(model)) {
    std::vector<double> sizes;
    for (std::size_t g = 0; g < model.groups().size(); ++g) {
        const SkinModel::Group& group = model.groups()[g];
        const glm::dmat3 frame = restFrame(model, group);
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const std::uint32_t v = model.order()[group.firstVertex + row];
            const SkinDirections at =
                skinDirections(model.normals()[v], frame, acrossOf(model, g, row));
            for (const LinkComponents& link : componentsOf(binding, source[v], model, group, at))
                for (const double c : {link.bend.u, link.bend.v, link.twist.u, link.twist.v})
                    sizes.push_back(std::abs(c));
        }
    }
    const std::vector<double> units = unitsOf(std::move(sizes));
    unit = units.back();

    for (std::size_t g = 0; g < model.groups().size(); ++g) {
        const SkinModel::Group& group = model.groups()[g];
        const std::size_t blockRows = rowsPerBlock(group.partialCount);
        const std::size_t blocks = (group.vertexCount + kBlock - 1) / kBlock;
        const glm::dmat3 frame = restFrame(model, group);
        firstRow.push_back(rows.size());
        firstReach.push_back(reach.size());
        rows.resize(rows.size() + blocks * blockRows, GradientRow{});
        reach.resize(reach.size() + group.partialCount, Reach{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const std::uint32_t v = model.order()[group.firstVertex + row];
            const SkinDirections at =
                skinDirections(model.normals()[v], frame, acrossOf(model, g, row));
            const double sizeU = std::max(glm::length(at.u), kMinLength);
            const double sizeV = std::max(glm::length(at.v), kMinLength);
            GradientRow* to = rows.data() + firstRow.back() + row / kBlock * blockRows;
            const auto put = [&](double number) {
                (to++)->lane[row % kBlock] = rounded(number, units);
            };
            const std::vector<LinkComponents> links =
                componentsOf(binding, source[v], model, group, at);
            // Inner joints rotate the vertex about their centres, so distances add up.
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
                    put(c.u);
                    put(c.v);
                    const double slope = std::hypot(c.u / sizeU, c.v / sizeV);
                    farthest = std::max(farthest, static_cast<float>(distance * slope));
                };
                take(links[k].bend, most.bend);
                take(links[k].twist, most.twist);
            }
        }
    }
}

GradientBlocks::GradientBlocks(const SkinModel& model, GradientBlocks&& from)
    : GradientBlocks(std::move(from)) {
    std::size_t rowCount = 0, reachCount = 0;
    for (const SkinModel::Group& group : model.groups()) {
        firstRow.push_back(rowCount);
        firstReach.push_back(reachCount);
        rowCount += (group.vertexCount + kBlock - 1) / kBlock * rowsPerBlock(group.partialCount);
        reachCount += group.partialCount;
    }
    if (across.size() != SkinModelAccess::blocks(model).firstBlock.back() ||
        rows.size() != rowCount || reach.size() != reachCount)
        throw Error("skin model: its gradients do not fit its groups");
    bool isFinite = unit > 0.0 && std::isfinite(unit);
    for (const BlockAcross& direction : across)
        for (const float number : direction.across) isFinite = isFinite && std::isfinite(number);
    for (const Reach& most : reach)
        isFinite = isFinite && std::isfinite(most.bend) && std::isfinite(most.twist);
    if (!isFinite) throw Error("skin model: a gradient is not finite");
}

std::vector<RatioGradient> gradientsOf(const SkinModel& model) {
    std::vector<RatioGradient> result;
    const GradientBlocks* blocks = SkinModelAccess::gradients(model);
    if (!blocks) return result;
    for (std::size_t g = 0; g < model.groups().size(); ++g) {
        const SkinModel::Group& group = model.groups()[g];
        const glm::dmat3 frame = restFrame(model, group);
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const SkinDirections at =
                skinDirections(model.normals()[model.order()[group.firstVertex + row]], frame,
                               blocks->acrossOf(model, g, row));
            constexpr double kMinSquare = kMinLength * kMinLength;
            const glm::dvec3 u = at.u / std::max(glm::dot(at.u, at.u), kMinSquare);
            const glm::dvec3 v = at.v / std::max(glm::dot(at.v, at.v), kMinSquare);
            const GradientRow* from =
                blocks->blockOf(model, g, row) + GradientBlocks::rowsPerBlock(group.partialCount);
            for (std::uint32_t i = 0; i < group.linkCount; ++i) {
                RatioGradient& to = result.emplace_back();
                if (!model.links()[group.firstLink + i].partial) continue;
                from -= 4;
                const auto vector = [&](const GradientRow* rows) {
                    return glm::vec3(blocks->unit * (double(rows[0].lane[row % kBlock]) * u +
                                                     double(rows[1].lane[row % kBlock]) * v));
                };
                to = {vector(from), vector(from + 2)};
            }
        }
    }
    return result;
}

} // namespace osgSkin
