// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/BodyBranches.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

namespace osgSkin {
namespace {

using Indices = std::vector<std::size_t>;

/// The least length of an arm, as a fraction of the height, and the greatest of a third limb,
/// relative to the second: arms have about 0.4; ears, noses and hair are far shorter.
constexpr double kShortestArm = 0.15;
constexpr double kThirdLimb = 0.6;

/// The crotch is above the first of these heights for people, above the others for figures with
/// short legs or in skirts. Feet end below kFootZone.
constexpr double kLegZones[] = {0.3, 0.2, 0.13};
constexpr double kFootZone = 0.1;

/// Branches this far above the arms are hair, those this near to the legs are tails.
constexpr double kAboveArms = 0.08;
constexpr double kAtLegs = 0.08;

[[noreturn]] void fail(const std::string& what) {
    throw Error("cannot fit a skeleton: " + what);
}

class BranchFinder {
public:
    explicit BranchFinder(const CurveSkeleton& skeleton) : _skeleton(skeleton) {}

    BodyBranches find(bool legsGiven, bool armsGiven) {
        const CurveSkeleton::Paths toHead = _skeleton.pathsTo(highest());
        Indices feet;
        std::size_t found = 0; // with a person's zone
        for (const double zone : kLegZones) {
            feet = footEnds(toHead, zone);
            if (zone == kLegZones[0]) found = feet.size();
            if (feet.size() == 2) break;
        }
        if (feet.size() != 2) {
            if (!legsGiven)
                fail("expected two legs that reach the floor apart from each other, found " +
                     std::to_string(found) +
                     "; is the body upright, with `up` as its up axis? Else give landmarks for "
                     "LeftUpLeg, LeftFoot, RightUpLeg and RightFoot");
            feet.assign(2, lowest());
        }
        std::array<Indices, 2> legs{toHead.pathFrom(feet[0]), toHead.pathFrom(feet[1])};
        Indices trunk; // the common part of both legs' paths to the head
        while (!legs[0].empty() && !legs[1].empty() && legs[0].back() == legs[1].back()) {
            trunk.push_back(legs[0].back());
            legs[0].pop_back();
            legs[1].pop_back();
        }
        if (trunk.size() < 2) fail("expected a trunk between head and legs, found none");
        BodyBranches result;
        result.trunk = points(trunk);
        for (std::size_t side = 0; side < 2 && !legs[side].empty(); ++side) {
            legs[side].push_back(trunk.back());
            std::reverse(legs[side].begin(), legs[side].end());
            result.legs[side] = points(legs[side]);
        }
        if (const auto arms = findArms(trunk, legs, armsGiven))
            result.arms = {points((*arms)[0]), points((*arms)[1])};
        pairSides(result);
        return result;
    }

private:
    std::size_t highest() const {
        std::size_t best = 0;
        for (std::size_t p = 0; p < _skeleton.points.size(); ++p)
            if (_skeleton.points[p].y > _skeleton.points[best].y) best = p;
        return best;
    }

    std::size_t lowest() const {
        std::size_t best = 0;
        for (std::size_t p = 0; p < _skeleton.points.size(); ++p)
            if (_skeleton.points[p].y < _skeleton.points[best].y) best = p;
        return best;
    }

    BodyBranches::Path points(const Indices& indices) const {
        BodyBranches::Path path;
        for (const std::size_t p : indices) path.push_back(_skeleton.points[p]);
        return path;
    }

    /// For each connected piece of the curves below the zone's top, the point farthest from the
    /// head; only for pieces that reach down to the floor.
    Indices footEnds(const CurveSkeleton::Paths& toHead, double zone) const {
        std::vector<bool> known(_skeleton.points.size(), false);
        Indices ends;
        for (std::size_t start = 0; start < known.size(); ++start) {
            if (known[start] || _skeleton.points[start].y > zone) continue;
            Indices open{start};
            std::size_t end = start;
            double lowest = 1.0;
            known[start] = true;
            while (!open.empty()) {
                const std::size_t p = open.back();
                open.pop_back();
                lowest = std::min(lowest, _skeleton.points[p].y);
                if (toHead.length[p] > toHead.length[end]) end = p;
                for (const std::size_t q : _skeleton.neighbours[p])
                    if (!known[q] && _skeleton.points[q].y <= zone) {
                        known[q] = true;
                        open.push_back(q);
                    }
            }
            if (lowest < kFootZone) ends.push_back(end);
        }
        return ends;
    }

