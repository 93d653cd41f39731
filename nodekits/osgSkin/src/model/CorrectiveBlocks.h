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

/// A CorrectiveJoint's coefficients, those of all modes side by side.
struct CorrectiveTable {
    static constexpr std::size_t kAtOnce = 4; ///< modes summed at a time

    /// \param joint valid
    /// \param bound the binding's joints
    CorrectiveTable(const CorrectiveJoint& joint, const std::vector<BoundJoint>& bound);

    const double* row(std::size_t function) const { return rows.data() + function * stride; }

    std::size_t stride; ///< the number of modes, padded to a multiple of kAtOnce
    /// A row for each function, splines without their values at rest subtracted; then a row of what
    /// these add up to, to be subtracted.
    std::vector<double> rows;
    std::size_t restRow;
    /// From a bend axis in jointFrame() to the two axes of CorrectiveJoint.
    glm::dmat2 toAxes{1.0};
};

/// The correctives of one joint on a range of a group's blocks, as the kernel reads them.
struct CorrectedBlocks {
    const std::int16_t* shares; ///< of the range's first block: x, y, z of the block's vertices for
                                ///< each mode; rest space
    const float* turned;        ///< the same in the blocks' frame; may be null
    const std::int16_t* normalShares; ///< as `shares`, of normals; may be null
    const float* tilts; ///< of the range's first block: along u and v for each mode; null where the
                        ///< model has not both normal correctives and gradients
    std::size_t blockShares; ///< distance between two blocks' shares
    std::size_t firstBlock;  ///< of the group's
    std::size_t blockCount;
    std::uint32_t joint; ///< in CorrectiveBlocks::joints
    std::uint32_t modes;
};

/// A SkinModel's correctives as the kernel reads them; the model's only copy.
///
/// A group's vertices are sorted by the joints whose correctives they follow, so that those of a
/// joint are a range of the group's blocks; lanes of other vertices are 0. A block has three rows
/// (x, y, z; rest space) for each mode. Normal correctives are stored separately, for deformations
/// of positions alone.
///
/// Where a group's blocks are in a joint's frame and its correctives have few modes, shares are
/// also kept rotated into that frame, as floats: with one mode, rotating would take as long as
/// reading. Otherwise the sums are rotated.
///
/// Where the model has gradients, the kernel needs only the components of a normal corrective along
/// skinDirections(): less to read, and nothing to rotate.
struct CorrectiveBlocks {
    /// The most modes of a joint whose shares are also kept rotated.
    static constexpr std::size_t kMaxTurnedModes = 3;

    struct Range {
        std::uint32_t joint;      ///< in `joints`
        std::uint32_t firstBlock; ///< of the group's
        std::uint32_t blockCount;
        std::size_t firstRow;  ///< in `rows`
        std::size_t firstTilt; ///< in `tilts`
    };

    /// \param model with its gradients, where it has any
    /// \param binding valid and the model's
    /// \param source as SkinModel::create() takes it
    CorrectiveBlocks(const SkinModel& model, const Binding& binding,
                     const std::vector<std::uint32_t>& source);
    /// The data that files hold.
    struct Stored {
        std::vector<CorrectiveJoint> joints; ///< valid
        std::vector<std::string> inputs;
        bool hasNormals;
        std::vector<Range> ranges;             ///< `joint`, `firstBlock` and `blockCount` count
        std::vector<std::uint32_t> firstRange; ///< groups + 1
        std::vector<CorrectiveRow> rows, normalRows;
    };
    /// Of data from a file.
    ///
    /// \throw osgSkin::Error where it does not fit the model
    CorrectiveBlocks(const SkinModel& model, Stored&& from);
    CorrectiveBlocks(const CorrectiveBlocks&) = delete; // has pointers to its own data
    CorrectiveBlocks& operator=(const CorrectiveBlocks&) = delete;

    std::vector<CorrectiveJoint> joints;
    std::vector<CorrectiveTable> tables; ///< of `joints`
    std::vector<KernelMap> frames;       ///< from rest space into each joint's (jointFrame())
    std::vector<std::string> inputs;
    bool hasNormals = false;
    std::vector<Range> ranges;
    std::vector<CorrectedBlocks> corrected; ///< of `ranges`
    std::vector<std::uint32_t> firstRange;  ///< groups + 1, into `ranges`
    /// Of each group: rotates sums of its shares into the frame of its blocks; null where that is
    /// not needed.
    std::vector<const KernelMap*> shareFrames;
    std::vector<CorrectiveRow> rows;
    std::vector<BlockRow> turnedRows;      ///< as `rows`, of groups whose shares are kept rotated
    std::vector<CorrectiveRow> normalRows; ///< as `rows`; empty without normal correctives

    /// Two rows a block for each mode: normal correctives along skinDirections()' u and v, in units
    /// of `normalRows`. Empty unless the model has both.
    std::vector<BlockRow> tilts;

    std::size_t rowsPerBlock(std::uint32_t joint) const { return 3 * joints[joint].modes; }

    /// The first row of a vertex's block in a range; null where the range does not contain it.
    /// \param row of the vertex in its group
    const CorrectiveRow* blockOf(const Range& range, std::uint32_t row) const noexcept {
        return rowOf(rows, range, row);
    }
    /// The same of normal correctives.
    const CorrectiveRow* normalBlockOf(const Range& range, std::uint32_t row) const noexcept {
        return hasNormals ? rowOf(normalRows, range, row) : nullptr;
    }

private:
    void addTables(const SkinModel& model);
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

/// The joints whose correctives a bound vertex follows; groups are sorted by them.
std::vector<std::uint32_t> correctedBy(const Binding& binding, std::uint32_t vertex);

/// A model's correctives, in the order of its vertices, without entries whose shares are all 0.
Correctives correctivesOf(const SkinModel& model);

} // namespace osgSkin
