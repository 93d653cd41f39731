// SPDX-License-Identifier: MIT
#pragma once

#include "model/BoundsProxy.h"
#include "model/PieceVertices.h"
#include "model/SkinPieces.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace osgSkin {

/// Writes down what the pose does to a piece, and how far its vertices may stray from it.
class PieceTerms {
public:
    /// What the piece has of one joint when it is blended; see BoundsProxy::Share.
    struct Share {
        float weight = 0.0f, bend = 0.0f, twist = 0.0f, square = 0.0f;
    };

    /// Both must outlive this.
    PieceTerms(const PieceVertices& vertices, const SkinPiece& piece);

    void addTo(BoundsProxy& proxy, BoundsProxy::Piece& piece) const;

    const std::map<std::uint32_t, Share>& jointShares() const { return _shares; }

private:
    std::map<std::uint32_t, Share> shares();
    std::size_t placeOf(int joint) const;
    void lookAtVertices();
    void addStrays(std::size_t k, const std::vector<float>& ratios, std::vector<Share>& all) const;
    void limitFar(const std::vector<float>& ratios);
    BoundsProxy::Term termOf(std::size_t k) const;
    const SkinModel::Ratio* ratiosOf(std::size_t row) const {
        return _ratios.data() + row * _ranges.size();
    }
    const float* farOf(std::size_t row) const { return _far.data() + row * _ranges.size(); }

    const PieceVertices& _vertices;
    const std::vector<BoundJoint>& _joints;
    const Rows& _rows;
    std::vector<PieceRatios> _ranges;
    std::vector<std::size_t> _above;       ///< by range: the place of the joint's parent
    std::size_t _anchor = 0, _first = 1;   ///< the first one that any vertex does not follow wholly
    std::vector<SkinModel::Ratio> _ratios; ///< by vertex, then by range
    std::vector<float> _far; ///< the same: from a joint's centre, whatever is done before it
    std::vector<BoundsProxy::Term> _terms;
    std::map<std::uint32_t, Share> _shares;
};

} // namespace osgSkin
