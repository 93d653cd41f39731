// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/FacingClues.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// Feet point ahead of the ankle: the middle of what lies low, before the shin.
double feetAhead(const BodySurface& surface, const BodyBranches& branches) {
    double result = 0.0;
    for (const BodyBranches::Path& leg : branches.legs) {
        if (leg.empty()) continue;
        // Past its last bend a curve may run along the foot: the shin is where it is last high.
        glm::dvec3 shin = leg.front();
        for (const glm::dvec3& p : leg)
            if (p.y > 0.1) shin = p;
        const auto section = surface.sectionAt(shin, {0, 1, 0}, 0.1);
        if (section) shin = section->centre;
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& p : surface.points())
            if (p.y < 0.05 && (p.x > 0.0) == (shin.x > 0.0)) {
                low = std::min(low, p.z);
                high = std::max(high, p.z);
            }
        if (low < high) result += 0.5 * (0.5 * (low + high) - shin.z);
    }
    return result;
}

/// Chin and nose overhang the neck more than the back of the head does.
double faceAhead(const BodySurface& surface, const BodyBranches& branches) {
    double thinnest = std::numeric_limits<double>::infinity();
    double neckLow = 0.0, neckHigh = 0.0, neckTop = 0.0;
    for (double y = 0.93; y > 0.72; y -= 0.005) {
        glm::dvec3 at = branches.trunk.front();
        for (const glm::dvec3& p : branches.trunk)
            if (p.y > y) at = p;
        at.y = y;
        const auto section = surface.sectionAt(at, {0, 1, 0}, 0.1);
        if (!section || section->area >= thinnest) continue;
        thinnest = section->area;
        neckLow = section->low(2);
        neckHigh = section->high(2);
        neckTop = y;
    }
    double low = neckLow, high = neckHigh;
    for (const glm::dvec3& p : surface.points())
        if (p.y > neckTop) {
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
    return (high - neckHigh) - (neckLow - low);
}

/// Elbows bend forward only.
double elbowsBehind(const BodyBranches& branches) {
    double result = 0.0;
    for (const BodyBranches::Path& arm : branches.arms) {
        if (arm.empty()) continue;
        const glm::dvec3 shoulder = pathPoint(arm, 0.35), hand = arm.back();
        const glm::dvec3 middle = pathPoint(arm, 0.65);
        const glm::dvec3 along = glm::normalize(hand - shoulder);
        const glm::dvec3 off = middle - shoulder - glm::dot(middle - shoulder, along) * along;
        result -= 0.5 * off.z;
    }
    return result;
}

} // namespace

std::string FacingClues::strongest() const {
    const double most = std::max({std::abs(feet), std::abs(head), std::abs(elbows)});
    if (most == std::abs(feet)) return "from the feet";
    return most == std::abs(head) ? "from the face" : "from the elbows";
}

FacingClues facingClues(const BodySurface& surface, const BodyBranches& branches) {
    return {feetAhead(surface, branches), faceAhead(surface, branches), elbowsBehind(branches)};
}

} // namespace osgSkin
