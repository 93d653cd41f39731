// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "SkinMesh.h"

namespace mannequin {

/// A ball centred on the origin: an icosahedron refined twice, 162 vertices.
SkinMesh icoSphere(double radius);

} // namespace mannequin
