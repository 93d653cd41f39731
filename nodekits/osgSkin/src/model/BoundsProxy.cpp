// SPDX-License-Identifier: MIT
#include "model/BoundsProxy.h"
#include "model/CorrectiveBlocks.h"

#include "model/SkinModelAccess.h"
#include "model/VertexGroups.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace osgSkin {
namespace {

constexpr std::size_t kMaxLinks = SkinModel::kMaxPartialInfluences;
using Rows = std::vector<std::uint32_t>;
using Ratios = std::array<SkinModel::Ratio, kMaxLinks>;

/// How finely a skin is cut: patches are at most this long, and their vertices stray at most this
/// far from the patch while each of their joints turns by one radian.
struct Fineness {
    float length;
    float stray;
};

/// Length of the k-th mode's shares in a lane.
float lengthOf(const CorrectiveRow* block, std::size_t mode, std::size_t lane) {
    float sum = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float share = block[3 * mode + axis].lane[lane];
        sum += share * share;
    }
    return std::sqrt(sum);
}

/// Adds to the last run of `skin` how far correctives can take the vertices of its patches.
/// \param patches rows of the run's group
void addCorrectiveReach(const CorrectiveBlocks& blocks, const std::vector<Rows>& patches,
                        BoundsProxy& skin) {
    const std::size_t group = skin.runs.size() - 1; // a run a group
    BoundsProxy::Run& run = skin.runs.back();
    run.firstCorrection = static_cast<std::uint32_t>(skin.corrections.size());
    for (std::uint32_t i = blocks.firstRange[group]; i < blocks.firstRange[group + 1]; ++i) {
        const CorrectiveBlocks::Range& range = blocks.ranges[i];
        const std::size_t modes = blocks.joints[range.joint].modes;
        const std::size_t first = skin.reach.size();
        skin.corrections.push_back({range.joint, first});
        skin.reach.resize(first + modes * patches.size(), 0.0f);
        for (std::size_t patch = 0; patch < patches.size(); ++patch)
            for (const std::uint32_t row : patches[patch])
                if (const CorrectiveRow* block = blocks.blockOf(range, row))
                    for (std::size_t k = 0; k < modes; ++k) {
                        float& reach = skin.reach[first + k * patches.size() + patch];
                        reach = std::max(reach, lengthOf(block, k, row % kBlock));
                    }
    }
    run.correctionCount = static_cast<std::uint32_t>(skin.corrections.size()) - run.firstCorrection;
}

float extentOf(const std::vector<glm::vec3>& points) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(-std::numeric_limits<float>::max());
    for (const glm::vec3& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 d = high - low;
    return std::max({d.x, d.y, d.z, std::numeric_limits<float>::min()});
}

/// A skin of more groups than kMost has more patches than that, however coarse they are.
constexpr int kMostAttempts = 30;

/// Cuts one group of a model into patches.
class GroupCut {
public:
    GroupCut(const SkinModel& model, const SkinModel::Group& group, Fineness fineness)
        : _model(model), _group(group), _fineness(fineness) {
        for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i)
            if (model.links()[i].partial) _joints.push_back(model.links()[i].joint);
        _reach.resize(std::size_t(group.vertexCount) * _joints.size());
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) findReach(row);
    }

    /// Adds the patches to `skin` and what they are made of to the other three.
    void cut(BoundsProxy& skin, Binding& binding, std::vector<glm::vec3>& centres,
             std::vector<glm::vec3>& normals) const {
        const std::size_t first = skin.across.size();
        std::vector<Rows> patches;
        std::vector<Rows> open(1);
        for (std::uint32_t row = 0; row < _group.vertexCount; ++row) open[0].push_back(row);
        while (!open.empty()) {
            Rows rows = std::move(open.back());
            open.pop_back();
            Rows other;
            if (split(rows, other)) {
                open.push_back(std::move(rows));
                open.push_back(std::move(other));
                continue;
            }
            addPatch(rows, skin, centres, normals);
            bind(rows, binding);
            patches.push_back(std::move(rows));
        }
        skin.runs.push_back({static_cast<std::uint32_t>(first),
                             static_cast<std::uint32_t>(patches.size()),
                             static_cast<std::uint32_t>(skin.joints.size()),
                             static_cast<std::uint32_t>(_joints.size()), skin.slack.size(), 0, 0});
        skin.joints.insert(skin.joints.end(), _joints.begin(), _joints.end());
        for (std::size_t k = 0; k < _joints.size(); ++k) addSlack(patches, k, skin);
        if (SkinModelAccess::correctives(_model))
            addCorrectiveReach(*SkinModelAccess::correctives(_model), patches, skin);
    }

