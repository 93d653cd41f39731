// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place/PushInside.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <string>

namespace osgSkin {
namespace {

/// How deep a joint stands at least, in heights, and how far outside a landmark may be.
constexpr double kDepth = 0.006;
constexpr double kFarOutside = 0.05;

bool isDeep(const FitBody& body, const glm::dvec3& p) {
    return body.surface.isInside(p) && glm::distance(body.surface.nearest(p), p) >= 0.5 * kDepth;
}

/// The nearest position inside the skin: straight in from the nearest point of the skin, as deep as
/// the body is thick enough for.
bool pushIn(const FitBody& body, glm::dvec3& p) {
    const glm::dvec3 skin = body.surface.nearest(p);
    glm::dvec3 in = body.surface.isInside(p) ? p - skin : skin - p;
    if (!(glm::length(in) > 1e-9)) return false;
    in = glm::normalize(in);
    for (double depth = kDepth; depth > 0.0005; depth *= 0.7) {
        const glm::dvec3 candidate = skin + depth * in;
        if (!body.surface.isInside(candidate)) continue;
        p = candidate;
        return true;
    }
    return false;
}

} // namespace

void pushInside(const FitBody& body, PlacedJoints& placed, std::vector<std::string>& notes) {
    for (const FittedJoint& joint : fittedTree()) {
        PlacedJoints::Entry& entry = placed.entries().at(joint.name);
        const bool inside = body.surface.isInside(entry.centre);
        if (entry.isLandmark) {
            if (inside) continue;
            const double away = glm::distance(body.surface.nearest(entry.centre), entry.centre);
            if (away > kFarOutside)
                throw Error("cannot fit a skeleton: landmark " + std::string(joint.name) +
                            ": expected a point inside the skin, found one " +
                            std::to_string(away * body.height()) + " outside");
            notes.push_back("landmark " + std::string(joint.name) + " was outside the skin");
        }
        if (inside && isDeep(body, entry.centre)) continue;
        const glm::dvec3 before = entry.centre;
        if (!pushIn(body, entry.centre) && joint.parent >= 0) {
            // From a sharp edge: towards the parent, which is inside.
            const glm::dvec3 parent =
                placed.at(fittedTree()[static_cast<std::size_t>(joint.parent)].name);
            for (int step = 1; step <= 32 && !body.surface.isInside(entry.centre); ++step)
                entry.centre = glm::mix(before, parent, step / 32.0);
        }
        if (!body.surface.isInside(entry.centre))
            throw Error("cannot fit a skeleton: no place inside the skin for " +
                        std::string(joint.name));
        entry.pushed = entry.centre != before;
    }
}

} // namespace osgSkin
