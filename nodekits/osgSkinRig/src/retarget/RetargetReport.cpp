// SPDX-License-Identifier: MIT
#include <osgSkinRig/RetargetReport>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <iomanip>
#include <sstream>

namespace osgSkin {

std::string RetargetReport::text() const {
    std::ostringstream out;
    out << "names: rig " << (rigNames.empty() ? "of no known family" : rigNames) << ", motion "
        << (motionNames.empty() ? "of no known family" : motionNames) << "\n"
        << std::setprecision(4) << "way scaled by " << scale;
    const double degrees = glm::degrees(glm::angle(turn.w < 0.0 ? -turn : turn));
    if (degrees > 1e-6) {
        const glm::dvec3 axis = glm::axis(turn.w < 0.0 ? -turn : turn);
        out << ", turned by " << degrees << " degrees about " << axis.x << " " << axis.y << " "
            << axis.z;
    }
    out << "\n";
    for (const std::string& note : notes) out << "note: " << note << "\n";
    for (const Entry& entry : entries) {
        out << "joint " << entry.rigJoint << ": ";
        if (entry.motionJoint.empty())
            out << "at rest";
        else
            out << entry.motionJoint << ", aligned by " << entry.alignmentDegrees << " degrees";
        if (entry.turnedOver > 0)
            out << ", upside down in " << entry.turnedOver << " samples: turned back";
        out << "\n";
    }
    for (const std::string& joint : unusedMotionJoints) out << "not used: " << joint << "\n";
    return out.str() + feetText();
}

std::string RetargetReport::feetText() const {
    std::ostringstream out;
    out << std::fixed;
    for (const FootSkate& foot : feet) {
        out << "foot " << foot.rigJoint << ": ";
        const auto share = [&](double length) {
            out << std::setprecision(1) << 100.0 * length / foot.leg << " %";
        };
        if (foot.stances == 0) {
            out << "never planted\n";
            continue;
        }
        out << foot.stances << (foot.stances == 1 ? " stance" : " stances") << ", slides by ";
        share(foot.mean);
        out << " of the leg in the mean, ";
        share(foot.worst);
        out << " at worst (from frame " << foot.worstFrame << "); the actor's own: ";
        share(foot.actorMean);
        out << ", ";
        share(foot.actorWorst);
        out << "\n";
    }
    return out.str();
}

} // namespace osgSkin
