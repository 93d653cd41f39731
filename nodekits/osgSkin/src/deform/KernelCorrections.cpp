// SPDX-License-Identifier: MIT
#include "deform/KernelCorrections.h"

#include "model/SkinModelAccess.h"

#include <cstring>

namespace osgSkin {

void KernelCorrections::prepare(std::size_t group, std::size_t firstBlock,
                                KernelCall& call) noexcept {
    const CorrectiveBlocks& blocks = *SkinModelAccess::correctives(_model);
    call.correctionCount = 0;
    for (std::uint32_t i = blocks.firstRange[group]; i < blocks.firstRange[group + 1]; ++i) {
        const CorrectiveBlocks::Range& range = blocks.ranges[i];
        if (range.firstBlock + range.blockCount <= firstBlock) continue;
        const CorrectiveWeights::Weights* weights = _weights.of(range.joint);
        if (!weights) continue;
        KernelCorrection& to = _corrections[call.correctionCount++];
        const std::size_t skipped =
            firstBlock > range.firstBlock ? firstBlock - range.firstBlock : 0;
        to.blockShares = blocks.rowsPerBlock(range.joint) * kBlock;
        to.shares = blocks.rows[range.firstRow].lane + skipped * to.blockShares;
        to.normalShares = blocks.hasNormals
                              ? blocks.normalRows[range.firstRow].lane + skipped * to.blockShares
                              : nullptr;
        to.tilts = nullptr;
        if (!blocks.tilts.empty()) {
            to.tilts =
                blocks.tilts[range.firstTilt + skipped * 2 * blocks.joints[range.joint].modes].lane;
        }
        to.firstBlock = range.firstBlock + skipped - firstBlock;
        to.blockCount = range.blockCount - skipped;
        to.modes = blocks.joints[range.joint].modes;
        to.weights = weights->positions.data();
        to.normalWeights = weights->normals.data();
    }
    call.corrections = _corrections.data();
    call.correctionFrame = nullptr;
    const SkinModel::Group& of = _model.groups()[group];
    if (call.correctionCount == 0 || !isInJointFrame(_model, of)) return;
    const CorrectiveFrame& frame =
        blocks.frames[_model.links()[of.firstLink + of.linkCount - 1].joint];
    std::memcpy(_frame.column, frame.column, sizeof frame.column);
    call.correctionFrame = &_frame;
}

} // namespace osgSkin
