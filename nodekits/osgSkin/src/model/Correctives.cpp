// SPDX-License-Identifier: MIT
#include <osgSkin/Correctives>

#include "model/CorrectiveBlocks.h"

#include <osgSkin/Binding>
#include <osgSkin/Error>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgSkin {
namespace {

/// Number of quadratic B-splines over ascending knots, the first and last of which count three
/// times; 0 for fewer than two knots.
std::size_t splineCount(const std::vector<double>& knots) noexcept {
    return knots.size() < 2 ? 0 : knots.size() + 1;
}

/// The values of all splineCount() splines at x, clamped to the knots. They add up to 1.
void evaluateSplines(const std::vector<double>& knots, double x, double* values) noexcept {
    const std::size_t count = splineCount(knots);
    if (count == 0) return;
    std::fill_n(values, count, 0.0);
    double three[3];
    const std::size_t first = splinesAt(knots, x, three);
    std::copy_n(three, 3, values + first);
}

using Basis = CorrectiveJoint::Basis;

/// Where the soft clamp leaves the identity.
constexpr double kStraight = 0.9;
constexpr double kSoft = 1.0 - kStraight;

/// t for t <= kStraight, then towards 1 and never beyond: two continuous derivatives.
double softClamp(double t) noexcept {
    return t <= kStraight ? t : kStraight + kSoft * std::tanh((t - kStraight) / kSoft);
}

/// A coordinate as a fraction of the range sampled on its side; not negative.
double shareOf(double x, double low, double high) noexcept {
    return x > 0.0 ? x / high : x / low;
}

double clampedAlone(double x, double low, double high) noexcept {
    return softClamp(shareOf(x, low, high)) * (x > 0.0 ? high : low);
}

/// False for NaN.
bool areInRange(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](double x) { return std::abs(x) <= kLargestCoordinate; });
}

void checkKnots(const CorrectiveJoint& joint, const std::string& place) {
    if (joint.basis == Basis::Ball) {
        if (!joint.knots.empty()) throw Error(place + ": a ball joint must not have knots");
        return;
    }
    if (joint.knots.size() < 2 || joint.knots.size() > CorrectiveJoint::kMaxKnots)
        throw Error(place + " have " + std::to_string(joint.knots.size()) +
                    " knots, expected 2 to " + std::to_string(CorrectiveJoint::kMaxKnots));
    for (std::size_t i = 0; i < joint.knots.size(); ++i)
        if (!std::isfinite(joint.knots[i]) ||
            (i > 0 && !(joint.knots[i] - joint.knots[i - 1] >= 1e-6)))
            throw Error(place + ": knots must ascend");
}

/// Rejects NaN.
void checkRange(const CorrectiveJoint& joint, const std::string& place) {
    for (int axis = 0; axis < 2; ++axis)
        if (!(joint.low[axis] < -1e-6 && joint.low[axis] > -2.0 && joint.high[axis] > 1e-6 &&
              joint.high[axis] < 2.0))
            throw Error(place + " have a range that does not reach from below 0 to above it");
}

void checkBend(const CorrectiveJoint& joint, const BoundJoint& of, const std::string& place) {
    if (!(std::abs(glm::dot(joint.axis, joint.axis) - 1.0) < 1e-6) ||
        !(std::abs(glm::dot(joint.axis, of.twistAxis)) < 1e-6))
        throw Error(place +
                    " have an axis that is not a unit vector perpendicular to the twist axis");
    checkRange(joint, place);
    checkKnots(joint, place);
}

/// Rejects NaN.
void checkInput(const CorrectiveJoint& joint, const std::string& place) {
    if (!(joint.low.x >= -2.0 && joint.low.x <= 0.0 && joint.high.x > 0.0 && joint.high.x <= 2.0))
        throw Error(place + " have a range that does not hold 0, or is beyond -2 to 2");
    if (!joint.knots.empty()) throw Error(place + ": an input must not have knots");
}

