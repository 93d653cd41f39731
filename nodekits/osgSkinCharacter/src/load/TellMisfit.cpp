// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/TellMisfit.h"

#include "options/LoadReport.h"

#include <osgSkin/GlmOsg>

#include <osg/BoundingBox>

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

/// A body that is so many times as long as its skeleton, or the reverse, is in another unit: of the
/// common ones those are 10 (centimetres), 39.4 (inches), 100 and 1000 times as long.
constexpr double kMostRatio = 5.0;

/// The same where weights name the joints: a face's stand close to each other.
constexpr double kMostPaintedRatio = 8.0;
constexpr std::size_t kFewJoints = 3; ///< fewer are no measure of a body

/// Of the body's length: what joints may lie beside it, in an open jacket's sleeve.
constexpr double kRoom = 0.05;

/// Of the body's size: what vertices may be rounded by unseen.
constexpr double kMostRounding = 1e-4;

double lengthOf(const osg::BoundingBoxd& box) {
    return box.valid() ? 2.0 * box.radius() : 0.0;
}

osg::BoundingBoxd boxOf(const SkinMesh& mesh) {
    osg::BoundingBoxd result;
    for (const glm::dvec3& position : mesh.positions) result.expandBy(toOsg(position));
    return result;
}

/// \param joints to compare the body with
/// \param mostRatio of lengths that is no other unit
/// \param outside of them lie outside the skin
void tellMisfit(CharacterSource& source, const osg::BoundingBoxd& body,
                const osg::BoundingBoxd& skeleton, std::size_t joints, double mostRatio,
                std::size_t outside) {
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note.precision(3);
    note << source.file << ": ";
    const double ratio = lengthOf(skeleton) > 0.0 ? lengthOf(body) / lengthOf(skeleton) : 1.0;
    if (ratio > mostRatio || ratio < 1.0 / mostRatio)
        note << "the body is " << ratio
             << " times as long as the skeleton, expected both in the same unit";
    else if (outside > joints - outside)
        note << outside << " of " << joints
             << " joints lie outside the skin, expected the skeleton in the body's pose, unit "
                "and place";
    else
        return;
    takeNote(source.notes, note.str());
}

} // namespace

void tellMisfit(CharacterSource& source, const BindReport& report) {
    osg::BoundingBoxd skeleton;
    if (source.rest.joints.size() > 1)
        for (const RestJoint& joint : source.rest.joints) {
            skeleton.expandBy(toOsg(joint.centre));
            if (joint.tip) skeleton.expandBy(toOsg(*joint.tip));
        }
    tellMisfit(source, boxOf(source.body.mesh), skeleton,
               report.jointsOutside + report.jointsInside, kMostRatio, report.jointsOutside);
}

void tellMisfit(CharacterSource& source, const VertexWeights& weights) {
    std::vector<bool> named(source.rest.joints.size());
    for (const auto& entries : weights)
        for (const JointWeight& entry : entries)
            if (entry.weight > 0.0) named[static_cast<std::size_t>(entry.joint)] = true;
    const osg::BoundingBoxd body = boxOf(source.body.mesh);
    const double room = kRoom * lengthOf(body);
    osg::BoundingBoxd skeleton;
    std::size_t joints = 0, outside = 0;
    for (std::size_t j = 0; j < named.size(); ++j) {
        if (!named[j]) continue;
        const osg::Vec3d centre = toOsg(source.rest.joints[j].centre);
        skeleton.expandBy(centre);
        ++joints;
        for (int axis = 0; axis < 3; ++axis)
            if (centre[axis] < body._min[axis] - room || centre[axis] > body._max[axis] + room) {
                ++outside;
                break;
            }
    }
    if (joints < kFewJoints) skeleton.init();
    tellMisfit(source, body, skeleton, joints, kMostPaintedRatio, outside);
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
