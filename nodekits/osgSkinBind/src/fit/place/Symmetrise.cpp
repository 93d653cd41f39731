// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place/Symmetrise.h"

namespace osgSkin {
namespace {

glm::dvec3 mirrored(const glm::dvec3& p) {
    return {-p.x, p.y, p.z};
}

} // namespace

void mirrorLandmarks(PlacedJoints& placed) {
    const auto given = placed.entries();
    for (const auto& [name, entry] : given)
        if (given.count(mirroredName(name)) == 0)
            placed.addLandmark(mirroredName(name), mirrored(entry.centre), "mirror of a landmark");
}

void symmetrise(PlacedJoints& placed) {
    for (const FittedJoint& joint : fittedTree()) {
        PlacedJoints::Entry& left = placed.entries().at(joint.name);
        PlacedJoints::Entry& right = placed.entries().at(mirroredName(joint.name));
        if (left.isLandmark || right.isLandmark) continue;
        left.centre = 0.5 * (left.centre + mirrored(right.centre));
        right.centre = mirrored(left.centre);
        if (!left.tip || !right.tip) continue;
        left.tip = 0.5 * (*left.tip + mirrored(*right.tip));
        right.tip = mirrored(*left.tip);
    }
}

} // namespace osgSkin
