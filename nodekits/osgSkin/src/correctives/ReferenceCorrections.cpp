// SPDX-License-Identifier: MIT
#include "correctives/ReferenceCorrections.h"

namespace osgSkin {

void ReferenceCorrections::apply(std::size_t group, std::uint32_t row, glm::dvec3& position,
                                 glm::dvec3& tilt) noexcept {
    for (std::uint32_t i = _blocks.firstRange[group]; i < _blocks.firstRange[group + 1]; ++i) {
        const CorrectiveBlocks::Range& range = _blocks.ranges[i];
        const CorrectiveRow* from = _blocks.blockOf(range, row);
        if (!from) continue;
        const CorrectiveWeights::Weights* weights = _weights.of(range.joint);
        if (!weights) continue;
        for (std::size_t k = 0; k < _blocks.joints[range.joint].modes; ++k)
            for (int axis = 0; axis < 3; ++axis, ++from)
                position[axis] += double(weights->positions[k]) * double(from->lane[row % kBlock]);
        from = _blocks.normalBlockOf(range, row);
        if (!from) continue;
        for (std::size_t k = 0; k < _blocks.joints[range.joint].modes; ++k)
            for (int axis = 0; axis < 3; ++axis, ++from)
                tilt[axis] += double(weights->normals[k]) * double(from->lane[row % kBlock]);
    }
}

} // namespace osgSkin
