// SPDX-License-Identifier: MIT
#pragma once

#include "../PaintedBody.h"

#include <functional>
#include <string>
#include <vector>

namespace quality {

/// A body that nobody has: made of the two that there are.
struct Variation {
    std::string name;
    bool heldOut = false; ///< of the half that no setting may be chosen by
    std::function<PaintedBody()> make;
};

/// Variations of two bodies of one topology: between and beyond them, thinner and thicker, of other
/// proportions, in other rest poses, aged. Every second one is held out.
/// \param neutral one of the bodies; the variations refer to both
/// \param male the other
std::vector<Variation> variations(const PaintedBody& neutral, const PaintedBody& male);

} // namespace quality
