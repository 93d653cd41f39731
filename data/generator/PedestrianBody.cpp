// SPDX-License-Identifier: MIT
#include "PedestrianBody.h"

#include "BodyHand.h"
#include "BodyHead.h"
#include "BodyParts.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

/// A horizontal cross-section: half its breadth, and its outline along z.
struct Level {
    double y, halfBreadth, back, widest, front, power;
};

const Level kJacket[] = {

    {0.885, 0.176, -0.140, -0.008, 0.116, 2.4}, {0.905, 0.180, -0.143, -0.008, 0.121, 2.4}, // hem
    {0.960, 0.178, -0.139, -0.008, 0.124, 2.4}, {1.020, 0.173, -0.126, -0.006, 0.124, 2.4},
    {1.100, 0.168, -0.114, -0.004, 0.122, 2.4}, {1.200, 0.171, -0.120, -0.008, 0.125, 2.4},
    {1.280, 0.177, -0.132, -0.014, 0.131, 2.4}, {1.340, 0.180, -0.141, -0.020, 0.131, 2.4},
    {1.390, 0.177, -0.146, -0.030, 0.119, 2.4}, {1.425, 0.163, -0.143, -0.036, 0.098, 2.3},
    {1.455, 0.133, -0.131, -0.040, 0.070, 2.2}, {1.485, 0.094, -0.116, -0.042, 0.040, 2.0},
    {1.510, 0.070, -0.104, -0.044, 0.022, 2.0},
};

const Level kSeat[] = {

    {0.838, 0.040, -0.060, -0.010, 0.040, 2.0}, {0.862, 0.118, -0.108, -0.010, 0.082, 2.1},
    {0.890, 0.153, -0.124, -0.010, 0.098, 2.2}, {0.940, 0.161, -0.124, -0.010, 0.104, 2.3},
    {1.000, 0.158, -0.112, -0.008, 0.104, 2.3},
};

template <std::size_t N>
Loft upright(const Level (&levels)[N]) {
    std::vector<LoftSection> sections;
    for (const Level& l : levels) // v points backward
        sections.push_back({l.y, 0, -l.widest, l.halfBreadth, l.halfBreadth, l.widest - l.back,
                            l.front - l.widest, l.power});
    return {LoftFrame::make({0, 0, 0}, {0, 1, 0}, {1, 0, 0}), sections};
}

// Bone 0 is the upper arm, bone 1 the forearm.
const std::vector<LimbSection> kSleeve = {

    {0, -0.08, 0, 0, 0.056, 0.058, 0.050, 0.052}, {0, 0.10, 0, 0, 0.063, 0.064, 0.060, 0.061},
    {0, 0.30, 0, 0, 0.062, 0.063, 0.058, 0.061},  {0, 0.60, 0, 0, 0.058, 0.059, 0.054, 0.055},
    {0, 0.90, 0, 0, 0.053, 0.055, 0.053, 0.052},  {1, 0.05, 0, 0, 0.052, 0.054, 0.054, 0.054},
    {1, 0.30, 0, 0, 0.052, 0.051, 0.050, 0.051},  {1, 0.60, 0, 0, 0.046, 0.046, 0.044, 0.044},
    {1, 0.85, 0, 0, 0.042, 0.042, 0.039, 0.039},  {1, 0.99, 0, 0, 0.040, 0.040, 0.036, 0.036},
    {1, 1.04, 0, 0, 0.031, 0.031, 0.025, 0.025},  {1, 1.12, 0, 0, 0.029, 0.029, 0.020, 0.020},
};

// Bone 0 is the thigh, bone 1 the shank.
const std::vector<LimbSection> kTrouserLeg = {

    {0, -0.08, 0, 0, 0.070, 0.074, 0.050, 0.066}, {0, 0.04, 0, 0, 0.092, 0.104, 0.070, 0.085},
    {0, 0.15, 0, 0, 0.101, 0.110, 0.079, 0.089},  {0, 0.30, 0, 0, 0.100, 0.103, 0.080, 0.088},
    {0, 0.50, 0, 0, 0.092, 0.093, 0.076, 0.083},  {0, 0.75, 0, 0, 0.080, 0.081, 0.070, 0.074},
    {1, 0.00, 0, 0, 0.073, 0.073, 0.067, 0.069},  {1, 0.20, 0, 0, 0.070, 0.075, 0.064, 0.066},
    {1, 0.45, 0, 0, 0.067, 0.073, 0.062, 0.063},  {1, 0.70, 0, 0, 0.065, 0.068, 0.059, 0.060},
    {1, 0.88, 0, 0, 0.066, 0.068, 0.059, 0.060},  {1, 0.95, 0, 0, 0.066, 0.066, 0.058, 0.059},
    {1, 0.99, 0, 0, 0.052, 0.046, 0.044, 0.045},  {1, 1.10, 0, 0, 0.046, 0.040, 0.040, 0.041},
};

