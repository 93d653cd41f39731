// SPDX-License-Identifier: MIT
#include <osgSkinRig/RetargetReport>

#include <osgSkin/Error>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <iomanip>
#include <sstream>

namespace osgSkin {

std::string RetargetReport::text() const {
    std::ostringstream out;
    out << "names: rig " << (rigNames.empty() ? "of no known family" : rigNames) << ", motion "
        << (motionNames.empty() ? "of no known family" : motionNames) << "\n"
        << std::setprecision(4) << "root motion scaled by " << scale;
    const double degrees = glm::degrees(glm::angle(rotation.w < 0.0 ? -rotation : rotation));
    if (degrees > 1e-6) {
        const glm::dvec3 axis = glm::axis(rotation.w < 0.0 ? -rotation : rotation);
        out << ", rotated by " << degrees << " degrees about " << axis.x << " " << axis.y << " "
            << axis.z;
    }
    out << "\n";
    for (const std::string& note : notes) out << "note: " << onOneLine(note) << "\n";
    for (const Entry& entry : entries) {
        out << "joint " << onOneLine(entry.rigJoint) << ": ";
        if (entry.motionJoint.empty())
            out << "at rest";
        else
            out << onOneLine(entry.motionJoint) << ", aligned by " << entry.alignmentDegrees
                << " degrees";
        if (entry.rolledOver > 0)
            out << ", upside down in " << entry.rolledOver << " samples: rolled back";
        if (entry.twistShared > 0)
            out << ", twisted by more than 90 degrees in " << entry.twistShared
                << " samples: the excess is shared out";
        out << "\n";
    }
    for (const std::string& joint : unusedMotionJoints)
        out << "not used: " << onOneLine(joint) << "\n";
    return out.str() + feetText();
}

std::string RetargetReport::feetText() const {
    std::ostringstream out;
    out << std::fixed;
    for (const FootSkate& foot : feet) {
        out << "foot " << onOneLine(foot.rigJoint) << ": ";
        const auto percent = [&](double length) {
            out << std::setprecision(1) << 100.0 * length / foot.leg << " %";
        };
        if (foot.contacts == 0) {
            out << "never planted\n";
            continue;
        }
        out << foot.contacts << (foot.contacts == 1 ? " contact" : " contacts") << ", slides by ";
        percent(foot.mean);
        out << " of the leg in the mean, ";
        percent(foot.worst);
        out << " at worst (from frame " << foot.worstFrame << "); the actor's own: ";
        percent(foot.actorMean);
        out << ", ";
        percent(foot.actorWorst);
        out << "\n";
    }
    return out.str();
}

} // namespace osgSkin
