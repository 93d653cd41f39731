// SPDX-License-Identifier: MIT
#pragma once

#include "deform/DeformKernel.h"
#include "deform/LinkTilts.h"

#include <osgSkin/SkinModel>

#include <cstddef>

namespace osgSkin {

/// Tells the kernel which of a group's links tilt its normals in one pose; on the stack. Of a model
/// that has gradients.
class KernelSlopes {
public:
    explicit KernelSlopes(const SkinModel& model) noexcept;

    /// Takes what the joints of a section do.
    ///
    /// \param joints of the section; they outlive this
    /// \param jointCount of them
    /// \param endGroup prepare() is not called for this group
    /// \param call changed
    void take(const KernelJoints& joints, std::size_t jointCount, std::size_t endGroup,
              KernelCall& call) noexcept;

    /// Sets what `call` has of gradients; it is good until the next take().
    ///
    /// \param group an index, in the section
    /// \param firstBlock of the group's, with which the call begins
    /// \param block the same of the model's
    /// \param call has its links already; changed
    void prepare(std::size_t group, std::size_t firstBlock, std::size_t block,
                 KernelCall& call) noexcept;

private:
    void findTilts(std::size_t first) noexcept;

    const SkinModel& _model;
    const KernelLink* _links;      ///< of the plan
    const GradientBlocks* _blocks; ///< null where the model has none
    const KernelJoints* _joints;
    std::size_t _endOfAll;            ///< links that prepare() is called for
    std::size_t _firstLink, _endLink; ///< of which are known
    LinkTilts _tilts;                 ///< from the first of them on
    float _bendSlopes[KernelJoints::kMost], _twistSlopes[KernelJoints::kMost];
};

} // namespace osgSkin
