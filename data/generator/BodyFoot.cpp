// SPDX-License-Identifier: MIT
#include "BodyFoot.h"

#include "BodyParts.h"

#include <glm/geometric.hpp>

namespace mannequin {
namespace {

/// A vertical cross-section of the foot: distance from the heel, breadth on both sides of the
/// foot's axis, and the heights of the widest point and of the instep.
struct Level {
    double t, inner, outer, widest, top;
};

const Level kLevels[] = {
    {0.012, 0.024, 0.025, 0.026, 0.050}, {0.030, 0.031, 0.032, 0.028, 0.075},
    {0.055, 0.033, 0.034, 0.030, 0.095}, {0.085, 0.033, 0.034, 0.030, 0.097},
    {0.110, 0.034, 0.037, 0.028, 0.086}, {0.140, 0.039, 0.043, 0.024, 0.066},
    {0.170, 0.046, 0.048, 0.020, 0.051}, {0.200, 0.049, 0.050, 0.017, 0.038},
    {0.218, 0.045, 0.045, 0.015, 0.030},
};

} // namespace

void sculptFoot(Sculpture& leg) {
    const glm::dvec3 ankle = jointCentre("LeftFoot");
    glm::dvec3 forward = jointCentre("LeftToeBase") - ankle;
    forward.y = 0;
    forward = glm::normalize(forward);
    glm::dvec3 heel = ankle - forward * 0.048;
    heel.y = 0;
    const glm::dvec3 up(0, 1, 0);
    const LoftFrame frame = LoftFrame::make(heel, forward, glm::cross(up, forward)); // u: outward
    std::vector<LoftSection> sections;
    for (const Level& l : kLevels) // v points up
        sections.push_back(
            {l.t, 0, l.widest, l.outer, l.inner, l.top - l.widest, l.widest + 0.006, 2.3});
    leg.add(Loft(frame, sections), 0.025);

    const auto at = [&](double t, double outward, double y) {
        return heel + forward * t + frame.u * outward + up * y;
    };
    leg.add(Ellipsoid{at(0.032, 0, 0.034), {0.033, 0.042, 0.037}}, 0.025);
    // Toes, starting with the big toe.
    leg.add(RoundCone{at(0.205, -0.029, 0.019), at(0.262, -0.025, 0.0135), 0.0175, 0.0135}, 0.010);
    leg.add(RoundCone{at(0.210, -0.005, 0.017), at(0.262, -0.001, 0.0110), 0.0120, 0.0095}, 0.007);
    leg.add(RoundCone{at(0.206, 0.011, 0.016), at(0.253, 0.016, 0.0105), 0.0115, 0.0090}, 0.007);
    leg.add(RoundCone{at(0.200, 0.025, 0.015), at(0.241, 0.031, 0.0100), 0.0110, 0.0085}, 0.007);
    leg.add(RoundCone{at(0.190, 0.037, 0.014), at(0.226, 0.043, 0.0095), 0.0105, 0.0085}, 0.007);
    // The floor flattens the sole.
    leg.carve(RoundCone{at(0.1, 0, -10), at(0.101, 0, -10), 10, 10}, 0.012);
}

} // namespace mannequin
