// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_SHAPEFIT_H
#define OSGSKINBINDER_CORRECTIVES_SHAPEFIT_H

#include <osgSkin/Correctives>

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

class CoarseGraph;
struct ShapedJoint;

/// Wanted offsets of rest vertices at samples of one joint's bends: what fitShapes() fits.
struct JointShapes {
    CorrectiveJoint functions;           ///< all but modes and coefficients
    std::vector<std::uint32_t> vertices; ///< welded ones
    std::vector<glm::dvec2> samples;     ///< (x, y) of each bend
    /// For each sample and vertex, rest space. The rest pose, at which they are 0, is no sample.
    /// For a vertex x that the bend rotates by q about c and its target y: conjugate(q) (y - c) + c
    /// - x.
    std::vector<std::vector<glm::dvec3>> offsets;
    /// Weights above 0 of the least squares, laid out as `offsets`; empty: all are 1.
    std::vector<std::vector<double>> weights;
};

/// The same as a sum of modes: offset(vertex) = sum over k of beta_k(pose) vectors[vertex][k].
struct FittedShapes {
    CorrectiveJoint functions; ///< complete
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec3> vectors; ///< `modes` of each vertex, side by side; at most 1 long
    double tolerance = 0.0;          ///< negligible displacement
    double residual = 0.0;           ///< RMS error over samples and vertices, rest units
};

/// Limits the number of modes.
struct ModeLimits {
    std::size_t most = 0;
    double tolerance = 0.0; ///< drops modes that move no vertex by more; above 0
};

/// Fits by damped least squares and keeps the modes that matter most (singular value decomposition;
/// EigenSkin, Kry et al. 2002).
FittedShapes fitShapes(const JointShapes& shapes, const ModeLimits& limits);

/// The shapes of a coarser copy of a joint's skin, interpolated over the joint's own vertices; 0
/// where they do not move.
/// \param shapes of coarserJoint()
FittedShapes finerShapes(FittedShapes shapes, const CoarseGraph& coarser, const ShapedJoint& joint);

/// Packs the joints' shapes into a binding's correctives. Drops joints without modes, and vertices
/// that no bend moves by more than the shapes' tolerance. A vertex' last modes are 0 if together
/// they move it by no more than that.
/// \param weldedOf the welded vertex of each vertex that is bound
Correctives packShapes(const std::vector<FittedShapes>& joints,
                       const std::vector<std::uint32_t>& weldedOf);

/// The sum of two correctives of the same vertices.
/// \pre neither has normal correctives
Correctives mergeCorrectives(const Correctives& a, const Correctives& b);

} // namespace osgSkin

#endif
