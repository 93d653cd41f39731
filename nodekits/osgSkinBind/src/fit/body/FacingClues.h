// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_BODY_FACINGCLUES_H
#define OSGSKINBIND_FIT_BODY_FACINGCLUES_H

#include "fit/body/BodyBranches.h"
#include "fit/body/BodySurface.h"

#include <string>

namespace osgSkin {

/// How far forward (+z) a standing body seems to face, in heights; negative where it faces -z.
struct FacingClues {
    double feet = 0.0;   ///< toes ahead of the ankles
    double head = 0.0;   ///< face overhanging the neck
    double elbows = 0.0; ///< elbows behind the line from shoulder to hand
    double sum() const { return feet + head + elbows; }
    std::string strongest() const; ///< "from the feet", "from the face" or "from the elbows"
};

FacingClues facingClues(const BodySurface& surface, const BodyBranches& branches);

} // namespace osgSkin

#endif
