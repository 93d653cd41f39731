// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/FitReport>

#include <iomanip>
#include <sstream>

namespace osgSkin {

std::string FitReport::text() const {
    std::ostringstream out;
    out << "fitted " << joints.size() << " joints, height " << height << ", facing " << facing
        << std::fixed << std::setprecision(4) << ", symmetry error " << symmetryError
        << " of the height, " << std::setprecision(3) << seconds << " s\n";
    for (const Joint& joint : joints)
        out << "joint " << joint.name << ": " << joint.how
            << (joint.pushed ? ", moved inside the skin" : "") << "\n";
    for (const std::string& note : notes) out << "note: " << note << "\n";
    return out.str();
}

} // namespace osgSkin
