// SPDX-License-Identifier: MIT
#include "Sculpture.h"

#include <utility>

namespace mannequin {

double distanceTo(const Primitive& primitive, const glm::dvec3& point) {
    return std::visit([&point](const auto& shape) { return shape.distance(point); }, primitive);
}

void Sculpture::add(Primitive primitive, double width) {
    _steps.push_back({std::move(primitive), width, false, false});
}

void Sculpture::carve(Primitive primitive, double width) {
    _steps.push_back({std::move(primitive), width, true, false});
}

void Sculpture::addPair(Primitive primitive, double width) {
    _steps.push_back({std::move(primitive), width, false, true});
}

void Sculpture::carvePair(Primitive primitive, double width) {
    _steps.push_back({std::move(primitive), width, true, true});
}

double Sculpture::distance(const glm::dvec3& point) const {
    double result = 1; // metres: far away
    for (const Step& step : _steps) {
        double d = distanceTo(step.primitive, point);
        if (step.paired)
            d = smoothMin(d, distanceTo(step.primitive, mannequin::mirrored(point)), step.width);
        result = step.carved ? smoothMax(result, -d, step.width) : smoothMin(result, d, step.width);
    }
    return result;
}

} // namespace mannequin