/// A vertical cross-section of a shoe: distance from below the ankle, breadth on both sides of its
/// axis, and the heights of the widest point and of its top.
struct ShoeLevel {
    double t, inner, outer, widest, top;
};

const ShoeLevel kShoe[] = {
    {-0.060, 0.026, 0.027, 0.030, 0.066}, {-0.040, 0.036, 0.037, 0.030, 0.088},
    {-0.010, 0.040, 0.041, 0.030, 0.105}, {0.022, 0.040, 0.042, 0.030, 0.111},
    {0.055, 0.041, 0.044, 0.030, 0.104},  {0.090, 0.044, 0.048, 0.028, 0.084},
    {0.125, 0.050, 0.053, 0.026, 0.066},  {0.160, 0.053, 0.055, 0.024, 0.055},
    {0.192, 0.050, 0.051, 0.023, 0.049},  {0.218, 0.042, 0.042, 0.024, 0.046},
    {0.238, 0.028, 0.028, 0.027, 0.043},
};

struct FootAxes {
    glm::dvec3 below, forward, outward; ///< the point below the ankle; unit directions

    FootAxes() {
        const glm::dvec3 ankle = jointCentre("LeftFoot");
        forward = jointCentre("LeftToeBase") - ankle;
        forward.y = 0;
        forward = glm::normalize(forward);
        below = {ankle.x, 0, ankle.z};
        outward = glm::cross(glm::dvec3(0, 1, 0), forward);
    }
};

void sculptShoe(Sculpture& leg) {
    const FootAxes axes;
    std::vector<LoftSection> sections;
    for (const ShoeLevel& l : kShoe) // v points up
        sections.push_back(
            {l.t, 0, l.widest, l.outer, l.inner, l.top - l.widest, l.widest + 0.012, 2.6});
    leg.add(Loft(LoftFrame::make(axes.below, axes.forward, axes.outward), sections), 0.012);
    // The sole is flat, and rises behind the heel and before the tip so that the shoe can roll.
    const auto carveBelow = [&](double t, double slope) {
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3(0, 1, 0) - axes.forward * std::tan(slope));
        const glm::dvec3 deep = axes.below + axes.forward * t - 10.0 * normal;
        leg.carve(RoundCone{deep, deep + glm::dvec3(0, 0.001, 0), 10, 10}, 0.004);
    };
    carveBelow(0.08, 0);
    carveBelow(-0.044, glm::radians(-24.0));
    carveBelow(0.205, glm::radians(33.0));
}

Sculpture clothedArm() {
    const glm::dvec3 shoulder = jointCentre("LeftArm");
    const glm::dvec3 elbow = jointCentre("LeftForeArm");
    const glm::dvec3 wrist = jointCentre("LeftHand");
    Sculpture arm;
    arm.add(limbLoft({shoulder, elbow, wrist}, kSleeve), 0);
    arm.add(RoundCone{shoulder + glm::dvec3(0.004, 0.004, 0), glm::mix(shoulder, elbow, 0.35),
                      0.060, 0.058},
            0.030);
    sculptHand(arm, {0.25, 0.020});
    return arm;
}

Sculpture clothedLeg() {
    Sculpture leg;
    leg.add(limbLoft({jointCentre("LeftUpLeg"), jointCentre("LeftLeg"), jointCentre("LeftFoot")},
                     kTrouserLeg),
            0);
    sculptShoe(leg);
    return leg;
}

Sculpture jacket() {
    Sculpture result;
    result.add(upright(kJacket), 0);
    // From the collar to the shoulders, and the collar.
    result.addPair(RoundCone{{0.036, 1.508, -0.052}, {0.160, 1.452, -0.040}, 0.040, 0.050}, 0.040);
    result.add(Loft(LoftFrame::make({0, 1.440, -0.050}, {0, 0.175, 0.045}, {1, 0, 0}),
                    {{-0.02, 0, 0, 0.100, 0.100, 0.085, 0.085, 2},
                     {0.03, 0, 0, 0.080, 0.080, 0.073, 0.073, 2},
                     {0.07, 0, 0, 0.070, 0.070, 0.070, 0.070, 2},
                     {0.112, 0, 0, 0.066, 0.066, 0.070, 0.068, 2}}),
               0.020);
    return result;
}

const RoundCone kTrunkBounds{{0, 0.98, -0.01}, {0, 1.42, -0.02}, 0.21, 0.21};
const RoundCone kSeatBounds{{0, 0.90, -0.01}, {0, 0.96, -0.01}, 0.18, 0.18};
const RoundCone kHeadBounds{{0, 1.69, 0}, {0, 1.45, -0.03}, 0.15, 0.12};
const RoundCone kArmBounds{{0.19, 1.44, -0.03}, {0.70, 1.00, 0.04}, 0.11, 0.12};
const RoundCone kLegBounds{{0.09, 0.95, 0}, {0.14, 0.06, 0.05}, 0.14, 0.20};

