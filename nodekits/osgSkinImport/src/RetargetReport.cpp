// SPDX-License-Identifier: MIT
#include <osgSkinImport/Retarget>

#include <iomanip>
#include <sstream>

namespace osgSkin {

std::string RetargetReport::text() const {
    std::ostringstream out;
    out << "names: rig " << (rigNames.empty() ? "of no known family" : rigNames) << ", motion "
        << (motionNames.empty() ? "of no known family" : motionNames) << "\n"
        << std::setprecision(4) << "way scaled by " << scale << "\n";
    for (const Entry& entry : entries) {
        out << "joint " << entry.rigJoint << ": ";
        if (entry.motionJoint.empty())
            out << "at rest";
        else
            out << entry.motionJoint << ", aligned by " << entry.alignmentDegrees << " degrees";
        out << "\n";
    }
    for (const std::string& joint : unusedMotionJoints) out << "not used: " << joint << "\n";
    return out.str();
}

} // namespace osgSkin
