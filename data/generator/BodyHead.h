// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The head and neck, in world space.
Sculpture sculptHead();

/// The same without small features, for coarse meshes.
Sculpture sculptPlainHead();

/// Short hair over the whole head; the part above hairLine() is worn.
Sculpture sculptHair();

/// Positive where there is hair: metres from the plane of its edge.
double hairLine(const glm::dvec3& point);

} // namespace mannequin
