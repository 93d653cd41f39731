// SPDX-License-Identifier: MIT
#pragma once

#include "PoseFigures.h"
#include "SkinFigures.h"

#include <ostream>

namespace quality {

/// One limb folded alone, both sides of the body, with each deformation method.
struct FoldFigure {
    /// The compared methods: the peers, ours without shapes, and ours with them.
    enum Way { Linear, DualQuaternion, Plain, Shaped, Ways };

    std::string limb;     ///< "elbow" or "knee"
    double flexion = 0.0; ///< degrees from the straight limb
    /// 98th percentile of the distance to the nearer of the limb's two posed bones over that at
    /// rest, for skin that belongs to the two by painted weights and is within four limb radii of
    /// the joint. The worse side.
    std::array<double, Ways> bulge{};
    /// Of the same vertices; the worse side of each.
    std::array<NormalError, Ways> normals{};
    std::array<std::size_t, Ways> pairs{}; ///< see SelfIntersections, of both sides together
};

/// Ours without shapes compared with ours with them, over the poses.
struct ShapedClips {
    PoseFigures plain, shaped;
    /// Names of the poses in which the self-intersecting pairs increase by more than 2 % and 2, and
    /// the numbers of pairs with shapes and without.
    std::vector<std::string> worsePoses;
};

/// The effect of shapes on a body.
struct ShapeFigures {
    std::vector<FoldFigure> folds;
    ShapedClips clips;
    double bytesPerVertex = 0.0; ///< of the correctives' vectors, mean
    double seconds = 0.0;        ///< added to the time of binding
    Sweep steps;                 ///< of the shaped joints, see measureShapedBends()
};

/// Binds with shapes a subject that bind() has bound, beside its own binding.
/// \param subject bound without shapes
/// \param poses of the clips
ShapeFigures measureShapes(const Subject& subject, const std::vector<NamedPose>& poses);

void printTable(const ShapeFigures& figures, std::ostream& out);

} // namespace quality