void checkJoint(const CorrectiveJoint& joint, const Correctives& correctives,
                const std::vector<BoundJoint>& bound) {
    const bool hasNormals = correctives.hasNormals();
    const bool input = joint.basis == Basis::Input;
    if (joint.joint >= (input ? correctives.inputs.size() : bound.size()))
        throw Error(std::string("correctives: ") + (input ? "input " : "joint ") +
                    std::to_string(joint.joint) + " is not there");
    const std::string place = "correctives: those of " +
                              (input ? "input \"" + correctives.inputs[joint.joint]
                                     : "joint \"" + bound[joint.joint].name) +
                              "\"";
    if (joint.basis > Basis::TurnedHinge) throw Error(place + " have functions of an unknown kind");
    if (input)
        checkInput(joint, place);
    else
        checkBend(joint, bound[joint.joint], place);
    if (joint.modes < 1 || joint.modes > CorrectiveJoint::kMaxModes)
        throw Error(place + " have " + std::to_string(joint.modes) + " modes, expected 1 to " +
                    std::to_string(CorrectiveJoint::kMaxModes));
    if (joint.coefficients.size() != joint.modes * joint.functionCount())
        throw Error(place + " need a coefficient for each mode and function");
    if (joint.normalScales.size() != (hasNormals ? joint.modes : 0))
        throw Error(place + " need a scale of normals for each mode, or none of them");
    if (!areInRange(joint.coefficients) || !areInRange(joint.normalScales))
        throw Error(place + " have a coefficient that is not finite, or beyond -1e18 to 1e18");
}

} // namespace

std::size_t splinesAt(const std::vector<double>& knots, double x, double (&values)[3]) noexcept {
    const std::size_t last = knots.size() - 1;
    x = std::clamp(x, knots.front(), knots.back());
    std::size_t span = 0;
    while (span + 1 < last && x >= knots[span + 1]) ++span;
    const auto knot = [&](std::size_t i, int shift) { // end knots count three times
        const auto at = static_cast<std::ptrdiff_t>(i) + shift;
        return knots[static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(last)))];
    };
    // Cox and de Boor's recursion, from the one spline of degree 0 that is not 0 here.
    const double low = knot(span, 0), high = knot(span, 1);
    const double up = (x - low) / (high - low);
    const double before = knot(span, -1), behind = knot(span, 2);
    const double left = (high - x) / (high - before), right = (behind - x) / (behind - low);
    values[0] = left * (1.0 - up);
    values[1] = (1.0 - left) * (1.0 - up) + right * up;
    values[2] = (1.0 - right) * up;
    return span;
}

std::size_t CorrectiveJoint::functionCount() const noexcept {
    switch (basis) {
    case Basis::Hinge:
        return splineCount(knots) + 3;
    case Basis::TurnedHinge:
        return 3 * splineCount(knots);
    case Basis::Ball:
        return 9;
    case Basis::Round:
        return 7 * splineCount(knots);
    case Basis::Input:
        return 1;
    }
    return 0;
}

glm::dvec2 CorrectiveJoint::coordinates(const glm::dvec3& v, double psi,
                                        const glm::dvec3& w) const noexcept {
    const double sine = std::sin(0.5 * psi);
    return {sine * glm::dot(v, axis), sine * glm::dot(v, glm::cross(w, axis))};
}

glm::dvec2 CorrectiveJoint::clamped(glm::dvec2 xy) const noexcept {
    if (basis == Basis::Input) return {glm::clamp(xy.x, low.x, high.x), 0.0};
    if (basis == Basis::Hinge || basis == Basis::TurnedHinge)
        return {clampedAlone(xy.x, low.x, high.x), clampedAlone(xy.y, low.y, high.y)};
    const double r =
        glm::length(glm::dvec2(shareOf(xy.x, low.x, high.x), shareOf(xy.y, low.y, high.y)));
    return r <= kStraight ? xy : xy * (softClamp(r) / r);
}

