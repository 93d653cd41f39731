// SPDX-License-Identifier: MIT
#include "model/BoundsProxy.h"

#include "model/CorrectiveBlocks.h"
#include "model/PieceTerms.h"
#include "model/PieceVertices.h"
#include "model/SkinBlocks.h"
#include "model/SkinModelAccess.h"
#include "model/SkinPieces.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace osgSkin {
namespace {

/// Of a skin, for each of its pieces: else these would cost more than its vertices.
constexpr std::size_t kLeastVertices = 12;

/// Length of the k-th mode's shares in a lane.
float lengthOf(const CorrectiveRow* block, std::size_t mode, std::size_t lane) {
    float sum = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float share = block[3 * mode + axis].lane[lane];
        sum += share * share;
    }
    return std::sqrt(sum);
}

/// How far the modes of correctives take the vertices of a piece, by BoundsProxy::weightOf().
using Reaches = std::map<std::uint32_t, float>;

Reaches reachesOf(const PieceVertices& vertices, const Rows& rows) {
    Reaches result;
    const CorrectiveBlocks* blocks = SkinModelAccess::correctives(vertices.model);
    if (!blocks) return result;
    for (const std::uint32_t row : rows) {
        const std::uint32_t group = vertices.group(row), inGroup = vertices.rowInGroup(row);
        for (std::uint32_t i = blocks->firstRange[group]; i < blocks->firstRange[group + 1]; ++i) {
            const CorrectiveBlocks::Range& range = blocks->ranges[i];
            const CorrectiveRow* block = blocks->blockOf(range, inGroup);
            if (!block) continue;
            for (std::size_t k = 0; k < blocks->joints[range.joint].modes; ++k) {
                const float length = lengthOf(block, k, inGroup % kBlock);
                if (length == 0.0f) continue;
                float& most = result[BoundsProxy::weightOf(range.joint, k)];
                most = std::max(most, length);
            }
        }
    }
    return result;
}

/// A piece on its way into a block.
struct CutPiece {
    SkinPiece cut;
    PieceTerms terms;
    Reaches reaches;

    CutPiece(const PieceVertices& vertices, SkinPiece&& piece)
        : cut(std::move(piece)), terms(vertices, cut), reaches(reachesOf(vertices, cut.rows)) {}

    /// The joints that it moves with.
    std::set<std::uint32_t> joints() const {
        std::set<std::uint32_t> result;
        for (const auto& [joint, share] : terms.jointShares())
            if (share.weight != 0.0f) result.insert(joint);
        return result;
    }
};

using CutPieces = std::vector<std::unique_ptr<CutPiece>>;

/// Puts pieces into an order in which those of a block move with few joints altogether: what a
/// block takes grows with these. One with many joints begins, those that add the fewest follow.
void orderByJoints(CutPieces& pieces) {
    std::vector<std::set<std::uint32_t>> joints;
    for (const std::unique_ptr<CutPiece>& piece : pieces) joints.push_back(piece->joints());
    std::set<std::uint32_t> block;
    const auto added = [&](const std::set<std::uint32_t>& by) {
        return std::count_if(by.begin(), by.end(), [&](auto j) { return block.count(j) == 0; });
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (i % BoundsProxy::kAtOnce == 0) block.clear();
        std::size_t next = i;
        for (std::size_t k = i + 1; k < pieces.size(); ++k) {
            const auto more = block.empty() ? 0 : added(joints[k]) - added(joints[next]);
            if (more < 0 || (more == 0 && joints[k].size() > joints[next].size())) next = k;
        }
        std::swap(pieces[i], pieces[next]);
        std::swap(joints[i], joints[next]);
        block.insert(joints[i].begin(), joints[i].end());
    }
}

