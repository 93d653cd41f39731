// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_BONE_H
#define OSGSKINBIND_ELASTIC_BONE_H

#include "elastic/skin/Points.h"

namespace osgSkin::elastic {

/// A bone as a segment, joint space.
struct Bone {
    Point from, to;
    bool moves = false; ///< with the joint; else it stays with the joint's parent
};

} // namespace osgSkin::elastic

#endif
