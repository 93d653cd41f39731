// SPDX-License-Identifier: MIT
#pragma once

#include "correctives/CorrectiveWeights.h"
#include "deform/DeformKernel.h"

namespace osgSkin {

/// Tells the kernel which of a group's blocks are to be corrected, and by how much, in one pose;
/// on the stack.
class KernelCorrections {
public:
    KernelCorrections(const SkinModel& model, const Pose& pose) noexcept
        : _model(model), _weights(model, pose) {}

    /// Whether the model has correctives.
    bool any() const noexcept { return _weights.any(); }

    /// Sets the corrections of `call`; they are good until the next call.
    ///
    /// \pre any()
    /// \param group an index
    /// \param firstBlock of the group's, with which the call begins
    /// \param call changed
    void prepare(std::size_t group, std::size_t firstBlock, KernelCall& call) noexcept;

private:
    const SkinModel& _model;
    CorrectiveWeights _weights;
};

} // namespace osgSkin
