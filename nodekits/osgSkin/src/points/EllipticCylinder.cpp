// SPDX-License-Identifier: MIT
#include "points/EllipticCylinder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// Eigenvectors of a symmetric matrix, by Jacobi's rotations; enough of them for a choice of axes.
glm::mat3 principalAxes(glm::mat3 m) {
    glm::mat3 axes(1.0f);
    for (int sweep = 0; sweep < 4; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                const float angle = 0.5f * std::atan2(2.0f * m[p][q], m[q][q] - m[p][p]);
                glm::mat3 turn(1.0f);
                turn[p][p] = turn[q][q] = std::cos(angle);
                turn[q][p] = std::sin(angle);
                turn[p][q] = -turn[q][p];
                m = glm::transpose(turn) * m * turn;
                axes = axes * turn;
            }
    return axes;
}

glm::mat3 covariance(const std::vector<glm::vec3>& points) {
    glm::vec3 mean(0.0f);
    for (const glm::vec3& p : points) mean += p / static_cast<float>(points.size());
    glm::mat3 sum(0.0f);
    for (const glm::vec3& p : points) sum += glm::outerProduct(p - mean, p - mean);
    return sum;
}

/// The one whose straight axis is axes[2].
EllipticCylinder cylinderAlong(const glm::mat3& axes, const std::vector<glm::vec3>& points) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& p : points) {
        low = glm::min(low, p * axes);
        high = glm::max(high, p * axes);
    }
    const glm::vec3 middle = 0.5f * (low + high);
    const glm::vec3 half =
        glm::max(0.5f * (high - low), glm::vec3(std::numeric_limits<float>::min()));
    float wide = 0.0f, tall = 0.0f; // against `half`
    for (const glm::vec3& p : points) {
        const glm::vec3 at = (p * axes - middle) / half;
        wide = std::max(wide, at.x * at.x + at.y * at.y);
        tall = std::max(tall, std::abs(at.z));
    }
    // A little more, for what single precision rounds off.
    wide = 1.00001f * std::sqrt(wide);
    tall *= 1.00001f;
    EllipticCylinder result{
        axes * middle, {wide * half.x * axes[0], wide * half.y * axes[1], tall * half.z * axes[2]}};
    // What is next to nothing would make denormal numbers of products, which are slow.
    const float nothing = 1e-9f * result.radius();
    for (glm::vec3& axis : result.axes)
        for (int i = 0; i < 3; ++i)
            if (std::abs(axis[i]) < nothing) axis[i] = 0.0f;
    return result;
}

/// Its volume, but so that flat ones differ, too.
float sizeOf(const EllipticCylinder& c, float least) {
    return (glm::length(c.axes[0]) + least) * (glm::length(c.axes[1]) + least) *
           (1.2732f * glm::length(c.axes[2]) + least);
}

} // namespace

float EllipticCylinder::reach(const glm::vec3& direction) const {
    const float x = glm::dot(direction, axes[0]), y = glm::dot(direction, axes[1]);
    return std::sqrt(x * x + y * y) + std::abs(glm::dot(direction, axes[2]));
}

float EllipticCylinder::radius() const {
    const float wide = std::max(glm::dot(axes[0], axes[0]), glm::dot(axes[1], axes[1]));
    return std::sqrt(wide + glm::dot(axes[2], axes[2]));
}

EllipticCylinder cylinderAround(const std::vector<glm::vec3>& points) {
    const glm::mat3 axes = principalAxes(covariance(points));
    EllipticCylinder best = cylinderAlong(axes, points);
    const float least = 0.1f * best.radius();
    for (int turn = 1; turn < 3; ++turn) {
        const EllipticCylinder other =
            cylinderAlong({axes[turn % 3], axes[(turn + 1) % 3], axes[(turn + 2) % 3]}, points);
        // Not for the sake of rounding errors: the choice is the same however sums are rounded.
        if (sizeOf(other, least) < 0.9999f * sizeOf(best, least)) best = other;
    }
    return best;
}

} // namespace osgSkin
