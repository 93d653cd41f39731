// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/FitBody.h"

#include "fit/body/FacingClues.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// Clues that add up to less than this say nothing.
constexpr double kFacingThreshold = 0.012;

/// Fractions of the whole fit's time before and after the curves are looked for.
constexpr double kCurvesBegin = 0.2;
constexpr double kCurvesEnd = 0.85;

/// Rows x, y, z: the rotation that makes `up` the y axis and rotates little else.
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

/// Proportions are those of a person's height: a cartoon's is taken from its neck.
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

/// The line between left and right limbs, horizontal: by hips and shoulders, as hands and feet may
/// be anywhere. From right to left where `left` tells which is which.
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
            throw Error("cannot fit a skeleton: expected a facing across the line from the right "
                        "limbs to the left ones, found one along it");
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

/// RMS distance of the skin's mirror image in the plane through (x, 0, 0), whose normal is the x
/// axis rotated by `angle` about y, to the skin.
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

/// Rotates and moves the body until its mirror image fits best: a descent with shrinking steps.
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
        angle = 0.0; // a posed body: hips and shoulders know better
        x = hips;
    }
    move(yaw(glm::dvec3(std::sin(angle), 0.0, std::cos(angle))), glm::dvec3(x, 0.0, 0.0));
}

} // namespace osgSkin
