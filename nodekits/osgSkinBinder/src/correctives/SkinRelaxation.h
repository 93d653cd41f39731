// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_SKINRELAXATION_H
#define OSGSKINBINDER_CORRECTIVES_SKINRELAXATION_H

#include "correctives/ShapedJoint.h"

#include <Eigen/SparseCore>
#include <glm/gtc/quaternion.hpp>

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
    /// \param turns the rotation of each vertex, ShapedJoint::turnsOf()
    std::vector<glm::dvec3> relaxed(std::vector<glm::dvec3> points,
                                    const std::vector<glm::dquat>& turns) const;

    /// A field of vectors over the joint's skin, smoothed; itself if the joint has no relaxation.
    std::vector<glm::dvec3> smoothed(std::vector<glm::dvec3> field) const;

private:
    using Fours = std::vector<Eigen::Array4f>; ///< of each vertex: a point and another value

    Fours smooth(const std::vector<glm::dvec3>& points, const Eigen::VectorXd& values) const;
    /// Of the triangles around each vertex, times 2.
    Eigen::VectorXd areasOf(const std::vector<glm::dvec3>& points) const;

    const ShapedJoint& _joint;
    // One step's matrix is P' L D L' P. In single precision, and by fours, it is solved in a
    // quarter of the time.
    Eigen::SparseMatrix<float> _lower; ///< L without its diagonal of ones
    Eigen::VectorXi _row;              ///< P: the row of each vertex
    Eigen::VectorXf _mass, _inverse;   ///< of each row; `_inverse` of D
    std::vector<glm::dvec3> _smoothedAtRest;
    Eigen::VectorXd _areasAtRest;
    bool _isOn = false;
};

} // namespace osgSkin

#endif
