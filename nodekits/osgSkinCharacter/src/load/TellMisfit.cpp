// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/TellMisfit.h"

#include "report/TakeNote.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace osgSkin {
namespace {

/// A body that is so many times as long as its skeleton, or the reverse, is in another unit: of the
/// common ones those are 10 (centimetres), 39.4 (inches), 100 and 1000 times as long.
constexpr double kMostRatio = 5.0;

class Extent {
public:
    void add(const glm::dvec3& point) {
        _low = glm::min(_low, point);
        _high = glm::max(_high, point);
    }
    double length() const { return glm::distance(_low, _high); }

private:
    glm::dvec3 _low{std::numeric_limits<double>::max()};
    glm::dvec3 _high{std::numeric_limits<double>::lowest()};
};

} // namespace

void tellMisfit(CharacterSource& source, const BindReport& report) {
    Extent body, skeleton;
    for (const glm::dvec3& position : source.body.mesh.positions) body.add(position);
    for (const RestJoint& joint : source.rest.joints) {
        skeleton.add(joint.centre);
        if (joint.tip) skeleton.add(*joint.tip);
    }
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note.precision(3);
    note << source.file << ": ";
    const double ratio = skeleton.length() > 0.0 ? body.length() / skeleton.length() : 1.0;
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

} // namespace osgSkin
