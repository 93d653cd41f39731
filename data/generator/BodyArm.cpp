// SPDX-License-Identifier: MIT
#include "BodyArm.h"

#include "BodyHand.h"
#include "BodyParts.h"

namespace mannequin {
namespace {

// Bone 0 is the upper arm, bone 1 the forearm. Biceps and thumb are in front; the inner side faces
// the trunk.
const std::vector<LimbSection> kSections = {

    {0, -0.05, 0, 0, 0.046, 0.048, 0.046, 0.040}, {0, 0.10, 0, 0, 0.050, 0.052, 0.049, 0.050},
    {0, 0.30, 0, 0, 0.051, 0.052, 0.046, 0.051},  {0, 0.50, 0, 0, 0.054, 0.052, 0.046, 0.047},
    {0, 0.65, 0, 0, 0.051, 0.050, 0.044, 0.044},  {0, 0.85, 0, 0, 0.043, 0.045, 0.044, 0.043},
    {1, 0.02, 0, 0, 0.042, 0.043, 0.046, 0.046},  {1, 0.18, 0, 0, 0.048, 0.044, 0.046, 0.049},
    {1, 0.35, 0, 0, 0.047, 0.042, 0.042, 0.045},  {1, 0.55, 0, 0, 0.039, 0.037, 0.035, 0.035},
    {1, 0.75, 0, 0, 0.032, 0.031, 0.027, 0.027},  {1, 0.90, 0, 0, 0.029, 0.029, 0.022, 0.022},
    {1, 1.00, 0, 0, 0.029, 0.029, 0.021, 0.021},  {1, 1.08, 0, 0, 0.030, 0.030, 0.019, 0.019},
};

} // namespace

Sculpture sculptArm() {
    const glm::dvec3 shoulder = jointCentre("LeftArm");
    const glm::dvec3 elbow = jointCentre("LeftForeArm");
    Sculpture arm;
    arm.add(limbLoft({shoulder, elbow, jointCentre("LeftHand")}, kSections), 0);
    // Deltoid: its front, side and back heads meet on the outside of the upper arm.
    const glm::dvec3 along = elbow - shoulder;
    const glm::dvec3 insertion = shoulder + along * 0.46 + glm::dvec3(0.003, 0.004, 0);
    arm.add(RoundCone{shoulder + glm::dvec3(0.008, 0.010, 0.020), insertion, 0.046, 0.030}, 0.040);
    arm.add(RoundCone{shoulder + glm::dvec3(0.012, 0.012, 0), insertion, 0.051, 0.030}, 0.040);
    arm.add(RoundCone{shoulder + glm::dvec3(0.005, 0.005, -0.022), insertion, 0.046, 0.030}, 0.040);
    // Olecranon.
    arm.add(Ellipsoid{elbow + glm::dvec3(0, 0.002, -0.034), {0.018, 0.018, 0.014}}, 0.020);
    sculptHand(arm);
    return arm;
}

} // namespace mannequin