private:
    const glm::vec3& position(std::uint32_t row) const {
        return _model.positions()[_model.order()[_group.firstVertex + row]];
    }
    const SkinModel::Ratio& ratio(std::uint32_t row, std::size_t k) const {
        return _model.ratios()[_group.firstRatio + row * _group.partialCount + k];
    }

    /// Coordinate `axis` of what a patch should have little of: x, y, z, then each joint's bend and
    /// twist ratio.
    float coordinate(std::uint32_t row, std::size_t axis) const {
        if (axis < 3) return position(row)[static_cast<int>(axis)];
        const SkinModel::Ratio& r = ratio(row, (axis - 3) / 2);
        return (axis - 3) % 2 == 0 ? r.bend : r.twist;
    }

    /// Moves about half of `rows` to `other` where they are too much for one patch.
    bool split(Rows& rows, Rows& other) const {
        std::size_t worst = 0;
        float excess = 1.0f, middle = 0.0f;
        for (std::size_t axis = 0; axis < 3 + 2 * _joints.size(); ++axis) {
            float low = coordinate(rows[0], axis), high = low, farthest = 0.0f;
            for (const std::uint32_t row : rows) {
                low = std::min(low, coordinate(row, axis));
                high = std::max(high, coordinate(row, axis));
                if (axis >= 3) farthest = std::max(farthest, reach(row, (axis - 3) / 2));
            }
            const float is = axis < 3 ? (high - low) / _fineness.length
                                      : 0.5f * (high - low) * farthest / _fineness.stray;
            if (is > excess) {
                excess = is;
                worst = axis;
                middle = 0.5f * (low + high);
            }
        }
        if (excess <= 1.0f) return false;
        const auto from = std::partition(rows.begin(), rows.end(), [&](std::uint32_t row) {
            return coordinate(row, worst) <= middle;
        });
        other.assign(from, rows.end());
        rows.erase(from, rows.end());
        return !other.empty() && !rows.empty();
    }

    /// How far from each partial joint's centre the vertex can get before that joint turns it: the
    /// rotations of the joints applied earlier (deeper ones) keep its distance from their own
    /// centres.
    void findReach(std::uint32_t row) {
        glm::vec3 from = position(row);
        float distance = 0.0f;
        std::size_t k = (std::size_t(row) + 1) * _joints.size();
        for (std::uint32_t i = _group.firstLink + _group.linkCount; i-- > _group.firstLink;) {
            const SkinModel::Link& link = _model.links()[i];
            const glm::vec3 centre(_model.joints()[link.joint].centre);
            distance += glm::length(centre - from);
            from = centre;
            if (link.partial) _reach[--k] = distance;
        }
    }
    float reach(std::uint32_t row, std::size_t k) const {
        return _reach[std::size_t(row) * _joints.size() + k];
    }

    /// Halfway between the least and the largest ratios.
    Ratios middleRatios(const Rows& rows) const {
        Ratios middle{};
        for (std::size_t k = 0; k < _joints.size(); ++k) {
            SkinModel::Ratio low = ratio(rows[0], k), high = low;
            for (const std::uint32_t row : rows) {
                low = {std::min(low.bend, ratio(row, k).bend),
                       std::min(low.twist, ratio(row, k).twist)};
                high = {std::max(high.bend, ratio(row, k).bend),
                        std::max(high.twist, ratio(row, k).twist)};
            }
            middle[k] = {0.5f * (low.bend + high.bend), 0.5f * (low.twist + high.twist)};
        }
        return middle;
    }

    void addPatch(const Rows& rows, BoundsProxy& skin, std::vector<glm::vec3>& centres,
                  std::vector<glm::vec3>& normals) const {
        glm::vec3 low(std::numeric_limits<float>::max()), high(-low), normal(0.0f);
        for (const std::uint32_t row : rows) {
            low = glm::min(low, position(row));
            high = glm::max(high, position(row));
            normal += _model.normals()[_model.order()[_group.firstVertex + row]];
        }
        const float length = glm::length(normal);
        normal = length > 1e-6f ? normal / length : glm::vec3(0, 1, 0);
        glm::vec3 centre = 0.5f * (low + high);
        float least = std::numeric_limits<float>::max(), most = -least;
        for (const std::uint32_t row : rows) {
            const float height = glm::dot(position(row) - centre, normal);
            least = std::min(least, height);
            most = std::max(most, height);
        }
        centre += 0.5f * (least + most) * normal;
        float across = 0.0f;
        for (const std::uint32_t row : rows)
            across = std::max(across, glm::length(glm::cross(position(row) - centre, normal)));
        skin.across.push_back(across);
        skin.along.push_back(0.5f * (most - least));
        centres.push_back(centre);
        normals.push_back(normal);
    }

    void addSlack(const std::vector<Rows>& patches, std::size_t k, BoundsProxy& skin) const {
        const std::size_t first = skin.slack.size();
        const std::size_t count = patches.size();
        skin.slack.resize(first + BoundsProxy::SlackKinds * count, 0.0f);
        for (std::size_t patch = 0; patch < count; ++patch) {
            const SkinModel::Ratio middle = middleRatios(patches[patch])[k];
            const auto raise = [&](BoundsProxy::Slack kind, float value) {
                float& slack = skin.slack[first + std::size_t(kind) * count + patch];
                slack = std::max(slack, value);
            };
            for (const std::uint32_t row : patches[patch]) {
                const float bend = std::abs(ratio(row, k).bend - middle.bend);
                const float twist = std::abs(ratio(row, k).twist - middle.twist);
                raise(BoundsProxy::BendReach, bend * reach(row, k));
                raise(BoundsProxy::TwistReach, twist * reach(row, k));
                raise(BoundsProxy::BendSpread, bend);
                raise(BoundsProxy::TwistSpread, twist);
            }
        }
    }

    /// Adds a vertex with the patch's ratios.
    void bind(const Rows& rows, Binding& binding) const {
        const Ratios middle = middleRatios(rows);
        std::size_t k = 0;
        for (std::uint32_t i = _group.firstLink; i < _group.firstLink + _group.linkCount; ++i) {
            const SkinModel::Link& link = _model.links()[i];
            const SkinModel::Ratio r = link.partial ? middle[k++] : SkinModel::Ratio{1.0f, 1.0f};
            binding.influences.push_back({link.joint, r.bend, r.twist});
        }
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        binding.regions.push_back(0);
    }

    const SkinModel& _model;
    const SkinModel::Group& _group;
    Fineness _fineness;
    std::vector<std::uint32_t> _joints; ///< the partial links', outermost first
    std::vector<float> _reach;          ///< [row * partial links + partial link]
};

} // namespace

std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model) {
    if (model.vertexCount() == 0) return nullptr;
    const float extent = extentOf(model.positions());
    // Finer patches give tighter bounds and cost more.
    Fineness fineness{extent / 24.0f, extent / 90.0f};
    for (int attempt = 0;; ++attempt) {
        const std::shared_ptr<BoundsProxy> skin = std::make_shared<BoundsProxy>();
        Binding binding;
        binding.joints = model.joints();
        binding.firstInfluence.push_back(0);
        std::vector<glm::vec3> centres, normals;
        for (const SkinModel::Group& group : model.groups())
            GroupCut(model, group, fineness).cut(*skin, binding, centres, normals);
        if (centres.size() > BoundsProxy::kMost && attempt < kMostAttempts) {
            fineness.length *= 1.25f;
            fineness.stray *= 1.25f;
            continue;
        }
        std::vector<std::uint32_t> source(centres.size());
        std::iota(source.begin(), source.end(), 0u);
        skin->centres = SkinModelAccess::arrange(VertexGroups(binding, std::move(source)),
                                                 std::move(centres), std::move(normals));
        skin->rounding = 1e-6f * extent;
        return skin;
    }
}

} // namespace osgSkin
