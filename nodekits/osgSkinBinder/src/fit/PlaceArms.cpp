// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/PlaceJoints.h"

#include "fit/Proportions.h"
#include "fit/body/BodyBranches.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace osgSkin {
namespace {

namespace part = proportions;

constexpr double kArm = part::kUpperArm + part::kForeArm + part::kHand;

void placeShoulder(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const std::string name = sidePrefix(side) + "Arm";
    if (placed.has(name)) return;
    const BodyBranches::Path& arm = body.branches.arms[side];
    BodyBranches::Path trunk = body.branches.trunk;
    trunk.insert(trunk.end(), body.branches.legs[side].begin(), body.branches.legs[side].end());
    const glm::dvec3 upper = pathPoint(arm, 0.6) - pathPoint(arm, 0.35);
    // Out of the armpit: half-way between the directions down the arm and down the trunk.
    const glm::dvec3 out = glm::normalize(glm::normalize(upper) + glm::dvec3(0, -1, 0));
    const auto armpit = findFork(body.surface, arm, trunk, pathPoint(arm, 0.75), out, 0.4);
    if (!armpit)
        throw Error("cannot fit a skeleton: no armpit found where the " + sidePrefix(side) +
                    " arm leaves the trunk; give a landmark for " + name);
    const glm::dvec3 above = armpit->point + glm::dvec3(0.0, 0.02, 0.0);
    const auto cut = body.surface.sectionAt(above, {1, 0, 0}, 0.03);
    if (!cut)
        throw Error("cannot fit a skeleton: no shoulder found above the armpit; give a landmark "
                    "for " +
                    name);
    const double top = std::min(cut->high(1), armpit->point.y + 0.13);
    const double inside = armpit->point.x - std::copysign(part::kShoulderInside, armpit->point.x);
    placed.place(name,
                 {inside, glm::mix(armpit->point.y, top, part::kShoulderUp),
                  cut->centre.z + part::kShoulderAhead},
                 "above the armpit");
}

/// The surface's farthest point along the hand.
glm::dvec3 armTip(const FitBody& body, const BodyBranches::Path& arm) {
    const glm::dvec3 end = arm.back();
    const glm::dvec3 outwards = glm::normalize(end - pathPoint(arm, 0.8));
    glm::dvec3 tip = end;
    double farthest = 0.0;
    for (const glm::dvec3& p : body.surface.points()) {
        const double along = glm::dot(p - end, outwards);
        const double away = glm::distance(p, end);
        if (along <= farthest || away > part::kHand || along < 0.7 * away) continue;
        farthest = along;
        tip = p;
    }
    return tip;
}

/// The arm's middle line beyond the shoulder joint, with the arc length along it.
struct MiddleLine {
    std::vector<glm::dvec3> points;
    std::vector<double> arcs;   ///< arc length from the shoulder, one for each point
    std::vector<double> girths; ///< 0 at both ends

    MiddleLine(const std::vector<Section>& sections, const glm::dvec3& shoulder,
               const glm::dvec3& tip) {
        add(shoulder, 0.0);
        for (const Section& section : sections)
            // The first sections are not as deep as the joint.
            if (glm::dot(section.centre - shoulder, tip - shoulder) > 0.0)
                add(section.centre, section.girth);
        add(tip, 0.0);
    }
    double length() const { return arcs.back(); }

    glm::dvec3 at(double arc) const {
        for (std::size_t i = 1; i < arcs.size(); ++i)
            if (arc <= arcs[i] && arcs[i] > arcs[i - 1])
                return glm::mix(points[i - 1], points[i],
                                (arc - arcs[i - 1]) / (arcs[i] - arcs[i - 1]));
        return points.back();
    }

private:
    void add(const glm::dvec3& point, double girth) {
        arcs.push_back(points.empty() ? 0.0 : arcs.back() + glm::distance(points.back(), point));
        points.push_back(point);
        girths.push_back(girth);
    }
};

/// Arc length to the thinnest section beyond which the arm soon widens to a hand.
std::optional<double> arcToWrist(const MiddleLine& line) {
    constexpr double kSoon = 0.05, kWider = 1.12;
    std::optional<std::size_t> best;
    for (std::size_t i = 1; i + 1 < line.points.size(); ++i) {
        if (line.arcs[i] < 0.55 * line.length() || line.arcs[i] > 0.85 * line.length()) continue;
        if (best && line.girths[i] >= line.girths[*best]) continue;
        for (std::size_t k = i + 1; k + 1 < line.points.size(); ++k)
            if (line.arcs[k] < line.arcs[i] + kSoon && line.girths[k] > kWider * line.girths[i])
                best = i;
    }
    if (!best) return std::nullopt;
    return line.arcs[*best] + part::kWristBeyondThinnest;
}

/// The elbow with which two straight bones follow the middle line best. If the arm is straight, the
/// usual proportion decides.
glm::dvec3 bend(const MiddleLine& line, double toWrist, const glm::dvec3& wrist) {
    constexpr double kProportion = part::kUpperArm / (part::kUpperArm + part::kForeArm);
    const glm::dvec3 shoulder = line.points.front();
    const auto distance2 = [](const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
        const glm::dvec3 edge = b - a;
        const double t = std::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0, 1.0);
        const glm::dvec3 off = p - a - t * edge;
        return glm::dot(off, off);
    };
    glm::dvec3 best = line.at(kProportion * toWrist);
    double least = std::numeric_limits<double>::infinity();
    for (double ratio = 0.40; ratio <= 0.66; ratio += 0.01) {
        const glm::dvec3 elbow = line.at(ratio * toWrist);
        double sum = 0.0, count = 0.0;
        for (std::size_t i = 1; i < line.points.size() && line.arcs[i] < toWrist; ++i) {
            sum += std::min(distance2(line.points[i], shoulder, elbow),
                            distance2(line.points[i], elbow, wrist));
            count += 1.0;
        }
        const double doubt = 0.08 * (ratio - kProportion);
        const double cost = sum / std::max(count, 1.0) + doubt * doubt;
        if (cost >= least) continue;
        least = cost;
        best = elbow;
    }
    return best;
}

