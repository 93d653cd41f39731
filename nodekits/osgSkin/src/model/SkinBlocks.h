// SPDX-License-Identifier: MIT
#pragma once

#include "model/ChainPlan.h"

#include <osgSkin/SkinModel>

#include <glm/mat3x3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Vertices a block holds; a multiple of every vector's number of floats.
constexpr std::size_t kBlock = 16;

/// One number of each vertex of a block.
struct alignas(64) BlockRow {
    float lane[kBlock];
};

/// A SkinModel's vertices as the kernel reads them: structure of arrays, group after group, each
/// group padded to whole blocks with zeros.
///
/// A block is rowsPerBlock(n) rows for n partial links: position x, y, z, normal x, y, z, then the
/// bend and twist ratio of each partial link, innermost (applied first) first. Where a group's
/// innermost link is a partial one, positions and normals are in that joint's fixed frame
/// (jointFrame()), which spares the kernel the change of frame; else in rest space.
struct SkinBlocks {
    /// A group as the kernel reads it: side by side, since an update finds none of it in the
    /// processor's nearest cache.
    struct Group {
        std::size_t firstRow; ///< of its first block, in `rows`
        std::uint32_t firstBlock;
        std::uint32_t firstVertex; ///< in the model's order()
        std::uint32_t vertexCount;
        std::uint32_t firstLink; ///< in the plan's links
        std::uint32_t frame;     ///< the joint that its blocks are in the frame of, or kRestFrame
        ChainPlan::Index lead;   ///< ChainPlan::Group's
        std::uint16_t linkCount; ///< partial ones
    };
    static constexpr std::uint32_t kRestFrame = ~0u;

    explicit SkinBlocks(const SkinModel& model);

    static std::size_t rowsPerBlock(std::size_t partialCount) { return 6 + 2 * partialCount; }

    /// SkinTangents has blocks of its own: x, y, z in the same frame, and the handedness.
    static constexpr std::size_t kTangentRows = 4;

    ChainPlan plan;
    std::vector<BlockRow> rows;
    std::vector<Group> groups;                 ///< the model's
    std::vector<std::size_t> firstBlock = {0}; ///< of each group; then the number of all blocks
    std::vector<glm::dmat3> jointFrames;       ///< jointFrame() of each joint
    bool inOrder; ///< the model's order() is the identity: output needs no scatter
    /// A joint's translation up to this is a rounding error: bones' offsets are single precision in
    /// most files and in osgAnimation, their bind matrices need not be.
    double smallMove;
};

/// True where the group's innermost link is partial, so that its blocks are in a joint's frame.
inline bool isInJointFrame(const SkinModel& model, const SkinModel::Group& group) {
    return group.linkCount > 0 && model.links()[group.firstLink + group.linkCount - 1].partial;
}

/// e1, e2, w: any two directions that make a right-handed frame with the twist axis w.
glm::dmat3 jointFrame(const BoundJoint& joint);

/// The axes, in rest space and as columns, of the frame that a group's blocks are in.
glm::dmat3 restFrame(const SkinModel& model, const SkinModel::Group& group);

} // namespace osgSkin