/// Metres behind a plane through `at`; `ahead` points to its positive side.
double beyond(const glm::dvec3& point, const glm::dvec3& at, const glm::dvec3& ahead) {
    return glm::dot(point - at, glm::normalize(ahead));
}

glm::dvec3 left(const glm::dvec3& point) {
    return {std::abs(point.x), point.y, point.z};
}

double overCollar(const glm::dvec3& point) {
    return beyond(point, {0, 1.536, -0.025}, {0, 1, 0.34});
}

/// Positive where the open jacket shows the shirt.
double insideLapels(const glm::dvec3& point) {
    return (point.y - 1.365 - 1.9 * std::abs(point.x)) / std::hypot(1, 1.9);
}

double onEye(const glm::dvec3& point) {
    const RoundCone eye{{0.027, 1.6865, 0.091}, {0.040, 1.6865, 0.084}, 0.0068, 0.0064};
    return -eye.distance(left(point));
}

double onLips(const glm::dvec3& point) {
    const RoundCone lips{{0, 1.6115, 0.100}, {0.017, 1.6120, 0.096}, 0.0085, 0.0080};
    return -lips.distance(left(point));
}

double overCuff(const glm::dvec3& point) {
    const glm::dvec3 elbow = jointCentre("LeftForeArm"), wrist = jointCentre("LeftHand");
    return beyond(left(point), glm::mix(elbow, wrist, 1.005), wrist - elbow);
}

double overJacketHem(const glm::dvec3& point) {
    return beyond(point, {0, 0.892, 0}, {0, 1, 0});
}

double overTrouserHem(const glm::dvec3& point) {
    return beyond(left(point), {0.13, 0.096, -0.022}, {0, 1, -0.18});
}

double overSole(const glm::dvec3& point) {
    const FootAxes axes;
    return beyond(left(point), axes.below + glm::dvec3(0, 0.025, 0),
                  glm::dvec3(0, 1, 0) - axes.forward * 0.03);
}

bool onHead(const glm::dvec3& point) {
    return point.y > 1.40 && std::abs(point.x) < 0.13;
}
bool onFace(const glm::dvec3& point) {
    return onHead(point) && point.y > 1.59 && point.z > 0.05;
}
bool onChest(const glm::dvec3& point) {
    return point.y > 1.30 && std::abs(point.x) < 0.13 && point.z > -0.02 &&
           overCollar(point) < 0.012;
}
bool onHands(const glm::dvec3& point) {
    return std::abs(point.x) > 0.45;
}
bool onTrunk(const glm::dvec3& point) {
    return !onHands(point) && point.y > 0.5;
}
bool onFeet(const glm::dvec3& point) {
    return point.y < 0.5;
}

/// Positive on the ears and where the hair leaves them free.
double aroundEar(const glm::dvec3& point) {
    const RoundCone ear{{0.079, 1.650, -0.008}, {0.083, 1.684, -0.016}, 0.020, 0.024};
    return -ear.distance(left(point));
}

} // namespace

PedestrianBody::PedestrianBody()
    : _jacket(jacket()), _head(sculptPlainHead()), _hair(sculptHair()), _arm(clothedArm()),
      _leg(clothedLeg()) {
    _trousers.add(upright(kSeat), 0);
    _trousers.addPair(Ellipsoid{{0.075, 0.915, -0.070}, {0.080, 0.085, 0.064}}, 0.035); // buttocks
}

double PedestrianBody::distance(const glm::dvec3& point) const {
    const glm::dvec3 other = mirrored(point);
    const double legs = smoothMin(distanceWithin(_leg, point, kLegBounds),
                                  distanceWithin(_leg, other, kLegBounds), 0.010);
    const double arms =
        std::min(distanceWithin(_arm, point, kArmBounds), distanceWithin(_arm, other, kArmBounds));
    const double trousers = smoothMin(distanceWithin(_trousers, point, kSeatBounds), legs, 0.035);
    double head = distanceWithin(_head, point, kHeadBounds);
    if (head < 0.1)
        head = smoothMin(head, smoothMax(_hair.distance(point), -hairLine(point), 0.006), 0.004);
    double result = smoothMin(distanceWithin(_jacket, point, kTrunkBounds), arms, 0.040);
    result = smoothMin(result, head, 0.010);
    return smoothMin(result, trousers, 0.008);
}

glm::dvec3 PedestrianBody::lowerCorner() const {
    return {-0.86, -0.04, -0.24};
}
glm::dvec3 PedestrianBody::upperCorner() const {
    return {0.86, 1.88, 0.30};
}