void placeElbowAndWrist(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const std::string elbow = sidePrefix(side) + "ForeArm", hand = sidePrefix(side) + "Hand";
    const glm::dvec3 shoulder = placed.at(sidePrefix(side) + "Arm");
    const BodyBranches::Path& arm = body.branches.arms[side];
    if (arm.empty()) { // only landmarks are known
        placed.place(elbow,
                     glm::mix(shoulder, placed.at(hand),
                              part::kUpperArm / (part::kUpperArm + part::kForeArm)),
                     "share of the arm");
        return;
    }
    BodyBranches::Path whole = arm;
    whole.push_back(armTip(body, arm)); // medial curves end in the hand
    const MiddleLine line(limbSections(body.surface, whole), shoulder, whole.back());
    const auto found = arcToWrist(line);
    double toWrist = found.value_or(line.length() * (kArm - part::kHand) / kArm);
    const glm::dvec3 wrist = placed.place(hand, line.at(toWrist),
                                          found ? "at the thinnest section" : "share of the arm");
    // A landmark may have placed the wrist elsewhere along the line.
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < line.points.size(); ++i)
        if (glm::distance(line.points[i], wrist) < nearest) {
            nearest = glm::distance(line.points[i], wrist);
            toWrist = line.arcs[i];
        }
    placed.place(elbow, bend(line, toWrist, wrist), "bend of the arm");
}

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
        // The cone excludes the thigh beside a hanging hand.
        if (length > kReach || glm::dot(d, outwards) < 0.7 * length || length <= farthest) continue;
        farthest = length;
        tip = p;
    }
    return tip;
}

} // namespace

void placeArm(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    placeShoulder(body, side, placed);
    placeElbowAndWrist(body, side, placed);

    // The inner end of the collar bone is as high as the shoulder, in front of the spine.
    const glm::dvec3 shoulder = placed.at(sidePrefix(side) + "Arm");
    const glm::dvec3 middle = placed.at("Spine1");
    const double aside = std::copysign(part::kCollarAside, shoulder.x - middle.x);
    glm::dvec3 collar(middle.x + aside, shoulder.y, middle.z);
    if (const auto cut = body.surface.sectionAt(collar, {1, 0, 0}, 0.05)) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& p : cut->points)
            if (std::abs(p.y - collar.y) < 0.02) {
                low = std::min(low, p.z);
                high = std::max(high, p.z);
            }
        if (low < high) collar.z = glm::mix(low, high, part::kCollarDepth);
    }
    placed.place(sidePrefix(side) + "Shoulder", collar, "beside the breast bone");
}

void placeHand(const FitBody& body, std::size_t side, PlacedJoints& placed) {
    const std::string& prefix = sidePrefix(side);
    const glm::dvec3 elbow = placed.at(prefix + "ForeArm"), wrist = placed.at(prefix + "Hand");
    const glm::dvec3 tip = fingerTip(body, elbow, wrist);
    const glm::dvec3 toTip = tip - wrist;
    const auto along = [&](double fraction) { return wrist + fraction * toTip; };
    // A hand is flat and fingers are curved, so take the middle of the section, which is inside.
    const auto within = [&](double fraction) {
        const auto section = body.surface.sectionAt(along(fraction), glm::normalize(toTip), 0.03);
        return section ? section->centre : along(fraction);
    };
    placed.place(prefix + "FingerBase", within(part::kFingerBase), "share of the hand");
    placed.place(prefix + "HandIndex1", within(part::kFingers), "share of the hand");
    placed.setTip(prefix + "HandIndex1", tip);

    // Thumbs point forward, whether the palm faces down or the thigh.
    const glm::dvec3 axis = glm::normalize(toTip);
    glm::dvec3 ahead = glm::dvec3(0, 0, 1) - axis.z * axis;
    ahead = glm::length(ahead) > 0.2 ? glm::normalize(ahead) : glm::dvec3(0.0);
    const std::string thumb = side == 0 ? "LThumb" : "RThumb";
    const glm::dvec3 root =
        placed.place(thumb, along(part::kThumb) + part::kThumbAside * ahead, "ahead in the hand");
    placed.setTip(thumb, root + 0.25 * toTip + part::kThumbAside * ahead);
}

} // namespace osgSkin
