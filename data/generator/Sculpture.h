// SPDX-License-Identifier: MIT
#pragma once

#include "Loft.h"
#include "Primitives.h"

#include <variant>
#include <vector>

namespace mannequin {

using Primitive = std::variant<RoundCone, Ellipsoid, Loft>;

/// Signed distance to any primitive, negative inside.
double distanceTo(const Primitive& primitive, const glm::dvec3& point);

/// A solid made by adding and carving primitives in order. Each is blended over a given width into
/// the result so far.
class Sculpture {
public:
    void add(Primitive primitive, double width);
    void carve(Primitive primitive, double width);

    /// Adds a primitive and its mirror image in one step, which keeps the result symmetric.
    void addPair(Primitive primitive, double width);
    void carvePair(Primitive primitive, double width);

    /// Estimate of the signed distance, negative inside.
    double distance(const glm::dvec3& point) const;

private:
    struct Step {
        Primitive primitive;
        double width;
        bool carved;
        bool paired;
    };
    std::vector<Step> _steps;
};

} // namespace mannequin
