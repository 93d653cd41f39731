// SPDX-License-Identifier: MIT
#include "Loft.h"
#include "Primitives.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {

LoftFrame LoftFrame::make(const glm::dvec3& origin, const glm::dvec3& axis,
                          const glm::dvec3& uHint) {
    const glm::dvec3 a = glm::normalize(axis);
    const glm::dvec3 u = glm::normalize(uHint - a * glm::dot(uHint, a));
    return {origin, a, u, glm::cross(a, u)};
}

Loft::Loft(const LoftFrame& frame, const std::vector<LoftSection>& sections) : _frame(frame) {
    for (const LoftSection& s : sections) {
        _t.push_back(s.t);
        _values.push_back({s.centreU, s.centreV, s.plusU, s.minusU, s.plusV, s.minusV, s.power});
    }
    // Central differences give the surface a continuous tangent plane.
    _slopes.resize(_t.size());
    for (std::size_t i = 0; i < _t.size(); ++i) {
        const std::size_t before = i == 0 ? 0 : i - 1;
        const std::size_t after = std::min(i + 1, _t.size() - 1);
        for (std::size_t c = 0; c < _slopes[i].size(); ++c)
            _slopes[i][c] = (_values[after][c] - _values[before][c]) / (_t[after] - _t[before]);
    }
}

Loft::Channels Loft::interpolated(double t) const {
    if (t <= _t.front()) return _values.front();
    if (t >= _t.back()) return _values.back();
    const auto upper = std::upper_bound(_t.begin(), _t.end(), t);
    const auto i = static_cast<std::size_t>(upper - _t.begin()) - 1;
    const double span = _t[i + 1] - _t[i];
    const double s = (t - _t[i]) / span;
    const double s2 = s * s, s3 = s2 * s;
    Channels result{};
    for (std::size_t c = 0; c < result.size(); ++c) // cubic Hermite
        result[c] = (2 * s3 - 3 * s2 + 1) * _values[i][c] + (3 * s2 - 2 * s3) * _values[i + 1][c] +
                    span * ((s3 - 2 * s2 + s) * _slopes[i][c] + (s3 - s2) * _slopes[i + 1][c]);
    return result;
}

double Loft::distance(const glm::dvec3& point) const {
    const glm::dvec3 local = point - _frame.origin;
    const double t = glm::dot(local, _frame.axis);
    const auto [centreU, centreV, plusU, minusU, plusV, minusV, power] = interpolated(t);
    const double u = glm::dot(local, _frame.u) - centreU;
    const double v = glm::dot(local, _frame.v) - centreV;
    const double radiusU = u < 0 ? minusU : plusU, radiusV = v < 0 ? minusV : plusV;
    const double relative = std::pow(
        std::pow(std::abs(u) / radiusU, power) + std::pow(std::abs(v) / radiusV, power), 1 / power);
    // Blend the radial distance, which is accurate outside, with one that is continuous at the
    // centre.
    const double radial = relative < 1e-9 ? 0 : std::hypot(u, v) / relative;
    const double inner = std::min({plusU, minusU, plusV, minusV});
    const double weight = std::min(relative * relative, 1.0);
    const double side = (relative - 1) * (weight * radial + (1 - weight) * inner);
    const double kRounding = 0.01; // metres, at the cut ends
    return smoothMax(side, std::max(_t.front() - t, t - _t.back()), kRounding);
}

} // namespace mannequin
