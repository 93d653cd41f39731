// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_COUNTCROSSINGS_H
#define OSGSKINBINDER_ELASTIC_COUNTCROSSINGS_H

#include "elastic/solid/RestSkin.h"

#include <cstddef>

namespace osgSkin::elastic {

/// Pairs of intersecting triangles. A third triangle at an edge is ignored.
std::size_t countCrossings(const RestSkin::Triangles& triangles, const Points& positions);

} // namespace osgSkin::elastic

#endif
