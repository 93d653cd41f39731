// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/PlacedJoints.h"

namespace osgSkin {

const std::string& sidePrefix(std::size_t side) {
    static const std::string prefixes[] = {"Left", "Right"};
    return prefixes[side];
}

std::string mirroredName(const std::string& name) {
    if (name.rfind("Left", 0) == 0) return "Right" + name.substr(4);
    if (name.rfind("Right", 0) == 0) return "Left" + name.substr(5);
    if (name == "LHipJoint" || name == "LThumb") return "R" + name.substr(1);
    if (name == "RHipJoint" || name == "RThumb") return "L" + name.substr(1);
    return name;
}

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
