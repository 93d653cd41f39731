// SPDX-License-Identifier: MIT
#include "arms/ArmTurns.h"

#include <osgSkinCharacter/AvoidBody>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

constexpr std::size_t kUnknowns = 6;         ///< of a sample: three for each arm
constexpr std::size_t kBand = 3 * kUnknowns; ///< a sample depends on three coefficients
constexpr double kShares[] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0}; ///< of them

// Weights of squares. Lengths count in arm lengths, rotations in radians.
constexpr double kDepth = 10000.0, kTurn = 1.0, kTwist = 8.0, kWay = 4.0, kTouch = 100000.0;
constexpr double kSmooth = 0.16; ///< seconds; its fourth power weighs second derivatives

constexpr int kSteps = 10;
constexpr double kLongestStep = 0.35; ///< radians
constexpr double kEnough = 1e-3;      ///< relative gain that ends the steps

glm::dmat3 crossMatrix(const glm::dvec3& v) {
    return {0.0, v.z, -v.y, -v.z, 0.0, v.x, v.y, -v.x, 0.0};
}

/// A rotation vector in the direction of `value`, shorter than AvoidBodyReport::kMaxDegrees, which
/// it approaches softly. How it changes with `value` goes to `slope`.
glm::dvec3 limited(const glm::dvec3& value, glm::dmat3& slope) {
    const glm::dvec3 part = value / glm::radians(AvoidBodyReport::kMaxDegrees);
    const double square = glm::dot(part, part), whole = 1.0 + square * square;
    const double ratio = std::pow(whole, -0.25);
    slope = ratio * (glm::dmat3(1.0) - square / whole * glm::outerProduct(part, part));
    return ratio * value;
}

/// The rotation matrix of a rotation vector. Its angular change by change of the vector, the left
/// Jacobian, goes to `angular`.
glm::dmat3 rotationBy(const glm::dvec3& vector, glm::dmat3& angular) {
    const double a = std::max(glm::length(vector), 1e-4);
    const glm::dmat3 k = crossMatrix(vector), one(1.0);
    const double first = std::sin(a) / a, second = (1.0 - std::cos(a)) / (a * a);
    angular = one + second * k + (1.0 - first) / (a * a) * (k * k);
    return one + first * k + second * (k * k);
}

} // namespace

/// The energy of one sample, its first and second derivatives.
struct ArmTurns::Energy {
    double value = 0.0;
    std::array<double, kUnknowns> slope{};
    std::array<std::array<double, kUnknowns>, kUnknowns> curve{};

    /// Adds half the square of a residual times a weight.
    /// \param change of the residual with each unknown
    void add(double weight, double residual, const std::array<double, kUnknowns>& change) {
        value += 0.5 * weight * residual * residual;
        for (std::size_t i = 0; i < kUnknowns; ++i) {
            slope[i] += weight * residual * change[i];
            for (std::size_t k = 0; k < kUnknowns; ++k)
                curve[i][k] += weight * change[i] * change[k];
        }
    }
    void add(double weight, double residual, std::size_t arm, const glm::dvec3& change) {
        std::array<double, kUnknowns> all{};
        for (std::size_t i = 0; i < 3; ++i) all[3 * arm + i] = change[int(i)];
        add(weight, residual, all);
    }
};

/// A symmetric banded system of equations.
struct ArmTurns::System {
    double value = 0.0; ///< of the energy
    std::vector<double> slope;
    std::vector<std::array<double, kBand>> rows; ///< [i][d]: column i - d

    explicit System(std::size_t size) : slope(size, 0.0), rows(size) {}