/// Adds `count` pieces, from the proxy's piece `first` on, as a block.
void addBlock(const std::unique_ptr<CutPiece>* pieces, std::size_t count, std::size_t first,
              BoundsProxy& proxy) {
    BoundsProxy::Block block{};
    block.firstPiece = static_cast<std::uint32_t>(first);
    block.pieceCount = static_cast<std::uint32_t>(count);
    std::map<std::uint32_t, BoundsProxy::Share> shares;
    std::map<std::uint32_t, BoundsProxy::Reach> reaches;
    for (std::size_t lane = 0; lane < BoundsProxy::kAtOnce; ++lane) {
        const std::size_t i = lane < count ? lane : 0;
        const BoundsProxy::Piece& piece = proxy.pieces[first + i];
        for (int axis = 0; axis < 3; ++axis) {
            block.centre[axis].lane[lane] = piece.centre[axis];
            for (int side = 0; side < 3; ++side)
                block.axes[side][axis].lane[lane] = piece.axes[side][axis];
        }
        for (const auto& [weight, length] : pieces[i]->reaches) {
            BoundsProxy::Reach& reach = reaches[weight];
            reach.weight = weight;
            reach.length.lane[lane] = length;
        }
        for (const auto& [joint, of] : pieces[i]->terms.jointShares()) {
            BoundsProxy::Share& share = shares[joint];
            share.joint = joint;
            share.weight.lane[lane] = of.weight;
            share.bend.lane[lane] = of.bend;
            share.twist.lane[lane] = of.twist;
            share.square.lane[lane] = of.square;
        }
    }
    block.firstShare = static_cast<std::uint32_t>(proxy.shares.size());
    for (const bool weighted : {true, false}) {
        for (const auto& [joint, share] : shares) {
            const float* weights = share.weight.lane;
            const bool any = std::any_of(weights, weights + BoundsProxy::kAtOnce,
                                         [](float weight) { return weight != 0.0f; });
            if (any == weighted) proxy.shares.push_back(share);
        }
        const auto now = static_cast<std::uint32_t>(proxy.shares.size()) - block.firstShare;
        (weighted ? block.weighted : block.shareCount) = now;
    }
    block.firstReach = static_cast<std::uint32_t>(proxy.reaches.size());
    block.reachCount = static_cast<std::uint32_t>(reaches.size());
    for (const auto& [weight, reach] : reaches) proxy.reaches.push_back(reach);
    proxy.blocks.push_back(block);
}

void addJoints(const SkinModel& model, BoundsProxy& proxy) {
    for (const BoundJoint& joint : model.joints()) {
        const glm::dmat3 frame = jointFrame(joint);
        proxy.joints.push_back({four(glm::vec3(joint.centre)), four(glm::vec3(frame[2])),
                                four(glm::vec3(frame[0])), four(glm::vec3(frame[1])), joint.parent,
                                false});
    }
    for (const BoundsProxy::Piece& piece : proxy.pieces) proxy.joints[piece.anchor].isNeeded = true;
    for (const BoundsProxy::Term& term : proxy.terms) proxy.joints[term.joint].isNeeded = true;
    for (const BoundsProxy::Share& share : proxy.shares) proxy.joints[share.joint].isNeeded = true;
    for (std::size_t j = proxy.joints.size(); j-- > 0;)
        if (proxy.joints[j].isNeeded && proxy.joints[j].parent >= 0)
            proxy.joints[static_cast<std::size_t>(proxy.joints[j].parent)].isNeeded = true;
}

} // namespace

std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model) {
    if (model.vertexCount() == 0) return nullptr;
    glm::vec3 low = model.positions().front(), high = low;
    for (const glm::vec3& p : model.positions()) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low, far = glm::max(glm::abs(low), glm::abs(high));
    const float extent = std::max({size.x, size.y, size.z});
    const std::shared_ptr<BoundsProxy> proxy = std::make_shared<BoundsProxy>();
    const float largest =
        std::max({extent, far.x, far.y, far.z, std::numeric_limits<float>::min()});
    proxy->noTravel = 2e-6f * largest;
    proxy->rounding = 1.5e-5f * largest;
    const PieceVertices vertices(model);
    CutPieces pieces;
    for (SkinPiece& piece : cutSkin(
             vertices, extent, std::min(BoundsProxy::kMost, model.vertexCount() / kLeastVertices)))
        pieces.push_back(std::make_unique<CutPiece>(vertices, std::move(piece)));
    orderByJoints(pieces);
    for (const std::unique_ptr<CutPiece>& from : pieces) {
        BoundsProxy::Piece piece{};
        piece.centre = four(from->cut.shape.centre);
        for (int side = 0; side < 3; ++side) piece.axes[side] = four(from->cut.shape.axes[side]);
        from->terms.addTo(*proxy, piece);
        proxy->pieces.push_back(piece);
    }
    for (std::size_t first = 0; first < pieces.size(); first += BoundsProxy::kAtOnce)
        addBlock(&pieces[first], std::min(BoundsProxy::kAtOnce, pieces.size() - first), first,
                 *proxy);
    addJoints(model, *proxy);
    return proxy;
}

} // namespace osgSkin
