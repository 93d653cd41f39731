// SPDX-License-Identifier: MIT
#ifndef OSGSKINVIEWER_PLAYEDEXTENT_H
#define OSGSKINVIEWER_PLAYEDEXTENT_H 1

#include "Figure.h"

#include <osg/BoundingBox>

#include <cstddef>

namespace viewer {

/// Where a figure gets to while a motion plays: its skins and what its bones carry. Props have ways
/// of their own, and count for nothing: a ball flies off. In the space of the figure's root.
struct PlayedExtent {
    osg::BoundingBoxd box; ///< around its triangles in all samples
    /// z of its floor: where its feet are when they stand. That is the lowest point in a tenth of
    /// the samples: a jump does not lift the floor, and a foot that dips into it for a moment does
    /// not lower it. At rest, the lowest point.
    double floor;
};

/// \param figure is left in some pose of the motion
/// \param motion index of one of its motions; passed over where it has none
PlayedExtent playedExtent(const Figure& figure, std::size_t motion);

} // namespace viewer

#endif
