// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SHAPEFIT_H
#define OSGSKINBIND_SHAPEFIT_H

#include <osgSkin/Correctives>

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// What rest vertices are to be moved by so that one joint's bends give the shapes that somebody
/// wants, at some bends: what a maker of shapes hands in, whichever it is.
struct JointShapes {
    CorrectiveJoint functions;           ///< all but modes and coefficients
    std::vector<std::uint32_t> vertices; ///< welded ones
    std::vector<glm::dvec2> samples;     ///< (x, y) of each bend
    /// For each sample, for each vertex; rest space. 0 for every vertex at rest, which is no
    /// sample. For a target y and a vertex x that the bend turns by q about c:
    /// conjugate(q) (y - c) + c - x.
    std::vector<std::vector<glm::dvec3>> offsets;
    /// What it counts that a vertex meets a sample, above 0, laid out as `offsets`; or nothing: all
    /// count alike.
    std::vector<std::vector<double>> weights;
};

/// The same as a sum of modes: offset(vertex) = sum over k of beta_k(pose) vectors[vertex][k].
struct FittedShapes {
    CorrectiveJoint functions; ///< complete
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec3> vectors; ///< `modes` of each vertex, side by side; at most 1 long
    double tolerance = 0.0;          ///< what makes no difference
    double residual = 0.0; ///< RMS over samples and vertices of what is not met; rest units
};

/// How many modes are kept: no more than are worth their bytes.
struct ModeLimits {
    std::size_t most = 0;
    double tolerance = 0.0; ///< modes that move no vertex by more are left out; above 0
    /// Where the modes that are there leave no more of the fit, RMS over samples and vertices, no
    /// more follow: so much in rest units, and so much of what the fit itself leaves of the shapes.
    double enough = 0.0, enoughOfResidual = 0.0;
};

/// Fits by least squares with a little damping, and keeps the modes that matter most (singular
/// value decomposition; EigenSkin, Kry et al. 2002).
FittedShapes fitShapes(const JointShapes& shapes, const ModeLimits& limits);

} // namespace osgSkin

#endif
