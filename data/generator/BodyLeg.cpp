// SPDX-License-Identifier: MIT
#include "BodyLeg.h"

#include "BodyFoot.h"
#include "BodyParts.h"

namespace mannequin {
namespace {

// Bone 0 is the thigh, bone 1 the shank.
const std::vector<LimbSection> kSections = {

    {0, -0.14, 0, 0, 0.040, 0.040, 0.030, 0.040},    {0, -0.06, 0, 0, 0.066, 0.070, 0.045, 0.064},
    {0, 0.02, 0, 0, 0.083, 0.090, 0.058, 0.077},     {0, 0.10, 0, 0, 0.094, 0.100, 0.069, 0.082},
    {0, 0.20, 0, 0, 0.100, 0.101, 0.077, 0.085},     {0, 0.35, 0, 0, 0.100, 0.091, 0.080, 0.085},
    {0, 0.50, 0, 0, 0.095, 0.086, 0.076, 0.080},     {0, 0.70, 0, 0, 0.080, 0.077, 0.068, 0.069},
    {0, 0.85, 0, 0, 0.067, 0.068, 0.062, 0.059},     {1, 0.00, 0, 0, 0.060, 0.058, 0.056, 0.055},
    {1, 0.08, 0, 0, 0.056, 0.059, 0.054, 0.054},     {1, 0.20, 0, 0, 0.050, 0.070, 0.055, 0.054},
    {1, 0.30, 0, 0, 0.047, 0.077, 0.057, 0.056},     {1, 0.45, 0, 0, 0.043, 0.071, 0.051, 0.052},
    {1, 0.60, 0, 0, 0.038, 0.055, 0.043, 0.044},     {1, 0.75, 0, 0, 0.035, 0.043, 0.036, 0.036},
    {1, 0.88, 0, 0, 0.034, 0.038, 0.034, 0.034},     {1, 1.00, 0, 0, 0.038, 0.038, 0.034, 0.035},
    {1, 1.10, 0.008, 0, 0.032, 0.026, 0.026, 0.027},
};

} // namespace

Sculpture sculptLeg() {
    const glm::dvec3 knee = jointCentre("LeftLeg");
    const glm::dvec3 ankle = jointCentre("LeftFoot");
    Sculpture leg;
    leg.add(limbLoft({jointCentre("LeftUpLeg"), knee, ankle}, kSections), 0);
    leg.add(Ellipsoid{knee + glm::dvec3(0, 0.012, 0.046), {0.025, 0.033, 0.018}}, 0.025);
    // Vastus medialis and lateralis, above the knee.
    leg.add(Ellipsoid{knee + glm::dvec3(-0.032, 0.075, 0.030), {0.026, 0.045, 0.030}}, 0.030);
    leg.add(Ellipsoid{knee + glm::dvec3(0.030, 0.100, 0.026), {0.026, 0.055, 0.030}}, 0.030);
    // The two heads of the gastrocnemius.
    leg.add(Ellipsoid{knee + glm::dvec3(-0.024, -0.125, -0.046), {0.030, 0.075, 0.034}}, 0.025);
    leg.add(Ellipsoid{knee + glm::dvec3(0.030, -0.110, -0.044), {0.028, 0.070, 0.032}}, 0.025);
    // Malleoli.
    leg.add(Ellipsoid{ankle + glm::dvec3(-0.031, 0.010, 0.004), {0.011, 0.016, 0.015}}, 0.010);
    leg.add(Ellipsoid{ankle + glm::dvec3(0.031, -0.002, -0.006), {0.011, 0.016, 0.015}}, 0.010);
    sculptFoot(leg);
    return leg;
}

} // namespace mannequin