    /// The two longest branches that leave the trunk.
    std::optional<std::array<Indices, 2>> findArms(const Indices& trunk,
                                                   const std::array<Indices, 2>& legs, bool given) {
        std::vector<bool> taken(_skeleton.points.size(), false);
        for (const std::size_t p : trunk) taken[p] = true;
        for (const Indices& leg : legs)
            for (const std::size_t p : leg) taken[p] = true;

        std::vector<std::pair<double, Indices>> branches;
        for (const std::size_t root : trunk)
            for (const std::size_t first : _skeleton.neighbours[root]) {
                if (taken[first]) continue;
                const CurveSkeleton::Paths paths = _skeleton.pathsTo(first, taken);
                std::size_t end = first;
                for (std::size_t p = 0; p < paths.length.size(); ++p)
                    if (paths.length[p] < std::numeric_limits<double>::infinity() &&
                        paths.length[p] > paths.length[end])
                        end = p;
                Indices path = paths.pathFrom(end);
                path.push_back(root);
                std::reverse(path.begin(), path.end());
                branches.emplace_back(paths.length[end], path);
            }
        std::stable_sort(branches.begin(), branches.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        const auto heightOf = [this](const auto& branch) {
            return _skeleton.points[branch.second.front()].y;
        };
        const double legsAt = _skeleton.points[trunk.back()].y;
        const auto isNoArm = [&](const auto& branch) {
            return branch.first <= kShortestArm || heightOf(branch) < legsAt + kAtLegs;
        };
        branches.erase(std::remove_if(branches.begin(), branches.end(), isNoArm), branches.end());
        preferPair(branches, heightOf);
        const std::size_t arms = branches.size();
        if (given && arms != 2) return std::nullopt;
        if (arms < 2)
            fail("expected two arms that stand off the trunk (a T or an A pose), found " +
                 std::to_string(arms) +
                 "; give landmarks for LeftArm, LeftHand, RightArm and RightHand");
        if (arms > 2 && branches[2].first > kThirdLimb * branches[1].first) {
            std::ostringstream what;
            what << "expected two arms, found " << arms << " limbs between head and legs, at least "
                 << std::setprecision(2) << branches[arms - 1].first << " of the height long";
            fail(what.str());
        }
        return std::array<Indices, 2>{branches[0].second, branches[1].second};
    }

    /// Drops hanging hair and ears. Among three limbs or more it finds the longest two that leave
    /// the trunk at about the same height, and removes those that leave it far above.
    template <typename Branches, typename Height>
    static void preferPair(Branches& branches, const Height& heightOf) {
        for (std::size_t second = 1; second < branches.size() && branches.size() > 2; ++second)
            for (std::size_t first = 0; first < second; ++first) {
                const double a = heightOf(branches[first]), b = heightOf(branches[second]);
                if (std::abs(a - b) > kAboveArms) continue;
                const double most = std::max(a, b) + kAboveArms;
                const auto above = [&](const auto& branch) { return heightOf(branch) > most; };
                if (branches[second].first < kThirdLimb * branches[first].first) continue;
                branches.erase(std::remove_if(branches.begin(), branches.end(), above),
                               branches.end());
                return;
            }
    }

    static void pairSides(BodyBranches& body) {
        if (body.arms[0].empty() || body.legs[0].empty()) return;
        const glm::dvec3 legs = body.legs[0].back() - body.legs[1].back();
        const glm::dvec3 arms = body.arms[0].back() - body.arms[1].back();
        if (legs.x * arms.x + legs.z * arms.z < 0.0) std::swap(body.arms[0], body.arms[1]);
    }

    const CurveSkeleton& _skeleton;
};

/// Where a path first crosses a plane; a bent limb may cross it again farther out.
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

/// Sections across a path between two fractions of its length, without those that cut the trunk.
std::vector<Section> acrossPath(const FitSurface& surface, const BodyBranches::Path& path,
                                double from, double to) {
    constexpr int kSections = 60;
    constexpr double kTangent = 0.07; // fraction of the path that gives its direction
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
    // Go inwards from the middle of the limb until a section is suddenly much larger.
    std::size_t first = middle;
    while (first > 0 && sections[first - 1].area < 1.35 * sections[first].area &&
           sections[first - 1].area < 4.0 * sections[middle].area)
        --first;
    sections.erase(sections.begin(), sections.begin() + static_cast<std::ptrdiff_t>(first));
    return sections;
}

} // namespace

BodyBranches BodyBranches::find(const CurveSkeleton& skeleton, bool legsGiven, bool armsGiven) {
    if (skeleton.points.empty()) fail("the body has no medial curve");
    return BranchFinder(skeleton).find(legsGiven, armsGiven);
}

void BodyBranches::transform(const glm::dmat3& rotation, const glm::dvec3& origin) {
    for (Path* path : {&trunk, &legs[0], &legs[1], &arms[0], &arms[1]})
        for (glm::dvec3& p : *path) p = rotation * (p - origin);
}

void BodyBranches::sortSides() {
    // Compares hips and shoulders, as hands and feet may cross.
    if (!legs[0].empty() && pathPoint(legs[0], 0.4).x < pathPoint(legs[1], 0.4).x)
        std::swap(legs[0], legs[1]);
    if (!arms[0].empty() && pathPoint(arms[0], 0.3).x < pathPoint(arms[1], 0.3).x)
        std::swap(arms[0], arms[1]);
}

double pathLength(const BodyBranches::Path& path) {
    double length = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) length += glm::distance(path[i - 1], path[i]);
    return length;
}

glm::dvec3 pathPoint(const BodyBranches::Path& path, double fraction) {
    double left = fraction * pathLength(path);
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double step = glm::distance(path[i - 1], path[i]);
        if (left <= step && step > 0.0) return glm::mix(path[i - 1], path[i], left / step);
        left -= step;
    }
    return path.back();
}

std::vector<Section> limbSections(const FitSurface& surface, const BodyBranches::Path& path) {
    constexpr double kLast = 0.88; // fingers have sections of their own
    const std::vector<Section> sections = acrossPath(surface, path, 0.1, kLast);
    // Medial curves waver, so repeat along the centres of these sections.
    BodyBranches::Path middle;
    for (const Section& section : sections) middle.push_back(section.centre);
    middle.push_back(path.back());
    return acrossPath(surface, middle, 0.0, kLast);
}

std::optional<Fork> findFork(const FitSurface& surface, const BodyBranches::Path& a,
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
        } else { // medial curves join too early or too late, so follow the sections
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
