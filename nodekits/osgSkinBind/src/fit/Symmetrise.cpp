// SPDX-License-Identifier: GPL-3.0-or-later
#include "PlaceJoints.h"

namespace osgSkin {
namespace {

glm::dvec3 mirrored(const glm::dvec3& p) {
    return {-p.x, p.y, p.z};
}

} // namespace

void mirrorLandmarks(JointSheet& sheet) {
    const auto given = sheet.entries();
    for (const auto& [name, entry] : given)
        if (given.count(mirroredName(name)) == 0)
            sheet.addLandmark(mirroredName(name), mirrored(entry.centre), "mirror of a landmark");
}

void symmetrise(JointSheet& sheet) {
    for (const FittedJoint& joint : fittedTree()) {
        JointSheet::Entry& left = sheet.entries().at(joint.name);
        JointSheet::Entry& right = sheet.entries().at(mirroredName(joint.name));
        if (left.isLandmark || right.isLandmark) continue;
        left.centre = 0.5 * (left.centre + mirrored(right.centre));
        right.centre = mirrored(left.centre);
        if (!left.tip || !right.tip) continue;
        left.tip = 0.5 * (*left.tip + mirrored(*right.tip));
        right.tip = mirrored(*left.tip);
    }
}

} // namespace osgSkin
