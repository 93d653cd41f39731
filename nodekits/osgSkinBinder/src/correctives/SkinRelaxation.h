// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_SKINRELAXATION_H
#define OSGSKINBINDER_CORRECTIVES_SKINRELAXATION_H

#include "correctives/ShapedJoint.h"

#include <Eigen/SparseCholesky>

#include <vector>

namespace osgSkin {

/// Smooths the posed skin of a joint.
///
/// The skin of a soft joint (ShapedJoint::isSoft) is smoothed all over, and gets back the details
/// that smoothing takes from it at rest, rotated like each vertex: delta mush (Mancewicz et al.
/// 2014). The skin of other joints is smoothed where the bend compresses it, and loses its details
/// there, so that creases do not crumple.
///
/// Smoothing is a diffusion of heat over the rest skin, with cotangent weights: it does not depend
/// on the size of triangles.
class SkinRelaxation {
public:
    /// \param joint is kept; without triangles or ShapedJoint::relaxation nothing is smoothed
    explicit SkinRelaxation(const ShapedJoint& joint);

    /// The relaxed points.
    /// \param points of the joint's vertices, posed by the bend, relative to its centre
    std::vector<glm::dvec3> relaxed(std::vector<glm::dvec3> points, const BendTwist& bend) const;

private:
    using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

    Columns smooth(Columns columns) const;
    /// Of the triangles around each vertex, times 2.
    Eigen::VectorXd areasOf(const std::vector<glm::dvec3>& points) const;

    const ShapedJoint& _joint;
    Eigen::VectorXd _mass;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> _solver;
    std::vector<glm::dvec3> _smoothedAtRest;
    Eigen::VectorXd _areasAtRest;
    bool _isOn = false;
};

} // namespace osgSkin

#endif
