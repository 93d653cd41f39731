// SPDX-License-Identifier: MIT
#pragma once

#include "model/CorrectiveBlocks.h"

#include <array>
#include <cstddef>

namespace osgSkin {

/// What the weights of a joint's correctives are sums of: the functions that are not 0 where it is,
/// CorrectiveJoint::weights() in less time. Splines reach over few knots, and coefficients of modes
/// stand side by side.
class WeightTerms {
public:
    /// \param joint a valid one; outlives this, as its table does
    /// \param table the joint's
    /// \param xy its coordinates, not clamped yet
    WeightTerms(const CorrectiveJoint& joint, const CorrectiveTable& table, glm::dvec2 xy) noexcept;

    /// Sums them up, by the best instructions that the machine has.
    ///
    /// \param beta set; the table's stride of them
    void sum(double* beta) const noexcept;

    static constexpr std::size_t kMost = 22; ///< of CorrectiveJoint::Basis::Round
    struct Term {
        double factor;
        const double* coefficients; ///< of all modes
    };

    std::size_t count = 0;
    std::size_t modes; ///< a multiple of CorrectiveTable::kAtOnce
    std::array<Term, kMost> terms;

private:
    void add(double factor, const double* coefficients) { terms[count++] = {factor, coefficients}; }
};

} // namespace osgSkin
