// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/FitBody.h"

#include "fit/body/BodyBranches.h"
#include "fit/body/FitSurface.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace osgSkin {
namespace {

/// How far forward (+z) a standing body seems to face, in heights; negative if it faces -z.
struct FacingClues {
    double feet = 0.0;   ///< toes ahead of the ankles
    double head = 0.0;   ///< face overhanging the neck
    double elbows = 0.0; ///< elbows behind the line from shoulder to hand
    double sum() const { return feet + head + elbows; }
    std::string strongest() const {
        const double most = std::max({std::abs(feet), std::abs(head), std::abs(elbows)});
        if (most == std::abs(feet)) return "from the feet";
        return most == std::abs(head) ? "from the face" : "from the elbows";
    }
};

/// How far the middle of the feet is ahead of the shins.
double feetAhead(const FitSurface& surface, const BodyBranches& branches) {
    double result = 0.0;
    for (const BodyBranches::Path& leg : branches.legs) {
        if (leg.empty()) continue;
        // The curve may end along the foot, so take the last point that is high.
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

/// How much farther chin and nose overhang the neck than the back of the head does.
double faceAhead(const FitSurface& surface, const BodyBranches& branches) {
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

FacingClues facingClues(const FitSurface& surface, const BodyBranches& branches) {
    return {feetAhead(surface, branches), faceAhead(surface, branches), elbowsBehind(branches)};
}

/// A smaller sum of clues is inconclusive.
constexpr double kFacingThreshold = 0.012;

/// Fractions of the whole fit's time at which finding the curves begins and ends.
constexpr double kCurvesBegin = 0.2;
constexpr double kCurvesEnd = 0.85;

/// The rotation that makes `up` the y axis and rotates as little as possible; rows x, y, z.
glm::dmat3 standUp(const glm::dvec3& up) {
    const glm::dvec3 y = glm::normalize(up);
    // A body with z up usually faces -y; one with y up faces +z.
    const glm::dvec3 ahead = std::abs(y.z) > 0.9 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 x = glm::normalize(glm::cross(y, ahead));
    return glm::transpose(glm::dmat3(x, y, glm::cross(x, y)));
}

/// Rotation about y that brings the horizontal unit direction `ahead` to +z.
glm::dmat3 yaw(const glm::dvec3& ahead) {
    const glm::dvec3 y(0, 1, 0);
    const glm::dvec3 x = glm::cross(y, ahead);
    return glm::transpose(glm::dmat3(x, y, ahead));
}

} // namespace

FitBody::FitBody(const WeldedMesh& mesh, const fit::SolidGrid* filled, const FitOptions& options,
                 bool legsGiven, bool armsGiven, std::vector<std::string>& notes)
    : surface(mesh, filled, notes) {
    const glm::dmat3 rotation = standUp(options.up);
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec3& p : surface.points()) {
        low = glm::min(low, rotation * p);
        high = glm::max(high, rotation * p);
    }
    const double tall = high.y - low.y;
    if (!(tall > 0.0) || std::max(high.x - low.x, high.z - low.z) > 1.6 * tall)
        throw Error("cannot fit a skeleton: expected an upright body, found one that is wider "
                    "than tall along its up axis");
    if (std::min(high.x - low.x, high.z - low.z) < 0.05 * tall)
        throw Error("cannot fit a skeleton: expected a body with a volume, found a flat one");
    _rotation = rotation;
    _origin = glm::transpose(rotation) *
              glm::dvec3(0.5 * (low.x + high.x), low.y, 0.5 * (low.z + high.z));
    _scale = 1.0 / tall;
    surface.transform(_rotation, _origin, _scale);
    const auto tell = [&options](double fraction) {
        if (options.progress)
            options.progress(
                {"medial curves", kCurvesBegin + fraction * (kCurvesEnd - kCurvesBegin)});
    };
    tell(0.0);
    branches = BodyBranches::find(surface.curveSkeleton(tell), legsGiven, armsGiven);
    shrinkHead(notes);
}

/// Proportions are relative to a person's height, so that of a cartoon is derived from its neck.
void FitBody::shrinkHead(std::vector<std::string>& notes) {
    constexpr double kLargeHead = 0.80, kNeck = 0.87, kWider = 1.3;
    if (branches.arms[0].empty()) return;
    const double from = std::min(branches.arms[0].front().y, branches.arms[1].front().y);
    double neck = 1.0, least = std::numeric_limits<double>::infinity(), above = 0.0;
    for (double y = from; y < 0.95; y += 0.005) {
        glm::dvec3 at = branches.trunk.front();
        for (const glm::dvec3& p : branches.trunk)
            if (p.y > y) at = p;
        at.y = y;
        const auto section = surface.sectionAt(at, {0, 1, 0}, 0.1);
        if (!section) continue;
        above = std::max(above, section->area);
        if (section->area >= least) continue;
        least = above = section->area;
        neck = y;
    }
    if (neck > kLargeHead || above < kWider * least) return;
    const double scale = kNeck / neck;
    surface.transform(glm::dmat3(1.0), glm::dvec3(0.0), scale);
    branches.transform(glm::dmat3(scale), glm::dvec3(0.0));
    _scale *= scale;
    _top = scale;
    notes.push_back("a large head: the neck is at " + std::to_string(std::lround(100.0 * neck)) +
                    " % of the height");
}

void FitBody::move(const glm::dmat3& rotation, const glm::dvec3& origin) {
    surface.transform(rotation, origin, 1.0);
    branches.transform(rotation, origin);
    _origin += glm::transpose(_rotation) * (origin / _scale);
    _rotation = rotation * _rotation;
}

/// The horizontal direction between left and right limbs: by hips and shoulders, as hands and feet
/// may be anywhere. It points to the left if `left` is given.
glm::dvec3 FitBody::lateral(const std::optional<glm::dvec3>& left) const {
    const auto across = [&](const std::array<BodyBranches::Path, 2>& limbs, double fraction) {
        if (limbs[0].empty() || limbs[1].empty()) return glm::dvec3(0.0);
        return pathPoint(limbs[0], fraction) - pathPoint(limbs[1], fraction);
    };
    glm::dvec3 sum = across(branches.legs, 0.4) + across(branches.arms, 0.3);
    sum.y = 0.0;
    if (left) {
        glm::dvec3 given = _rotation * *left;
        given.y = 0.0;
        if (glm::length(sum) < 0.05) sum = given;
        if (glm::dot(sum, given) < 0.0) sum = -sum;
    }
    if (!(glm::length(sum) > 1e-6))
        throw Error("cannot fit a skeleton: left and right limbs do not stand apart");
    return glm::normalize(sum);
}

void FitBody::faceBackwards() {
    move(glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1), glm::dvec3(0.0));
}

std::string FitBody::face(const std::optional<glm::dvec3>& facing,
                          const std::optional<glm::dvec3>& left) {
    glm::dvec3 ahead = glm::cross(lateral(left), glm::dvec3(0, 1, 0));
    if (facing) {
        const glm::dvec3 given = _rotation * *facing;
        if (std::abs(glm::dot(given, ahead)) < 0.5 * glm::length(given))
            throw Error(
                "cannot fit a skeleton: `facing` must be perpendicular to the left-right axis");
        if (left && glm::dot(given, ahead) < 0.0)
            throw Error("cannot fit a skeleton: landmarks and facing disagree on which side is "
                        "the left one");
        if (glm::dot(given, ahead) < 0.0) ahead = -ahead;
    } else if (!left && ahead.z < 0.0) {
        ahead = -ahead; // start with the usual direction
    }
    move(yaw(ahead), glm::dvec3(0.0));
    refineSymmetry();
    std::string how = facing ? "as given" : "from the landmarks";
    if (!facing && !left) {
        const FacingClues clues = facingClues(surface, branches);
        if (clues.sum() < -kFacingThreshold) faceBackwards();
        how = std::abs(clues.sum()) < kFacingThreshold ? "assumed" : clues.strongest();
    }
    branches.sortSides();
    return how;
}

/// RMS distance between the skin and its mirror image in the plane through (x, 0, 0) whose normal
/// is the x axis rotated by `angle` about y.
double FitBody::mirrorError(double angle, double x) const {
    const glm::dvec3 normal(std::cos(angle), 0.0, -std::sin(angle));
    const std::vector<glm::dvec3>& points = surface.points();
    const std::size_t step = points.size() / 400 + 1;
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const glm::dvec3 d = points[i] - glm::dvec3(x, 0.0, 0.0);
        const glm::dvec3 mirrored = points[i] - 2.0 * glm::dot(d, normal) * normal;
        const glm::dvec3 off = mirrored - surface.nearest(mirrored);
        sum += glm::dot(off, off);
        count += 1.0;
    }
    return std::sqrt(sum / count);
}

