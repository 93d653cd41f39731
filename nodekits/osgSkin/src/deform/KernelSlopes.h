// SPDX-License-Identifier: MIT
#pragma once

#include "deform/DeformKernel.h"

#include <osgSkin/SkinModel>

#include <array>

namespace osgSkin {

/// Tells the kernel which of a group's links tilt its normals in one pose; on the stack. Of a model
/// that has gradients.
class KernelSlopes {
public:
    explicit KernelSlopes(const SkinModel& model) noexcept : _model(model) {}

    /// Takes what the joints of a section do; before its groups.
    ///
    /// \param joints of the section
    /// \param count of them
    void take(const KernelJoints& joints, std::size_t count) noexcept;

    /// Sets what `call` has of gradients; it is good until the next call.
    ///
    /// \param group an index
    /// \param firstBlock of the group's, with which the call begins
    /// \param call has its links already; changed
    void prepare(std::size_t group, std::size_t firstBlock, KernelCall& call) noexcept;

private:
    struct Angles {
        double bend, twist;          ///< psi, phi
        float bendSlope, twistSlope; ///< KernelSlope's
    };

    const SkinModel& _model;
    std::array<Angles, KernelJoints::kMost> _angles;
    std::array<KernelSlope, SkinModel::kMaxPartialInfluences> _slopes;
};

} // namespace osgSkin
