// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place/PlaceHand.h"

#include "fit/place/Proportions.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <string>

namespace osgSkin {
namespace {

namespace part = proportions;

/// The farthest point of the hand from the wrist, away from the elbow.
glm::dvec3 fingerTip(const FitBody& body, const glm::dvec3& elbow, const glm::dvec3& wrist) {
    const glm::dvec3 outwards = glm::normalize(wrist - elbow);
    // Bent fingers and thumbs stay within a hand's length.
    constexpr double kReach = 1.25 * part::kHand;
    glm::dvec3 tip = wrist + 0.25 * part::kHand * outwards;
    double farthest = 0.0;
    for (const glm::dvec3& p : body.surface.points()) {
        const glm::dvec3 d = p - wrist;
        const double length = glm::length(d);
        // A cone leaves the thigh out that a hand hangs beside.
        if (length > kReach || glm::dot(d, outwards) < 0.7 * length || length <= farthest) continue;
        farthest = length;
        tip = p;
    }
    return tip;
}

} // namespace

void placeHand(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const std::string& prefix = sidePrefix(side);
    const glm::dvec3 elbow = placed.at(prefix + "ForeArm"), wrist = placed.at(prefix + "Hand");
    const glm::dvec3 tip = fingerTip(body, elbow, wrist);
    const glm::dvec3 toTip = tip - wrist;
    const auto along = [&](double fraction) { return wrist + fraction * toTip; };
    // A hand is flat and fingers are curved: the middle of the section is inside.
    const auto within = [&](double fraction) {
        const auto section = body.surface.sectionAt(along(fraction), glm::normalize(toTip), 0.03);
        return section ? section->centre : along(fraction);
    };
    placed.place(prefix + "FingerBase", within(part::kFingerBase), "share of the hand");
    placed.place(prefix + "HandIndex1", within(part::kFingers), "share of the hand");
    placed.setTip(prefix + "HandIndex1", tip);

    // Thumbs point ahead, whether the palm faces down or the thigh.
    const glm::dvec3 axis = glm::normalize(toTip);
    glm::dvec3 ahead = glm::dvec3(0, 0, 1) - axis.z * axis;
    ahead = glm::length(ahead) > 0.2 ? glm::normalize(ahead) : glm::dvec3(0.0);
    const std::string thumb = side == 0 ? "LThumb" : "RThumb";
    const glm::dvec3 root =
        placed.place(thumb, along(part::kThumb) + part::kThumbAside * ahead, "ahead in the hand");
    placed.setTip(thumb, root + 0.25 * toTip + part::kThumbAside * ahead);
}

} // namespace osgSkin
