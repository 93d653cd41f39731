// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_BONE_H
#define OSGSKINBIND_ELASTIC_BONE_H

#include "elastic/skin/Points.h"

#include <algorithm>

namespace osgSkin::elastic {

/// A bone as a segment, joint space.
struct Bone {
    Point from, to;
    bool moves = false; ///< with the joint; else it stays with the joint's parent
};

inline Point nearestOn(const Bone& bone, const Point& p) {
    const Point along = bone.to - bone.from;
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? std::clamp((p - bone.from).dot(along) / square, 0.0, 1.0) : 0.0;
    return bone.from + t * along;
}

} // namespace osgSkin::elastic

#endif
