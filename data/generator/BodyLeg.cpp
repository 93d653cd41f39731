// SPDX-License-Identifier: MIT
#include "BodyParts.h"

namespace mannequin {
namespace {

// Bone 0 is the thigh, bone 1 the shank.
const std::vector<LimbSection> kSections = {
    {0, -0.05, 0, 0, 0.078, 0.085, 0.055, 0.074}, {0, 0.10, 0, 0, 0.088, 0.100, 0.076, 0.086},
    {0, 0.20, 0, 0, 0.097, 0.100, 0.081, 0.087},  {0, 0.35, 0, 0, 0.099, 0.090, 0.079, 0.083},
    {0, 0.50, 0, 0, 0.095, 0.086, 0.076, 0.079},  {0, 0.70, 0, 0, 0.080, 0.077, 0.068, 0.069},
    {0, 0.85, 0, 0, 0.067, 0.068, 0.062, 0.059},  {1, 0.00, 0, 0, 0.060, 0.058, 0.056, 0.055},
    {1, 0.08, 0, 0, 0.056, 0.059, 0.054, 0.054},  {1, 0.20, 0, 0, 0.050, 0.071, 0.056, 0.055},
    {1, 0.30, 0, 0, 0.047, 0.079, 0.058, 0.057},  {1, 0.45, 0, 0, 0.043, 0.072, 0.052, 0.053},
    {1, 0.60, 0, 0, 0.038, 0.055, 0.043, 0.044},  {1, 0.75, 0, 0, 0.034, 0.044, 0.035, 0.036},
    {1, 0.88, 0, 0, 0.033, 0.041, 0.032, 0.034},  {1, 1.00, 0, 0, 0.038, 0.042, 0.034, 0.035},
    {1, 1.06, 0, 0, 0.040, 0.040, 0.033, 0.034},
};

} // namespace

Sculpture sculptLeg() {
    const glm::dvec3 knee = jointCentre("LeftLeg");
    const glm::dvec3 ankle = jointCentre("LeftFoot");
    Sculpture leg;
    leg.add(limbLoft({jointCentre("LeftUpLeg"), knee, ankle}, kSections), 0);
    leg.add(Ellipsoid{knee + glm::dvec3(0, 0.012, 0.047), {0.026, 0.032, 0.020}}, 0.020);
    // Vastus medialis and lateralis, above the knee.
    leg.add(Ellipsoid{knee + glm::dvec3(-0.032, 0.075, 0.030), {0.026, 0.045, 0.030}}, 0.030);
    leg.add(Ellipsoid{knee + glm::dvec3(0.030, 0.100, 0.026), {0.026, 0.055, 0.030}}, 0.030);
    // The two heads of the gastrocnemius.
    leg.add(Ellipsoid{knee + glm::dvec3(-0.024, -0.125, -0.046), {0.030, 0.075, 0.034}}, 0.025);
    leg.add(Ellipsoid{knee + glm::dvec3(0.030, -0.110, -0.044), {0.028, 0.070, 0.032}}, 0.025);
    // Malleoli.
    leg.add(Ellipsoid{ankle + glm::dvec3(-0.030, 0.008, 0.004), {0.010, 0.015, 0.014}}, 0.012);
    leg.add(Ellipsoid{ankle + glm::dvec3(0.030, -0.004, -0.006), {0.010, 0.015, 0.014}}, 0.012);
    sculptFoot(leg);
    return leg;
}

} // namespace mannequin