/// Rotates and moves the body so that its mirror image fits best: a descent with shrinking steps.
void FitBody::refineSymmetry() {
    double hips = 0.0;
    for (const BodyBranches::Path& leg : branches.legs)
        hips += 0.5 * (leg.empty() ? branches.trunk.back() : pathPoint(leg, 0.4)).x;
    double angle = 0.0, x = hips;
    double error = mirrorError(angle, x);
    double angleStep = 0.08, moveStep = 0.02;
    while (angleStep > 5e-4) {
        bool better = false;
        const double tries[][2] = {{angle + angleStep, x},
                                   {angle - angleStep, x},
                                   {angle, x + moveStep},
                                   {angle, x - moveStep}};
        for (const auto& [newAngle, newX] : tries) {
            const double newError = mirrorError(newAngle, newX);
            if (newError >= error) continue;
            error = newError;
            angle = newAngle;
            x = newX;
            better = true;
            break;
        }
        if (!better) {
            angleStep *= 0.5;
            moveStep *= 0.5;
        }
    }
    symmetryError = error;
    if (!isSymmetric()) {
        angle = 0.0; // a posed body: keep the result of hips and shoulders
        x = hips;
    }
    move(yaw(glm::dvec3(std::sin(angle), 0.0, std::cos(angle))), glm::dvec3(x, 0.0, 0.0));
}

} // namespace osgSkin