DetailMap pedestrianDetail() {
    return {
        0.050,
        {
            {{{0.000, 1.690, 0.095}, {0.000, 1.640, 0.105}, 0.016, 0.024}, 0.0115},   // nose
            {{{0.018, 1.697, 0.092}, {0.046, 1.698, 0.080}, 0.013, 0.013}, 0.0066},   // eye
            {{{0.000, 1.612, 0.098}, {0.018, 1.612, 0.094}, 0.010, 0.010}, 0.0095},   // mouth
            {{{0.000, 1.360, 0.115}, {0.070, 1.490, 0.030}, 0.020, 0.020}, 0.0260},   // lapels
            {{{0.000, 1.680, 0.080}, {0.000, 1.585, 0.080}, 0.042, 0.034}, 0.0170},   // face
            {{{0.080, 1.682, -0.014}, {0.078, 1.650, -0.008}, 0.018, 0.016}, 0.0135}, // ear
            {{{0.000, 1.700, 0.000}, {0.000, 1.600, 0.030}, 0.095, 0.070}, 0.0270},   // head
            {{{0.640, 1.050, 0.020}, {0.685, 1.010, 0.030}, 0.035, 0.035}, 0.0220},   // palm
            {{{0.714, 0.990, 0.022}, {0.745, 0.940, 0.030}, 0.045, 0.045}, 0.0150},   // fingers
            {{{0.650, 1.035, 0.060}, {0.665, 1.010, 0.095}, 0.018, 0.015}, 0.0140},   // thumb
            {{{0.606, 1.080, 0.008}, {0.620, 1.068, 0.010}, 0.045, 0.040}, 0.0230},   // cuff
            {{{0.122, 0.025, -0.060}, {0.160, 0.025, 0.200}, 0.055, 0.050}, 0.0250},  // shoe
            {{{0.112, 0.510, 0.000}, {0.112, 0.520, 0.020}, 0.080, 0.080}, 0.0370},   // knee
            {{{0.420, 1.236, -0.036}, {0.421, 1.235, -0.036}, 0.065, 0.065}, 0.0300}, // elbow
            {{{0.170, 1.440, -0.030}, {0.190, 1.370, -0.030}, 0.080, 0.060}, 0.0340}, // shoulder
            {{{0.000, 1.520, -0.040}, {0.000, 1.545, -0.036}, 0.080, 0.080}, 0.0270}, // collar
            {{{0.000, 0.850, -0.070}, {0.000, 0.850, 0.060}, 0.030, 0.030}, 0.0260},  // crotch
            {{{0.090, 0.905, 0.020}, {0.090, 0.890, -0.040}, 0.120, 0.120}, 0.0420},  // jacket hem
            {{{0.130, 0.110, -0.020}, {0.130, 0.100, -0.020}, 0.075, 0.075}, 0.0320}, // trouser hem
        }};
}

namespace {

Material skinOfHead(const glm::dvec3& point) {
    if (onFace(point)) {
        if (onEye(point) > 0) return Material::Eyes;
        if (onLips(point) > 0) return Material::Lips;
    }
    return aroundEar(point) < 0 && hairLine(point) > 0 ? Material::Hair : Material::Skin;
}

} // namespace

Material materialAt(const glm::dvec3& point) {
    if (onHead(point) && overCollar(point) > 0) return skinOfHead(point);
    if (onChest(point) && insideLapels(point) > 0) return Material::Shirt;
    if (onHands(point)) return overCuff(point) > 0 ? Material::Skin : Material::Jacket;
    if (onTrunk(point)) return overJacketHem(point) > 0 ? Material::Jacket : Material::Trousers;
    if (overTrouserHem(point) > 0) return Material::Trousers;
    return overSole(point) > 0 ? Material::Shoe : Material::Sole;
}

std::vector<MaterialEdge> materialEdges() {
    const auto besideEars = [](const glm::dvec3& point) {
        return onHead(point) && overCollar(point) > 0.01 && aroundEar(point) < 0;
    };
    return {{overCollar, onHead},     {overCuff, onHands}, {overJacketHem, onTrunk},
            {overTrouserHem, onFeet}, {overSole, onFeet},  {insideLapels, onChest},
            {onEye, onFace},          {onLips, onFace},    {hairLine, besideEars}};
}

std::vector<Tuck> tucks() {
    return {
        {Material::Jacket, Material::Skin, 0.009},   {Material::Jacket, Material::Shirt, 0.006},
        {Material::Shirt, Material::Skin, 0.005},    {Material::Jacket, Material::Trousers, 0.011},
        {Material::Trousers, Material::Shoe, 0.010}, {Material::Sole, Material::Shoe, 0.006}};
}

} // namespace mannequin
