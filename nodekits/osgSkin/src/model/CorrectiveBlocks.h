// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>

#include <glm/mat2x2.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgSkin {

/// One share of each vertex of a block.
struct alignas(32) CorrectiveRow {
    std::int16_t lane[kBlock];
};

/// A CorrectiveJoint as its weights are summed up: the coefficients of all modes side by side.
struct CorrectiveTable {
    static constexpr std::size_t kAtOnce = 4; ///< modes that are worked out at a time

    /// \param joint valid
    /// \param bound the binding's joints
    CorrectiveTable(const CorrectiveJoint& joint, const std::vector<BoundJoint>& bound);

    const double* row(std::size_t function) const { return rows.data() + function * stride; }

    std::size_t stride; ///< the modes, up to a multiple of kAtOnce with zeros
    /// A row for each function, with splines as they are; behind those one of what splines come to
    /// at rest, which is to be taken off.
    std::vector<double> rows;
    std::size_t restRow;
    /// From a bend axis' cosine and sine in the frame of its joint (jointFrame()) to the two
    /// directions that bends are measured along.
    glm::dmat2 toAxes{1.0};
};

/// The correctives of one joint on a range of a group's blocks, as the kernel reads them.
struct CorrectedBlocks {
    const std::int16_t* shares; ///< of the range's first block: x, y, z of the block's vertices for
                                ///< each mode; rest space
    const float* turned; ///< the same in the blocks' frame; null where CorrectiveBlocks keeps none
    const std::int16_t* normalShares; ///< as `shares`, of normals; null where they have none
    const float* tilts; ///< of the range's first block: along u and v for each mode; null where the
                        ///< model has not both normal correctives and gradients
    std::size_t blockShares; ///< from a block's shares to the next one's
    std::size_t firstBlock;  ///< of the group's
    std::size_t blockCount;
    std::uint32_t joint; ///< in CorrectiveBlocks::joints
    std::uint32_t modes;
};

/// A SkinModel's correctives as the kernel reads them, and the only place that a model has them in.
///
/// Vertices of a group stand sorted by the joints whose correctives they follow, so that those of
/// one joint are a range of the group's blocks; of a block's lanes that do not, the shares are 0. A
/// block has three rows (x, y, z; rest space) for each mode. Normal correctives have the same
/// apart, so that who deforms positions alone has no gaps to read over.
///
/// Where a group's blocks are in a joint's frame, and its correctives have few modes, the kernel
/// reads shares that are turned into that frame already, not rounded once more: with one mode it
/// would take as long to turn what it has read as to read it. The others' are turned once they are
/// summed up.
///
/// Where the model has gradients, too, the kernel needs of a normal corrective only what it has
/// along the two directions that those are held by: less to read, and nothing to turn.
struct CorrectiveBlocks {
    /// Modes of a joint whose shares are kept turned, too.
    static constexpr std::size_t kMostTurnedModes = 3;

    struct Range {
        std::uint32_t joint;      ///< in `joints`
        std::uint32_t firstBlock; ///< of the group's
        std::uint32_t blockCount;
        std::size_t firstRow;  ///< in `rows`
        std::size_t firstTilt; ///< in `tilts`
    };

    /// \param model has its gradients already, where it has any
    /// \param binding valid and the model's
    /// \param source as SkinModel::create() takes it
    CorrectiveBlocks(const SkinModel& model, const Binding& binding,
                     const std::vector<std::uint32_t>& source);
    CorrectiveBlocks(const CorrectiveBlocks&) = delete; // it points into itself
    CorrectiveBlocks& operator=(const CorrectiveBlocks&) = delete;

    std::vector<CorrectiveJoint> joints;
    std::vector<CorrectiveTable> tables; ///< of `joints`
    std::vector<KernelMap> frames;       ///< from rest space into each joint's (jointFrame())
    std::vector<std::string> inputs;
    bool hasNormals = false;
    std::vector<Range> ranges;
    std::vector<CorrectedBlocks> corrected; ///< of `ranges`
    std::vector<std::uint32_t> firstRange;  ///< groups + 1, into `ranges`
    /// Of each group: what turns sums of its shares into the frame of its blocks; null where they
    /// are in it, or CorrectedBlocks::turned are.
    std::vector<const KernelMap*> shareFrames;
    std::vector<CorrectiveRow> rows;
    std::vector<BlockRow> turnedRows;      ///< as `rows`, of groups whose shares are kept turned
    std::vector<CorrectiveRow> normalRows; ///< as `rows`; empty without normal correctives

    /// Two rows a block for each mode: its normal correctives along skinDirections()' u and v, in
    /// units of `normalRows`; not rounded to those once more. Empty unless there are both.
    std::vector<BlockRow> tilts;

    std::size_t rowsPerBlock(std::uint32_t joint) const { return 3 * joints[joint].modes; }

    /// The first row of the block in a range that a vertex stands in, null where it stands in none.
    /// \param row of the group's vertices
    const CorrectiveRow* blockOf(const Range& range, std::uint32_t row) const noexcept {
        return rowOf(rows, range, row);
    }
    /// The same of its normal correctives, null without them.
    const CorrectiveRow* normalBlockOf(const Range& range, std::uint32_t row) const noexcept {
        return hasNormals ? rowOf(normalRows, range, row) : nullptr;
    }

private:
    void addCorrected(const SkinModel& model);
    bool keepsTurned(const SkinModel& model, std::size_t group) const;
    void addTurned(const glm::dmat3& frame, const Range& range);
    void addTilts(const SkinModel& model, std::size_t group, const Range& range);

    const CorrectiveRow* rowOf(const std::vector<CorrectiveRow>& of, const Range& range,
                               std::uint32_t row) const noexcept {
        const std::size_t block = row / kBlock;
        if (block < range.firstBlock || block - range.firstBlock >= range.blockCount)
            return nullptr;
        return &of[range.firstRow + (block - range.firstBlock) * rowsPerBlock(range.joint)];
    }
};

/// The values at x, clamped to the knots, of the three quadratic B-splines that are not 0 there.
/// The first and last knots count three times.
///
/// \param knots ascending, at least two
/// \return the index of the first of the three
std::size_t splinesAt(const std::vector<double>& knots, double x, double (&values)[3]) noexcept;

/// The joints whose correctives a bound vertex follows: what vertices of a group are sorted by.
std::vector<std::uint32_t> correctedBy(const Binding& binding, std::uint32_t vertex);

/// What the blocks hold, for the model's vertices in their own order. Entries whose shares are all
/// 0 are left out.
Correctives correctivesOf(const SkinModel& model);

} // namespace osgSkin