void CorrectiveJoint::evaluate(glm::dvec2 clampedXy, Functions& phi) const noexcept {
    const double x = clampedXy.x, y = clampedXy.y;
    const std::size_t splines = splineCount(knots);
    switch (basis) {
    case Basis::Hinge: {
        double atRest[kMaxKnots + 1];
        evaluateSplines(knots, x, phi.data());
        evaluateSplines(knots, 0.0, atRest);
        for (std::size_t i = 0; i < splines; ++i) phi[i] -= atRest[i];
        phi[splines] = y;
        phi[splines + 1] = x * y;
        phi[splines + 2] = y * y;
        return;
    }
    case Basis::TurnedHinge: {
        double now[kMaxKnots + 1], atRest[kMaxKnots + 1];
        evaluateSplines(knots, x, now);
        evaluateSplines(knots, 0.0, atRest);
        for (std::size_t i = 0; i < splines; ++i) {
            phi[3 * i] = now[i] - atRest[i];
            phi[3 * i + 1] = now[i] * y;
            phi[3 * i + 2] = now[i] * y * y;
        }
        return;
    }
    case Basis::Ball: {
        const double all[] = {x,         y,         x * x,     x * y,    y * y,
                              x * x * x, x * x * y, x * y * y, y * y * y};
        for (std::size_t i = 0; i < 9; ++i) phi[i] = all[i];
        return;
    }
    case Basis::Round: {
        double now[kMaxKnots + 1], atRest[kMaxKnots + 1];
        evaluateSplines(knots, x * x + y * y, now);
        evaluateSplines(knots, 0.0, atRest);
        for (std::size_t i = 0; i < splines; ++i) {
            double* of = &phi[7 * i];
            of[0] = now[i] - atRest[i];
            of[1] = now[i] * x;
            of[2] = now[i] * y;
            of[3] = now[i] * (x * x - y * y);
            of[4] = now[i] * 2.0 * x * y;
            of[5] = now[i] * x * (x * x - 3.0 * y * y);
            of[6] = now[i] * y * (3.0 * x * x - y * y);
        }
        return;
    }
    case Basis::Input:
        phi[0] = x;
        return;
    }
}

void CorrectiveJoint::weights(glm::dvec2 xy, double* beta) const noexcept {
    Functions phi;
    evaluate(clamped(xy), phi);
    const std::size_t functions = functionCount();
    const double* row = coefficients.data();
    for (std::size_t k = 0; k < modes; ++k) beta[k] = 0.0;
    for (std::size_t i = 0; i < functions; ++i, ++row) // interleaves the modes' sums
        for (std::size_t k = 0; k < modes; ++k) beta[k] += row[k * functions] * phi[i];
}

void Correctives::validate(const std::vector<BoundJoint>& bound, std::size_t vertexCount) const {
    if (firstEntry.empty() && entries.empty() && joints.empty() && shares.empty() &&
        normalShares.empty() && inputs.empty())
        return;
    if (joints.size() > kMaxJoints)
        throw Error("correctives: " + std::to_string(joints.size()) + " joints, expected at most " +
                    std::to_string(kMaxJoints));
    if (inputs.size() > kMaxJoints)
        throw Error("correctives: " + std::to_string(inputs.size()) + " inputs, expected at most " +
                    std::to_string(kMaxJoints));
    if (std::set<std::string>(inputs.begin(), inputs.end()).size() != inputs.size())
        throw Error("correctives: two inputs have one name");
    for (const CorrectiveJoint& joint : joints) checkJoint(joint, *this, bound);
    if (hasNormals() && normalShares.size() != shares.size())
        throw Error("correctives: expected as many shares of normals as of positions, or none");
    if (firstEntry.size() != vertexCount + 1 || firstEntry.front() != 0 ||
        firstEntry.back() != entries.size())
        throw Error("correctives: the entries' offsets do not fit the vertices");
    for (const std::vector<std::int16_t>* list : {&shares, &normalShares})
        if (std::find(list->begin(), list->end(), std::int16_t(-kUnit - 1)) != list->end())
            throw Error("correctives: a share is less than " + std::to_string(-kUnit));
    for (std::size_t v = 0; v < vertexCount; ++v) {
        const std::string place = "correctives: vertex " + std::to_string(v);
        if (firstEntry[v] > firstEntry[v + 1] || firstEntry[v + 1] > entries.size())
            throw Error(place + " has entries that are not there");
        for (std::uint32_t i = firstEntry[v]; i < firstEntry[v + 1]; ++i) {
            if (entries[i].joint >= joints.size()) throw Error(place + " names no joint's modes");
            if (i > firstEntry[v] && entries[i].joint <= entries[i - 1].joint)
                throw Error(place + " lists its joints out of order");
            if (entries[i].firstShare > shares.size() ||
                shares.size() - entries[i].firstShare < sharesOf(entries[i].joint))
                throw Error(place + ": share index out of range");
        }
    }
}

} // namespace osgSkin