    /// The step against the slope, with the diagonal enlarged by a factor: by Cholesky's method.
    std::vector<double> step(double damping) const {
        std::vector<std::array<double, kBand>> low = rows;
        std::vector<double> result(slope.size());
        for (std::size_t i = 0; i < low.size(); ++i) {
            low[i][0] *= 1.0 + damping;
            result[i] = -slope[i];
            const std::size_t first = i < kBand ? 0 : i - kBand + 1;
            for (std::size_t j = first; j < i; ++j) {
                double& at = low[i][i - j];
                for (std::size_t k = first; k < j; ++k) at -= low[i][i - k] * low[j][j - k];
                at /= low[j][0];
                low[i][0] -= at * at;
                result[i] -= at * result[j];
            }
            low[i][0] = std::sqrt(std::max(low[i][0], 1e-12));
            result[i] /= low[i][0];
        }
        for (std::size_t i = low.size(); i-- > 0;) {
            for (std::size_t j = i + 1; j < std::min(low.size(), i + kBand); ++j)
                result[i] -= low[j][j - i] * result[j];
            result[i] /= low[i][0];
        }
        return result;
    }
};

std::size_t ArmTurns::clamped(std::ptrdiff_t sample) const {
    return std::size_t(std::clamp<std::ptrdiff_t>(sample, 0, std::ptrdiff_t(_samples.size()) - 1));
}

ArmTurns::Energy ArmTurns::energyAt(std::size_t at) const {
    const ArmSample& sample = _samples[at];
    const double unit = 1.0 / (_length * _length);
    Energy result;
    std::array<glm::dvec3, 2> ways;
    std::array<glm::dmat3, 2> changes;
    for (std::size_t s = 0; s < 2; ++s) {
        const ArmSample::Arm& arm = sample.arms[s];
        glm::dvec3 value(0.0);
        for (std::size_t k = 0; k < 3; ++k)
            value += kShares[k] * _coefficients[clamped(std::ptrdiff_t(at + k) - 1)][s];
        glm::dmat3 slope, angular;
        const glm::dmat3 own = rotationBy(limited(value, slope), angular);
        const glm::dmat3 turn = arm.above * own * glm::transpose(arm.above);
        angular = arm.above * angular * slope;
        for (const ArmSample::Near& near : arm.near) {
            const glm::dvec3 lever = turn * (near.place - arm.shoulder);
            const FieldSample found = _fields.at(near.field, sample.maps, arm.shoulder + lever);
            if (near.margin > found.distance)
                result.add(kDepth * unit, near.margin - found.distance, s,
                           glm::cross(found.outward, lever) * angular);
        }
        const glm::dvec3 palm = arm.palm - arm.shoulder;
        ways[s] = turn * palm - palm;
        changes[s] = glm::transpose(crossMatrix(turn * palm)) * angular;
        for (int i = 0; i < 3; ++i) {
            glm::dvec3 axis(0.0);
            axis[i] = 1.0;
            result.add(kTurn, value[i], s, axis);
            result.add(kWay * unit, ways[s][i], s, axis * changes[s]);
        }
        result.add(kTwist - kTurn, glm::dot(arm.axis, value), s, arm.axis);
    }
    for (int i = 0; i < 3 && sample.touch > 0.0; ++i) {
        std::array<double, kUnknowns> change{};
        for (int k = 0; k < 3; ++k) {
            change[std::size_t(k)] = changes[0][k][i];
            change[std::size_t(k) + 3] = -changes[1][k][i];
        }
        result.add(kTouch * unit * sample.touch, ways[0][i] - ways[1][i], change);
    }
    return result;
}

