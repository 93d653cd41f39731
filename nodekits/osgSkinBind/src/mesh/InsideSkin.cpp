// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/InsideSkin.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// Sums angles. Small ones, told by their tangents, are multiplied as complex numbers: an arc
/// tangent costs as much as all the rest.
class AngleSum {
public:
    void add(double sine, double cosine) {
        if (!(std::abs(sine) < kSmall * cosine)) {
            _sum += std::atan2(sine, cosine);
            return;
        }
        const double tangent = sine / cosine, imaginary = _imaginary + _real * tangent;
        _real -= _imaginary * tangent;
        _imaginary = imaginary;
        if (++_count == kMost) flush();
    }
    double value() {
        flush();
        return _sum;
    }

private:
    static constexpr double kSmall = 0.3;
    static constexpr int kMost = 10; ///< less than half a turn together

    void flush() {
        _sum += std::atan2(_imaginary, _real);
        _real = 1.0;
        _imaginary = 0.0;
        _count = 0;
    }

    double _sum = 0.0, _real = 1.0, _imaginary = 0.0;
    int _count = 0;
};

} // namespace

bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point) {
    AngleSum halves;
    for (const auto& t : mesh.triangles) {
        // The triangle's solid angle by van Oosterom and Strackee (1983).
        const glm::dvec3 a = mesh.positions[t[0]] - point;
        const glm::dvec3 b = mesh.positions[t[1]] - point;
        const glm::dvec3 c = mesh.positions[t[2]] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        const double numerator = glm::dot(a, glm::cross(b, c));
        const double denominator =
            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
        halves.add(numerator, denominator);
    }
    // Half of a half sphere's solid angle.
    constexpr double kLeast = 3.141592653589793;
    return std::abs(halves.value()) > kLeast;
}

} // namespace osgSkin
