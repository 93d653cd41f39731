// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/TellMisfit.h"

#include "report/TakeNote.h"

#include <osgSkin/GlmOsg>

#include <osg/BoundingBox>

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace osgSkin {
namespace {

/// A body that is so many times as long as its skeleton, or the reverse, is in another unit: of the
/// common ones those are 10 (centimetres), 39.4 (inches), 100 and 1000 times as long.
constexpr double kMostRatio = 5.0;

/// Of the body's size: what vertices may be rounded by unseen.
constexpr double kMostRounding = 1e-4;

double lengthOf(const osg::BoundingBoxd& box) {
    return box.valid() ? 2.0 * box.radius() : 0.0;
}

} // namespace

void tellMisfit(CharacterSource& source, const BindReport& report) {
    osg::BoundingBoxd body, skeleton;
    for (const glm::dvec3& position : source.body.mesh.positions) body.expandBy(toOsg(position));
    for (const RestJoint& joint : source.rest.joints) {
        skeleton.expandBy(toOsg(joint.centre));
        if (joint.tip) skeleton.expandBy(toOsg(*joint.tip));
    }
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note.precision(3);
    note << source.file << ": ";
    const double ratio = lengthOf(skeleton) > 0.0 ? lengthOf(body) / lengthOf(skeleton) : 1.0;
    if (source.rest.joints.size() > 1 && (ratio > kMostRatio || ratio < 1.0 / kMostRatio))
        note << "the body is " << ratio
             << " times as long as the skeleton, expected both in the same unit";
    else if (report.jointsOutside > report.jointsInside)
        note << report.jointsOutside << " of " << report.jointsOutside + report.jointsInside
             << " joints lie outside the skin, expected the skeleton in the body's pose, unit "
                "and place";
    else
        return;
    takeNote(source.notes, note.str());
}

void tellRounding(CharacterSource& source) {
    double farthest = 0.0;
    for (const glm::dvec3& p : source.body.mesh.positions)
        for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(p[axis]));
    const double rounding = farthest * double(std::numeric_limits<float>::epsilon()) / 2.0;
    const double size = source.body.mesh.size();
    if (!(rounding > kMostRounding * size)) return;
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note.precision(3);
    note << source.meshFile << ": the body is " << farthest << " from the origin and " << size
         << " long, so that single precision rounds its vertices by " << rounding
         << "; expected it near the origin, moved by a transform above it";
    takeNote(source.notes, note.str());
}

} // namespace osgSkin
