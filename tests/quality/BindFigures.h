// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

namespace quality {

/// What the binding itself is like.
struct BindFigures {
    /// Share of the vertices whose region is more than one joint away from the painted weights'
    /// dominant joint. Joints below a rigid one, and joints of no length, count as the one above.
    double farRegions = 0.0;
    double meanInfluences = 0.0; ///< joints that a vertex follows in part
    std::size_t mostInfluences = 0;
    double cappedShare = 0.0; ///< of the vertices
    double seconds = 0.0;
};

BindFigures measureBinding(const Subject& subject);

} // namespace quality
