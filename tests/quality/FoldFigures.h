// SPDX-License-Identifier: MIT
#pragma once

#include "PoseFigures.h"
#include "SkinFigures.h"

#include <ostream>

namespace quality {

/// One limb folded alone, both sides of the body, by each way to deform it.
struct FoldFigure {
    /// What is compared: the peers, ours without shapes, and ours with them.
    enum Way { Linear, DualQuaternion, Plain, Shaped, Ways };

    std::string limb;     ///< "elbow" or "knee"
    double flexion = 0.0; ///< degrees from the straight limb
    /// 98th percentile of distance to the nearest of the limb's two posed bones over that at rest,
    /// of the skin within four limb radii of the joint that the painted weights give to the two.
    /// The worse side.
    std::array<double, Ways> bulge{};
    /// Of the same vertices; the worse side of each.
    std::array<NormalError, Ways> normals{};
    std::array<std::size_t, Ways> pairs{}; ///< see SelfIntersections, of both sides together
};

/// Ours without shapes against ours with them over the poses.
struct ShapedClips {
    PoseFigures plain, shaped;
    /// Poses in which pairs of triangles that cut each other are more by over 2 % and 2, by name,
    /// and how many the pairs are with shapes and without.
    std::vector<std::string> worsePoses;
};

/// What shapes do to a body.
struct ShapeFigures {
    std::string shapes; ///< "fast" or "elastic"
    std::vector<FoldFigure> folds;
    ShapedClips clips;
    double bytesPerVertex = 0.0; ///< that the correctives' vectors take, in the mean
    double seconds = 0.0;        ///< that they add to the binding
    Sweep steps;                 ///< of the joints that are shaped, see measureShapedBends()
};

/// Binds the subject, which bind() has bound, with shapes beside its own binding.
/// \param shapes "fast" or "elastic"
ShapeFigures measureShapes(const Subject& subject, const std::vector<NamedPose>& poses,
                           const std::string& shapes);

void printTable(const ShapeFigures& figures, std::ostream& out);

} // namespace quality
