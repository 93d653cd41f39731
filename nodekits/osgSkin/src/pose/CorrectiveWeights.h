// SPDX-License-Identifier: MIT
#pragma once

#include "model/CorrectiveBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Pose>

#include <array>
#include <cstddef>

namespace osgSkin {

/// CorrectiveJoint::weights() in less time: only the functions that are not 0, with the modes'
/// coefficients side by side.
class WeightTerms {
public:
    /// \param joint valid; must outlive this, as must its table
    /// \param xy its coordinates, not yet clamped
    WeightTerms(const CorrectiveJoint& joint, const CorrectiveTable& table, glm::dvec2 xy) noexcept;

    /// Sums them up.
    ///
    /// \param beta set: as many as the table's stride
    void sum(double* beta) const noexcept;

    static constexpr std::size_t kMax = 22; ///< of CorrectiveJoint::Basis::Round
    struct Term {
        double factor;
        const double* coefficients; ///< of all modes
    };

    std::size_t count = 0;
    std::size_t modes; ///< a multiple of CorrectiveTable::kAtOnce
    std::array<Term, kMax> terms;

private:
    void add(double factor, const double* coefficients) { terms[count++] = {factor, coefficients}; }
};

/// The correctives' weights (beta) in one pose, computed on demand, joint by joint; on the stack.
class CorrectiveWeights {
public:
    /// The factors of each mode's shares.
    struct Weights {
        std::array<float, CorrectiveJoint::kMaxModes> positions;
        std::array<float, CorrectiveJoint::kMaxModes> normals;
    };

    CorrectiveWeights(const SkinModel& model, const Pose& pose) noexcept
        : _model(model), _pose(pose), _blocks(SkinModelAccess::correctives(model)) {}

    /// Whether the model has correctives.
    bool any() const noexcept { return _blocks; }

    /// Null where the correctives of `joint` (Correctives::joints) have no effect in this pose.
    /// \pre any()
    const Weights* of(std::uint32_t joint) noexcept {
        if (_states[joint] == State::Unknown) workOut(joint);
        return _known[joint];
    }

    /// Computes all that the groups from `firstGroup` to before `endGroup` need.
    /// \pre any()
    void workOut(std::size_t firstGroup, std::size_t endGroup) noexcept {
        const std::vector<std::uint32_t>& ranges = _blocks->firstRange;
        for (std::uint32_t i = ranges[firstGroup]; i < ranges[endGroup]; ++i)
            of(_blocks->corrected[i].joint);
    }

    /// The results of of() so far, by joint.
    const Weights* const* known() const noexcept { return _known.data(); }

    std::size_t modesOf(std::uint32_t joint) const noexcept { return _blocks->joints[joint].modes; }

private:
    enum class State : unsigned char { Unknown, Known };

    void workOut(std::uint32_t joint) noexcept;
    glm::dvec2 coordinatesOf(std::uint32_t joint) const noexcept;

    const SkinModel& _model;
    const Pose& _pose;
    const CorrectiveBlocks* _blocks; ///< null without correctives
    std::array<State, Correctives::kMaxJoints> _states{};
    std::array<const Weights*, Correctives::kMaxJoints> _known; ///< where they are
    std::array<Weights, Correctives::kMaxJoints> _weights;
};

} // namespace osgSkin
