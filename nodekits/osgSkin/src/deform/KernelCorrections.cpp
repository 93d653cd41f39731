// SPDX-License-Identifier: MIT
#include "deform/KernelCorrections.h"

#include "model/SkinModelAccess.h"

namespace osgSkin {

void KernelCorrections::prepare(std::size_t group, std::size_t firstBlock,
                                KernelCall& call) noexcept {
    const CorrectiveBlocks& blocks = *SkinModelAccess::correctives(_model);
    const std::uint32_t first = blocks.firstRange[group], end = blocks.firstRange[group + 1];
    bool any = false;
    for (std::uint32_t i = first; i < end; ++i)
        any |= _weights.of(blocks.corrected[i].joint) != nullptr;
    call.correctionCount = any ? end - first : 0;
    if (!any) return;
    call.corrections = blocks.corrected.data() + first;
    call.weights = _weights.known();
    call.firstBlock = firstBlock;
    const SkinModel::Group& of = _model.groups()[group];
    call.correctionFrame =
        isInJointFrame(_model, of)
            ? &blocks.frames[_model.links()[of.firstLink + of.linkCount - 1].joint]
            : nullptr;
}

} // namespace osgSkin
