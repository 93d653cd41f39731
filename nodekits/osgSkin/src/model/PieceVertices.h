// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Vertices by their places in a model's order.
using Rows = std::vector<std::uint32_t>;

/// What vertices of one piece have of one joint.
struct PieceRatios {
    std::uint32_t joint;
    float low = 1.0f, high = 0.0f;           ///< bend ratio
    float lowTwist = 1.0f, highTwist = 0.0f; ///< twist ratio

    void add(const SkinModel::Ratio& ratio) {
        low = std::min(low, ratio.bend);
        high = std::max(high, ratio.bend);
        lowTwist = std::min(lowTwist, ratio.twist);
        highTwist = std::max(highTwist, ratio.twist);
    }
    /// Ratios this near to 0 or 1 do not turn a piece.
    static constexpr float kSnapped = 0.15f;
    static constexpr float kNear = 0.03f; ///< the same where pieces are blended

    bool isWhole() const { return low >= 1.0f - kSnapped && lowTwist >= 1.0f - kSnapped; }
    bool isNothing() const { return high <= kSnapped && highTwist <= kSnapped; }
    bool isConstant() const { return low == high && lowTwist == highTwist; }
    /// One ratio for all, bend and twist: bends move vertices further, and where a twist builds up
    /// along a bone nothing bends.
    float snapped() const {
        const float ratio = middle();
        return ratio < kNear ? 0.0f : ratio > 1.0f - kNear ? 1.0f : ratio;
    }
    float middle() const { return 0.5f * (low + high); }
    float middleTwist() const { return 0.5f * (lowTwist + highTwist); }
};

/// A model's vertices in the order of its groups: row i is vertex order()[i].
class PieceVertices {
public:
    explicit PieceVertices(const SkinModel& of)
        : model(of), _places(productPlaces(productOrder(of.joints()))) {
        for (std::uint32_t g = 0; g < model.groups().size(); ++g)
            _group.insert(_group.end(), model.groups()[g].vertexCount, g);
    }
    /// A joint's place in productOrder().
    std::uint32_t place(std::uint32_t joint) const { return _places[joint]; }

    const glm::vec3& position(std::uint32_t row) const {
        return model.positions()[model.order()[row]];
    }
    const glm::vec3& normal(std::uint32_t row) const { return model.normals()[model.order()[row]]; }
    std::uint32_t group(std::uint32_t row) const { return _group[row]; }
    std::uint32_t rowInGroup(std::uint32_t row) const {
        return row - model.groups()[_group[row]].firstVertex;
    }

    /// Calls `each(joint, ratio)` for the joints that a vertex follows, in productOrder().
    template <typename Each>
    void forEachJoint(std::uint32_t row, Each&& each) const {
        const SkinModel::Group& group = model.groups()[_group[row]];
        const SkinModel::Ratio* partial = model.ratios().data() + group.firstRatio +
                                          std::size_t(rowInGroup(row)) * group.partialCount;
        for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i) {
            const SkinModel::Link& link = model.links()[i];
            const SkinModel::Ratio ratio = link.partial ? *partial++ : SkinModel::Ratio{1.0f, 1.0f};
            if (ratio.bend != 0.0f || ratio.twist != 0.0f) each(link.joint, ratio);
        }
    }

    /// What a vertex has of each of these joints, which stand in productOrder().
    void ratiosOf(std::uint32_t row, const std::vector<PieceRatios>& joints,
                  SkinModel::Ratio* result) const {
        std::fill(result, result + joints.size(), SkinModel::Ratio{0.0f, 0.0f});
        std::size_t at = 0;
        forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
            while (at < joints.size() && place(joints[at].joint) < place(joint)) ++at;
            if (at < joints.size() && joints[at].joint == joint) result[at] = ratio;
        });
    }

    /// The joints that any of the vertices follows, in productOrder().
    /// \param rows of the vertices
    std::vector<PieceRatios> ranges(const Rows& rows) const {
        std::vector<PieceRatios> result;
        std::vector<std::uint32_t> followers;
        for (const std::uint32_t row : rows) {
            std::size_t at = 0;
            forEachJoint(row, [&](std::uint32_t joint, const SkinModel::Ratio& ratio) {
                while (at < result.size() && place(result[at].joint) < place(joint)) ++at;
                if (at == result.size() || result[at].joint != joint) {
                    result.insert(result.begin() + static_cast<std::ptrdiff_t>(at),
                                  PieceRatios{joint});
                    followers.insert(followers.begin() + static_cast<std::ptrdiff_t>(at), 0u);
                }
                result[at].add(ratio);
                ++followers[at];
            });
        }
        for (std::size_t i = 0; i < result.size(); ++i)
            if (followers[i] < rows.size()) result[i].add({0.0f, 0.0f});
        return result;
    }

    const SkinModel& model;

private:
    std::vector<std::uint32_t> _places; ///< of each joint
    std::vector<std::uint32_t> _group;  ///< of each row
};

inline float fromTwistAxis(const BoundJoint& joint, const glm::vec3& point) {
    const glm::vec3 from = point - glm::vec3(joint.centre);
    return glm::length(glm::cross(from, glm::vec3(joint.twistAxis)));
}
inline float fromCentre(const BoundJoint& joint, const glm::vec3& point) {
    return glm::distance(glm::vec3(joint.centre), point);
}

} // namespace osgSkin
