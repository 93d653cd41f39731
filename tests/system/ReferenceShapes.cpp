// SPDX-License-Identifier: MIT
#include "ReferenceShapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

namespace test {
namespace {

double softly(double t) {
    return t < 0.9 ? t : 0.9 + 0.1 * std::tanh(10.0 * t - 9.0);
}

/// The i-th B-spline of a degree, by the textbook recursion.
double spline(const std::vector<double>& t, std::size_t i, int degree, double x) {
    if (degree == 0) return t[i] <= x && x < t[i + 1] ? 1.0 : 0.0;
    const auto d = static_cast<std::size_t>(degree);
    double sum = 0.0;
    if (t[i + d] > t[i]) sum += (x - t[i]) / (t[i + d] - t[i]) * spline(t, i, degree - 1, x);
    if (t[i + d + 1] > t[i + 1])
        sum += (t[i + d + 1] - x) / (t[i + d + 1] - t[i + 1]) * spline(t, i + 1, degree - 1, x);
    return sum;
}

std::vector<double> splines(const std::vector<double>& knots, double x) {
    std::vector<double> t = knots; // each end knot three times
    t.insert(t.begin(), 2, knots.front());
    t.insert(t.end(), 2, knots.back());
    std::vector<double> values;
    for (std::size_t i = 0; i + 3 < t.size(); ++i) values.push_back(spline(t, i, 2, x));
    return values;
}

} // namespace

ReferenceShapes::ReferenceShapes(const nlohmann::json& json)
    : _basis(json["basis"].get<std::string>()),
      _joint(json[isInput() ? "input" : "joint"].get<std::string>()),
      _low(json["low"][0], json["low"][1]), _high(json["high"][0], json["high"][1]),
      _coefficients(json["coefficients"].get<std::vector<std::vector<double>>>()) {
    if (isInput()) return;
    _axis = {json["axis"][0], json["axis"][1], json["axis"][2]};
    _knots = json["knots"].get<std::vector<double>>();
}

std::vector<double> ReferenceShapes::functions(double x, double y) const {
    if (_basis == "ball")
        return {x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
    if (_basis == "hinge") {
        std::vector<double> values = splines(_knots, x);
        const std::vector<double> atRest = splines(_knots, 0.0);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] -= atRest[i];
        for (const double more : {y, x * y, y * y}) values.push_back(more);
        return values;
    }
    if (_basis == "turned_hinge") {
        const std::vector<double> now = splines(_knots, x), atRest = splines(_knots, 0.0);
        std::vector<double> values;
        for (std::size_t i = 0; i < now.size(); ++i)
            for (const double each : {now[i] - atRest[i], now[i] * y, now[i] * y * y})
                values.push_back(each);
        return values;
    }
    const std::vector<double> now = splines(_knots, x * x + y * y), atRest = splines(_knots, 0.0);
    std::vector<double> values;
    for (std::size_t i = 0; i < now.size(); ++i) {
        values.push_back(now[i] - atRest[i]);
        for (int n = 1; n <= 3; ++n) {
            const std::complex<double> power = std::pow(std::complex<double>(x, y), n);
            values.push_back(now[i] * power.real());
            values.push_back(now[i] * power.imag());
        }
    }
    return values;
}

std::vector<double> ReferenceShapes::weights(const glm::dvec3& v, double psi,
                                             const glm::dvec3& w) const {
    double x = std::sin(psi / 2) * glm::dot(v, _axis);
    double y = std::sin(psi / 2) * glm::dot(v, glm::cross(w, _axis));
    const double endX = x > 0 ? _high.x : _low.x, endY = y > 0 ? _high.y : _low.y;
    if (_basis == "hinge" || _basis == "turned_hinge") {
        x = softly(x / endX) * endX;
        y = softly(y / endY) * endY;
    } else if (const double r = std::hypot(x / endX, y / endY); r > 0) {
        x *= softly(r) / r;
        y *= softly(r) / r;
    }
    return sums(functions(x, y));
}

std::vector<double> ReferenceShapes::weights(double input) const {
    return sums({std::min(_high.x, std::max(_low.x, input))});
}

std::vector<double> ReferenceShapes::sums(const std::vector<double>& phi) const {
    std::vector<double> result;
    for (const std::vector<double>& row : _coefficients) {
        result.push_back(0.0);
        for (std::size_t i = 0; i < row.size(); ++i) result.back() += row[i] * phi.at(i);
    }
    return result;
}

} // namespace test
