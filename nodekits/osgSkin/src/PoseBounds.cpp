// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include "Chain.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace osgSkin {
namespace {

constexpr std::size_t kMax = SkinModel::kMaxPartial;

/// Cells per unit of ratio and per extent of the skin: finer cells give tighter bounds and cost
/// more.
constexpr float kRatioCells = 8.0f;
constexpr float kSpaceCells = 12.0f;

using Cell = std::array<int, 3 + 2 * kMax>;

float extentOf(const SkinModel& model) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(-std::numeric_limits<float>::max());
    for (const glm::vec3& p : model.positions()) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 d = high - low;
    return std::max({d.x, d.y, d.z, std::numeric_limits<float>::min()});
}

/// How far from each partial joint's centre the vertex can get before that joint turns it: the
/// turns of the joints applied earlier (deeper ones) keep its distance from their own centres.
std::array<float, kMax> reaches(const SkinModel& model, const SkinModel::Group& group,
                                const glm::vec3& position) {
    std::array<float, kMax> reach{};
    glm::vec3 from = position;
    float distance = 0.0f;
    std::size_t k = group.partialCount;
    for (std::uint32_t i = group.firstLink + group.linkCount; i-- > group.firstLink;) {
        const SkinModel::Link& link = model.links()[i];
        const glm::vec3 centre(model.joints()[link.joint].centre);
        distance += glm::length(centre - from);
        from = centre;
        if (link.partial) reach[--k] = distance;
    }
    return reach;
}

BoundProxy makeProxy(const SkinModel& model, std::uint32_t groupIndex,
                     const std::vector<std::uint32_t>& rows) {
    const SkinModel::Group& group = model.groups()[groupIndex];
    const auto vertex = [&](std::uint32_t row) { return model.order()[group.firstVertex + row]; };
    const auto ratio = [&](std::uint32_t row, std::size_t k) {
        return model.ratios()[group.firstRatio + row * group.partialCount + k];
    };
    BoundProxy proxy{};
    proxy.group = groupIndex;
    const float share = 1.0f / static_cast<float>(rows.size());
    for (const std::uint32_t row : rows) {
        proxy.centre += share * model.positions()[vertex(row)];
        for (std::size_t k = 0; k < group.partialCount; ++k) {
            proxy.bend[k] += share * ratio(row, k).bend;
            proxy.twist[k] += share * ratio(row, k).twist;
        }
    }
    for (const std::uint32_t row : rows) {
        const glm::vec3& position = model.positions()[vertex(row)];
        proxy.radius = std::max(proxy.radius, glm::length(position - proxy.centre));
        const std::array<float, kMax> reach = reaches(model, group, position);
        for (std::size_t k = 0; k < group.partialCount; ++k) {
            const SkinModel::Ratio r = ratio(row, k);
            proxy.bendReach[k] =
                std::max(proxy.bendReach[k], std::abs(r.bend - proxy.bend[k]) * reach[k]);
            proxy.twistReach[k] =
                std::max(proxy.twistReach[k], std::abs(r.twist - proxy.twist[k]) * reach[k]);
        }
    }
    return proxy;
}

} // namespace

std::vector<BoundProxy> makeBoundProxies(const SkinModel& model) {
    std::vector<BoundProxy> proxies;
    const float cell = extentOf(model) / kSpaceCells;
    for (std::uint32_t g = 0; g < model.groups().size(); ++g) {
        const SkinModel::Group& group = model.groups()[g];
        std::map<Cell, std::vector<std::uint32_t>> cells;
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const glm::vec3 at = model.positions()[model.order()[group.firstVertex + row]] / cell;
            Cell key{};
            for (int axis = 0; axis < 3; ++axis)
                key[static_cast<std::size_t>(axis)] = static_cast<int>(std::floor(at[axis]));
            for (std::size_t k = 0; k < group.partialCount; ++k) {
                const SkinModel::Ratio r =
                    model.ratios()[group.firstRatio + row * group.partialCount + k];
                key[3 + 2 * k] = static_cast<int>(r.bend * kRatioCells);
                key[4 + 2 * k] = static_cast<int>(r.twist * kRatioCells);
            }
            cells[key].push_back(row);
        }
        for (const auto& entry : cells) proxies.push_back(makeProxy(model, g, entry.second));
    }
    return proxies;
}

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    PoseBounds box{glm::vec3(std::numeric_limits<float>::max()),
                   glm::vec3(-std::numeric_limits<float>::max())};
    const std::vector<BoundProxy>& proxies = model.boundProxies();
    for (std::size_t i = 0; i < proxies.size();) {
        const std::uint32_t g = proxies[i].group;
        const Chain chain(model, model.groups()[g], pose);
        for (; i < proxies.size() && proxies[i].group == g; ++i) {
            const BoundProxy& proxy = proxies[i];
            std::array<SkinModel::Ratio, kMax> ratios{};
            float radius = proxy.radius;
            for (std::size_t k = 0; k < chain.partialCount; ++k) {
                const Chain::Partial& joint = chain.partial[k];
                ratios[k] = {proxy.bend[k], proxy.twist[k]};
                radius += 2.0f * (proxy.bendReach[k] * std::abs(joint.halfBend) +
                                  proxy.twistReach[k] * std::abs(joint.halfTwist)) +
                          glm::length(joint.translation) / kRatioCells;
            }
            glm::vec3 centre = proxy.centre;
            chain.apply(ratios.data(), centre, nullptr);
            box.low = glm::min(box.low, centre - radius);
            box.high = glm::max(box.high, centre + radius);
        }
    }
    return box;
}

} // namespace osgSkin