ArmTurns::System ArmTurns::assemble(std::size_t first, std::size_t end) const {
    System system((end - first) * kUnknowns);
    // Adds an energy of three successive coefficients, each of which takes part by its share.
    const auto add = [&](std::ptrdiff_t before, const double(&shares)[3], const Energy& energy) {
        system.value += energy.value;
        for (std::ptrdiff_t a = 0; a < 3; ++a)
            for (std::ptrdiff_t b = 0; b < 3; ++b) {
                const std::size_t i = clamped(before + a), j = clamped(before + b);
                if (i < first || i >= end) continue;
                const std::size_t row = (i - first) * kUnknowns;
                for (std::size_t u = 0; u < kUnknowns; ++u) {
                    if (b == 0) system.slope[row + u] += shares[a] * energy.slope[u];
                    if (j < first || j > i) continue;
                    for (std::size_t v = 0; v < (j < i ? kUnknowns : u + 1); ++v)
                        system.rows[row + u][(i - j) * kUnknowns + u - v] +=
                            shares[a] * shares[b] * energy.curve[u][v];
                }
            }
    };
    constexpr double kSecond[] = {1.0, -2.0, 1.0};
    const std::size_t from = first < 2 ? 0 : first - 2;
    for (std::size_t k = from; k <= std::min(end, _samples.size() - 1); ++k) {
        add(std::ptrdiff_t(k) - 1, kShares, energyAt(k));
        if (k + 2 >= _samples.size()) continue;
        Energy bend;
        for (std::size_t u = 0; u < kUnknowns; ++u) {
            std::array<double, kUnknowns> one{};
            one[u] = 1.0;
            double sum = 0.0;
            for (std::size_t i = 0; i < 3; ++i)
                sum += kSecond[i] * _coefficients[k + i][u / 3][int(u % 3)];
            bend.add(std::pow(kSmooth / _interval, 4.0), sum, one);
        }
        add(std::ptrdiff_t(k), kSecond, bend);
    }
    for (std::size_t i = 0; i < system.slope.size(); ++i)
        if (!_samples[first + i / kUnknowns].arms[i % kUnknowns / 3].isFree)
            system.rows[i][0] += 1e12; // stays
    return system;
}

void ArmTurns::solve(std::size_t first, std::size_t end) {
    System system = assemble(first, end);
    double damping = 1e-3;
    for (int k = 0; k < kSteps; ++k) {
        const std::vector<ArmPair> before = _coefficients;
        const double value = system.value;
        bool falls = false;
        for (int attempt = 0; attempt < 4 && !falls; ++attempt) {
            const std::vector<double> step = system.step(damping);
            double longest = kLongestStep;
            for (const double s : step) longest = std::max(longest, std::abs(s));
            for (std::size_t i = 0; i < step.size(); ++i) {
                const std::size_t sample = first + i / kUnknowns, arm = i % kUnknowns / 3;
                if (_samples[sample].arms[arm].isFree)
                    _coefficients[sample][arm][int(i % 3)] =
                        before[sample][arm][int(i % 3)] + kLongestStep / longest * step[i];
            }
            System next = assemble(first, end);
            falls = next.value < value;
            damping = falls ? std::max(0.2 * damping, 1e-5) : std::max(8.0 * damping, 1e-3);
            if (falls) system = std::move(next);
        }
        if (!falls) _coefficients = before;
        if (!falls || value - system.value < kEnough * value) return;
    }
}

void ArmTurns::solve() {
    const auto isFree = [](const ArmSample& sample) {
        return sample.arms[0].isFree || sample.arms[1].isFree;
    };
    const auto begin = _samples.begin();
    for (auto end = begin; end != _samples.end();) {
        const auto first = std::find_if(end, _samples.end(), isFree);
        end = std::find_if_not(first, _samples.end(), isFree);
        if (first != end) solve(std::size_t(first - begin), std::size_t(end - begin));
    }
}

ArmPair ArmTurns::at(double place) const {
    const auto before = std::ptrdiff_t(place);
    const double s = place - double(before), t = 1.0 - s;
    const double shares[] = {t * t * t, 3.0 * s * s * s - 6.0 * s * s + 4.0,
                             3.0 * t * t * t - 6.0 * t * t + 4.0, s * s * s};
    ArmPair result;
    for (std::size_t arm = 0; arm < 2; ++arm) {
        glm::dvec3 sum(0.0);
        for (std::ptrdiff_t k = 0; k < 4; ++k)
            sum += shares[k] / 6.0 * _coefficients[clamped(before + k - 1)][arm];
        glm::dmat3 unused;
        result[arm] = limited(sum, unused);
    }
    return result;
}

} // namespace osgSkin
