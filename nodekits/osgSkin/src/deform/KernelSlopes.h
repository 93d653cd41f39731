// SPDX-License-Identifier: MIT
#pragma once

#include "deform/DeformKernel.h"
#include "deform/LinkTilts.h"

#include <osgSkin/SkinModel>

#include <cstddef>

namespace osgSkin {

/// Tells the kernel which links tilt normals in one pose, and by how much; on the stack. Of a model
/// that has gradients.
class KernelSlopes {
public:
    explicit KernelSlopes(const SkinModel& model) noexcept;

    /// Takes what the joints of a section do.
    ///
    /// \param joints of the section; they outlive this
    /// \param jointCount of them
    /// \param run what it has of slopes is set; good until the next call
    void take(const KernelJoints& joints, std::size_t jointCount, KernelRun& run) noexcept;

    /// Finds the links that tilt normals, of as many groups as there is room for.
    ///
    /// \param firstGroup the first of them, in the section
    /// \param endGroup the one behind the last that is asked for
    /// \param run what it has of tilts is set; good until the next call
    /// \return the group behind the last that was found
    std::size_t find(std::size_t firstGroup, std::size_t endGroup, KernelRun& run) noexcept;

private:
    const SkinModel& _model;
    const GradientBlocks* _blocks; ///< null where the model has none
    const KernelJoints* _joints;
    LinkTilts _tilts;
    float _bendSlopes[KernelJoints::kMost], _twistSlopes[KernelJoints::kMost];
};

} // namespace osgSkin
