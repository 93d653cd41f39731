// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_HELDVECTORS_H
#define OSGSKINBIND_HELDVECTORS_H

#include "shapes/steps/BendSteps.h"

#include <Eigen/Core>

namespace osgSkin {

/// The nearest vectors of a vertex' modes with which no step takes it farther than it may go.
///
/// Near: over the sampled bends, the shapes that they make are. What is too fast is slowed down
/// where it is, and the shapes before and behind it stay what they are, as far as that can be;
/// less of all shapes would do as well, but would leave less of the deepest ones, too.
class HeldVectors {
public:
    /// \param steps outlive this
    /// \param modes at least 1
    HeldVectors(const ShapedJoint& joint, const BendSteps& steps, std::size_t modes);

    /// \param vectors `modes` of them, changed where steps are too long
    /// \return what is left of the shapes, 0 to 1: 1 less the change, over their size
    double hold(const ShapedJoint::Vertex& vertex, glm::dvec3* vectors) const;

private:
    double sizeOf(const Eigen::MatrixXd& vectors) const;

    const ShapedJoint& _joint;
    const BendSteps& _steps;
    std::size_t _modes;
    Eigen::MatrixXd _gram;    ///< of the modes' weights, over the sampled bends
    Eigen::MatrixXd _inverse; ///< of it
};

} // namespace osgSkin

#endif
