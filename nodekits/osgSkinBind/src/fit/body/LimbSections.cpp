// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/LimbSections.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

/// Where a path crosses a plane, nearest to its start: a bent limb may cross it again farther out.
std::optional<glm::dvec3> crossing(const BodyBranches::Path& path, const glm::dvec3& point,
                                   const glm::dvec3& normal) {
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double from = glm::dot(path[i - 1] - point, normal);
        const double to = glm::dot(path[i] - point, normal);
        if ((from > 0.0) != (to > 0.0)) return glm::mix(path[i - 1], path[i], from / (from - to));
    }
    return std::nullopt;
}

glm::dvec3 closestMiddle(const Section& a, const Section& b) {
    double nearest = std::numeric_limits<double>::infinity();
    glm::dvec3 middle = a.centre;
    for (const glm::dvec3& p : a.points)
        for (const glm::dvec3& q : b.points)
            if (glm::distance(p, q) < nearest) {
                nearest = glm::distance(p, q);
                middle = 0.5 * (p + q);
            }
    return middle;
}

/// Sections across a path between two fractions of its length. What cuts the trunk too is left out.
std::vector<Section> acrossPath(const BodySurface& surface, const BodyBranches::Path& path,
                                double from, double to) {
    constexpr int kSections = 60;
    constexpr double kTangent = 0.07; // fraction of the path over which its direction is taken
    std::vector<Section> sections;
    std::size_t middle = 0;
    for (int i = 0; i <= kSections; ++i) {
        const double fraction = from + (to - from) * i / kSections;
        const glm::dvec3 tangent = pathPoint(path, std::min(1.0, fraction + kTangent)) -
                                   pathPoint(path, std::max(0.0, fraction - kTangent));
        if (!(glm::length(tangent) > 0.0)) continue;
        auto section = surface.sectionAt(pathPoint(path, fraction), glm::normalize(tangent), 0.02);
        if (!section) continue;
        if (2 * i <= kSections) middle = sections.size();
        sections.push_back(std::move(*section));
    }
    if (sections.empty()) return sections;
    // Inwards from the middle of the limb, until a section is suddenly much larger.
    std::size_t first = middle;
    while (first > 0 && sections[first - 1].area < 1.35 * sections[first].area &&
           sections[first - 1].area < 4.0 * sections[middle].area)
        --first;
    sections.erase(sections.begin(), sections.begin() + static_cast<std::ptrdiff_t>(first));
    return sections;
}

} // namespace

std::vector<Section> limbSections(const BodySurface& surface, const BodyBranches::Path& path) {
    constexpr double kLast = 0.88; // fingers have sections of their own
    const std::vector<Section> sections = acrossPath(surface, path, 0.1, kLast);
    // Once more along the middle that these found: medial curves waver.
    BodyBranches::Path middle;
    for (const Section& section : sections) middle.push_back(section.centre);
    middle.push_back(path.back());
    return acrossPath(surface, middle, 0.0, kLast);
}

std::optional<Fork> findFork(const BodySurface& surface, const BodyBranches::Path& a,
                             const BodyBranches::Path& b, const glm::dvec3& outside,
                             const glm::dvec3& direction, double reach) {
    constexpr double kStep = 0.004, kNear = 0.03;
    std::optional<Fork> fork;
    std::optional<glm::dvec3> inA, inB;
    for (double moved = 0.0; moved < reach; moved += kStep) {
        const glm::dvec3 point = outside - moved * direction;
        if (!fork) {
            inA = crossing(a, point, direction);
            inB = crossing(b, point, direction);
            if (!inA || !inB) continue;
        } else { // medial curves join too early or too late: follow the sections instead
            *inA -= kStep * direction;
            *inB -= kStep * direction;
        }
        const auto sectionA = surface.sectionAt(*inA, direction, kNear);
        const auto sectionB = surface.sectionAt(*inB, direction, kNear);
        if (!sectionA || !sectionB) {
            if (fork) return std::nullopt;
            continue;
        }
        if (glm::distance(sectionA->centre, sectionB->centre) < 1e-9) {
            if (fork) return fork;
            continue;
        }
        inA = sectionA->centre;
        inB = sectionB->centre;
        fork = Fork{closestMiddle(*sectionA, *sectionB), *sectionA, *sectionB};
    }
    return std::nullopt;
}

} // namespace osgSkin
