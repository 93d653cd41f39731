// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/PlaceJoints.h"

#include "fit/Proportions.h"
#include "fit/body/BodyBranches.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

namespace part = proportions;

const glm::dvec3 kUp(0.0, 1.0, 0.0);

/// Horizontal sections of one leg, from the ankle to below the crotch.
class Leg {
public:
    Leg(const FitBody& body, std::size_t side) : _body(body), _side(side) {}

    /// The leg's section at a height, around its medial curve or, without one, around a guess.
    std::optional<Section> at(double height, const glm::dvec3& guess) const {
        glm::dvec3 point = guess;
        const BodyBranches::Path& path = _body.branches.legs[_side];
        for (std::size_t i = 1; i < path.size(); ++i)
            if (path[i - 1].y >= height && path[i].y < height)
                point = glm::mix(path[i - 1], path[i],
                                 (path[i - 1].y - height) / (path[i - 1].y - path[i].y));
        point.y = height;
        return _body.surface.sectionAt(point, kUp, 0.03);
    }

    glm::dvec3 centre(double height, const glm::dvec3& guess) const {
        const auto section = at(height, guess);
        return section ? section->centre : glm::dvec3(guess.x, height, guess.z);
    }

    /// Height of the least girth between two heights; not set if that is at an end of the range.
    std::optional<double> thinnest(double low, double high, const glm::dvec3& guess) const {
        constexpr double kStep = 0.004;
        double best = low, least = std::numeric_limits<double>::infinity();
        for (double y = low; y <= high; y += kStep) {
            const auto section = at(y, guess);
            if (!section || section->girth >= least) continue;
            least = section->girth;
            best = y;
        }
        if (best < low + 1.5 * kStep || best > high - 1.5 * kStep) return std::nullopt;
        return best;
    }

private:
    const FitBody& _body;
    std::size_t _side;
};

/// Whether the legs fork at the hem of a skirt, which is much wider than both together.
bool isHem(const FitBody& body, const Fork& fork) {
    constexpr double kAbove = 0.02, kWider = 2.0;
    const auto above = body.surface.sectionAt(fork.point + kAbove * kUp, kUp, 0.05);
    return above && above->area > kWider * (fork.a.area + fork.b.area);
}

void placeHip(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const std::string name = sidePrefix(side) + "UpLeg";
    if (placed.has(name)) return;
    const auto& legs = body.branches.legs;
    const auto crotch = findFork(body.surface, legs[0], legs[1], {0, 0.3, 0}, -kUp, 0.32);
    if (!crotch)
        throw Error("cannot fit a skeleton: expected legs that fork between 30 % and 62 % of the "
                    "height, found no fork; give landmarks for " +
                    name);
    const glm::dvec3 thigh = (side == 0 ? crotch->a : crotch->b).centre;
    const bool skirted = isHem(body, *crotch);
    const double height = skirted ? part::kHipHeight : crotch->point.y + part::kHipAboveCrotch;
    double depth = thigh.z;
    if (const auto section = body.surface.sectionAt({0.0, height, thigh.z}, kUp, 0.05))
        depth = glm::mix(section->low(2), section->high(2), part::kHipDepth);
    placed.place(name, {thigh.x, height, depth},
                 skirted ? "share of the height, above a skirt's hem" : "above the crotch");
}

void placeAnkle(const Leg& leg, const std::string& name, PlacedJoints& placed,
                const glm::dvec3& guess) {
    if (placed.has(name)) return;
    const auto thinnest = leg.thinnest(0.045, 0.14, guess);
    const double height =
        thinnest ? std::max(*thinnest - part::kAnkleBelowThinnest, 0.8 * part::kAnkleHeight)
                 : part::kAnkleHeight;
    // Lower sections belong to the foot.
    glm::dvec3 centre = leg.centre(thinnest ? *thinnest - 0.015 : height, guess);
    centre.y = height;
    placed.place(name, centre, thinnest ? "below the thinnest section" : "share of the height");
}

void placeKnee(const FitBody& body, const Leg& leg, std::size_t side, PlacedJoints& placed) {
    const std::string name = sidePrefix(side) + "Leg";
    if (placed.has(name)) return;
    const glm::dvec3 hip = placed.at(sidePrefix(side) + "UpLeg");
    const glm::dvec3 ankle = placed.at(sidePrefix(side) + "Foot");
    glm::dvec3 guess = glm::mix(hip, ankle, part::kThigh / (part::kThigh + part::kShin));
    std::string how = "share of the leg";
    const double reach = 0.12 * (hip.y - ankle.y);
    if (body.branches.legs[side].empty()) {
        placed.place(name, guess, how);
        return;
    }
    if (const auto hollow = leg.thinnest(guess.y - reach - part::kKneeAboveThinnest,
                                         guess.y + reach - part::kKneeAboveThinnest, guess)) {
        guess.y = 0.5 * (guess.y + *hollow + part::kKneeAboveThinnest);
        how = "share of the leg and the hollow above the calf";
    }
    placed.place(name, leg.centre(guess.y, guess), how);
}

