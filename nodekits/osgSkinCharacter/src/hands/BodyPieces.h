// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hands/BodySurface.h"
#include "hands/SkinPoints.h"

#include <osgSkin/Binding>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <vector>

namespace osgSkin {

/// An arm that can be turned: joints, and its skin from the elbow on.
struct ArmPiece {
    std::size_t upper = 0; ///< the upper arm's joint
    double length = 0.0;   ///< from there to the wrist
    SkinPoints skin;
};

/// What clearHands() has to do with of a body, at rest.
struct BodyPieces {
    std::vector<BodySurface> surfaces; ///< trunk, head, thighs: as far as there are any
    std::vector<ArmPiece> arms;        ///< left, right: as far as there are any
};

/// Finds pieces by what joints are and which region vertices are in. Helper joints go with the
/// joints that they hang on; chains of them (hair, tails, capes) are no part of the body. Pieces
/// are closed where they were cut from each other.
///
/// \param rest valid
/// \param roles of its joints
/// \param mesh in rest space
/// \param binding of `mesh` to `rest`
BodyPieces findBodyPieces(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
                          const Binding& binding);

} // namespace osgSkin
