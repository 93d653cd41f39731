// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place/PlacedJoints.h"

namespace osgSkin {

void PlacedJoints::addLandmark(const std::string& name, const glm::dvec3& centre,
                               const std::string& how) {
    _entries[name] = {centre, how, std::nullopt, true, false};
}

glm::dvec3 PlacedJoints::place(const std::string& name, const glm::dvec3& centre,
                               const std::string& how) {
    Entry& entry = _entries[name];
    if (!entry.isLandmark) entry = {centre, how, std::nullopt, false, false};
    return entry.centre;
}

} // namespace osgSkin