void placeToes(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const std::string name = sidePrefix(side) + "ToeBase";
    const glm::dvec3 ankle = placed.at(sidePrefix(side) + "Foot");
    std::vector<glm::dvec3> foot;
    for (const glm::dvec3& p : body.surface.points())
        if (p.y < 0.05 && std::abs(p.x - ankle.x) < 0.08 && (p.x > 0.0) == (ankle.x > 0.0))
            foot.push_back(p);
    double heel = ankle.z, toes = ankle.z;
    for (const glm::dvec3& p : foot) {
        heel = std::min(heel, p.z);
        toes = std::max(toes, p.z);
    }
    glm::dvec3 centre(ankle.x, part::kToeBaseHeight, glm::mix(heel, toes, part::kToeBase));
    double inner = std::numeric_limits<double>::infinity(), outer = -inner;
    for (const glm::dvec3& p : foot)
        if (std::abs(p.z - centre.z) < 0.02) {
            inner = std::min(inner, p.x);
            outer = std::max(outer, p.x);
        }
    if (inner < outer) centre.x = 0.5 * (inner + outer);
    centre = placed.place(name, centre, "share of the foot");
    placed.setTip(name, {centre.x, centre.y, std::max(toes, centre.z + 0.02)});
}

class Trunk {
public:
    explicit Trunk(const FitBody& body) : _body(body) {}

    /// The section of trunk, neck or head at a height.
    std::optional<Section> at(double height) const {
        return _body.surface.sectionAt(middle(height), kUp, 0.05);
    }

    /// A point in the middle plane, at a fraction of the depth from back to front.
    glm::dvec3 point(double height, double depth) const {
        const glm::dvec3 point = middle(height);
        const auto section = _body.surface.sectionAt(point, kUp, 0.05);
        if (!section) return point;
        // Take the depth at the spine: shoulders and arms of the same section are farther back.
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& p : section->points)
            if (std::abs(p.x - point.x) < 0.05) {
                low = std::min(low, p.z);
                high = std::max(high, p.z);
            }
        return low < high ? glm::dvec3(point.x, height, glm::mix(low, high, depth)) : point;
    }

private:
    glm::dvec3 middle(double height) const {
        const BodyBranches::Path& path = _body.branches.trunk;
        for (std::size_t i = 1; i < path.size(); ++i)
            if (path[i - 1].y >= height && path[i].y < height) {
                glm::dvec3 p = glm::mix(path[i - 1], path[i],
                                        (path[i - 1].y - height) / (path[i - 1].y - path[i].y));
                return _body.isSymmetric() ? glm::dvec3(0.0, height, p.z) : p;
            }
        const glm::dvec3 end = height > 0.7 ? path.front() : path.back();
        return {_body.isSymmetric() ? 0.0 : end.x, height, end.z};
    }

    const FitBody& _body;
};

/// Height of the thinnest section under the head.
double neckHeight(const Trunk& trunk) {
    double best = part::kNeckHeight, least = std::numeric_limits<double>::infinity();
    for (double y = 0.72; y <= 0.93; y += 0.004) {
        const auto section = trunk.at(y);
        if (!section || section->area >= least) continue;
        least = section->area;
        best = y;
    }
    return best;
}

} // namespace

void placeLeg(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const Leg leg(body, side);
    placeHip(body, side, placed);
    const glm::dvec3 hip = placed.at(sidePrefix(side) + "UpLeg");
    placeAnkle(leg, sidePrefix(side) + "Foot", placed, hip);
    placeKnee(body, leg, side, placed);
    placeToes(body, side, placed);
}

void placeTrunk(const FitBody& body, PlacedJoints& placed) {
    const Trunk trunk(body);
    const glm::dvec3 hip = 0.5 * (placed.at("LeftUpLeg") + placed.at("RightUpLeg"));
    glm::dvec3 hips = trunk.point(hip.y + part::kHipsAboveHip, part::kHipsDepth);
    hips.x = hip.x;
    hips = placed.place("Hips", hips, "between the hip joints");
    placed.place("LHipJoint", hips, "at Hips");
    placed.place("RHipJoint", hips, "at Hips");

    const double thinnest = neckHeight(trunk);
    const glm::dvec3 neck =
        placed.place("Neck", trunk.point(thinnest - part::kNeckBelowThinnest, part::kNeckDepth),
                     "below the thinnest section");
    const glm::dvec3 head =
        placed.place("Head", trunk.point(thinnest + part::kHeadAboveThinnest, part::kHeadDepth),
                     "above the thinnest section");
    if (!(head.y > neck.y && neck.y > hips.y))
        throw Error("cannot fit a skeleton: expected Head above Neck above Hips, found them at "
                    "heights " +
                    std::to_string(head.y) + ", " + std::to_string(neck.y) + " and " +
                    std::to_string(hips.y) + " of the body's");
    placed.setTip("Head", {head.x, body.top(), head.z});
    placed.place("Neck1", 0.5 * (neck + head), "between Neck and Head");

    const auto spine = [&](const char* name, double up, double depth) {
        const double height = glm::mix(hips.y, neck.y, up);
        placed.place(name, trunk.point(height, depth), "share of the trunk");
    };
    spine("LowerBack", part::kLowerBackUp, part::kLowerBackDepth);
    spine("Spine", part::kSpineUp, part::kSpineDepth);
    spine("Spine1", part::kSpine1Up, part::kSpine1Depth);
}

} // namespace osgSkin
