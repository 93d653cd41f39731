// SPDX-License-Identifier: MIT
#include "BodyHand.h"

#include "BodyParts.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

/// Frame of the hand: origin at the wrist, x towards the fingers, y towards the thumb, z out of the
/// palm.
class HandFrame {
public:
    HandFrame() : _wrist(jointCentre("LeftHand")) {
        const glm::dvec3 distal = glm::normalize(jointCentre("LeftFingerBase") - _wrist);
        const glm::dvec3 thumb =
            glm::normalize(glm::dvec3(0, 0, 1) - distal * glm::dot(glm::dvec3(0, 0, 1), distal));
        _axes = glm::dmat3(distal, thumb, glm::cross(distal, thumb));
    }
    glm::dvec3 world(const glm::dvec3& local) const { return _wrist + _axes * local; }
    const glm::dmat3& axes() const { return _axes; }

private:
    glm::dvec3 _wrist;
    glm::dmat3 _axes;
};

/// A finger: its knuckle, its spread towards the thumb and the flexion of its three joints
/// (degrees), the lengths of its phalanges, and its radii from knuckle to tip.
struct Finger {
    glm::dvec3 knuckle;
    double spread;
    double bend[3];
    double length[3];
    double radius[4];
};

const Finger kFingers[] = {
    {{0.093, 0.0245, -0.001}, 6, {8, 16, 10}, {0.041, 0.026, 0.019}, {.0100, .0093, .0086, .0076}},
    {{0.095, 0.0010, -0.003}, 0, {6, 18, 12}, {0.045, 0.029, 0.020}, {.0102, .0095, .0088, .0078}},
    {{0.091, -0.0220, -0.001},
     -6,
     {9, 20, 13},
     {0.042, 0.027, 0.020},
     {.0098, .0091, .0084, .0075}},
    {{0.084, -0.0425, 0.003},
     -12,
     {12, 20, 12},
     {0.034, 0.022, 0.018},
     {.0088, .0083, .0077, .0070}},
};

void sculptFinger(Sculpture& hand, const HandFrame& frame, const Finger& finger,
                  const HandStyle& style) {
    const double spread = glm::radians(finger.spread * style.spread);
    const glm::dvec3 level(std::cos(spread), std::sin(spread), 0);
    glm::dvec3 from = finger.knuckle;
    double bend = 0;
    for (int i = 0; i < 3; ++i) {
        bend += glm::radians(finger.bend[i]);
        const glm::dvec3 to =
            from + (level * std::cos(bend) + glm::dvec3(0, 0, std::sin(bend))) * finger.length[i];
        hand.add(
            RoundCone{frame.world(from), frame.world(to), finger.radius[i], finger.radius[i + 1]},
            style.blend);
        from = to;
    }
}

void sculptPalm(Sculpture& hand, const HandFrame& frame) {
    const auto cone = [&](glm::dvec3 from, glm::dvec3 to, double fromRadius, double toRadius) {
        hand.add(RoundCone{frame.world(from), frame.world(to), fromRadius, toRadius}, 0.016);
    };
    cone({0.000, 0.011, 0}, {0.097, 0.0240, 0.002}, 0.0175, 0.0110);
    cone({0.000, 0.004, 0}, {0.100, 0.0010, 0.000}, 0.0175, 0.0112);
    cone({0.000, -0.004, 0}, {0.097, -0.0220, 0.002}, 0.0175, 0.0108);
    cone({0.000, -0.011, 0}, {0.088, -0.0415, 0.005}, 0.0175, 0.0098);
    // Hypothenar and thenar eminences.
    cone({0.025, -0.020, 0.006}, {0.060, -0.034, 0.008}, 0.0130, 0.0120);
    cone({0.022, 0.016, 0.008}, {0.050, 0.032, 0.010}, 0.0150, 0.0150);
}

void sculptThumb(Sculpture& hand, const HandFrame& frame, const HandStyle& style) {
    const glm::dvec3 joints[] = {
        {0.018, 0.018, 0.006}, {0.054, 0.040, 0.010}, {0.084, 0.056, 0.013}, {0.103, 0.064, 0.017}};
    const double radii[] = {0.0150, 0.0125, 0.0110, 0.0085};
    for (int i = 0; i < 3; ++i)
        hand.add(
            RoundCone{frame.world(joints[i]), frame.world(joints[i + 1]), radii[i], radii[i + 1]},
            std::max(i == 0 ? 0.012 : 0.005, style.blend));
    // The fold of skin between thumb and forefinger.
    hand.add(RoundCone{frame.world({0.045, 0.030, 0.003}), frame.world({0.070, 0.026, 0.002}),
                       0.0110, 0.0090},
             std::max(0.014, style.blend));
}

} // namespace

void sculptHand(Sculpture& arm, const HandStyle& style) {
    const HandFrame frame;
    sculptPalm(arm, frame);
    sculptThumb(arm, frame, style);
    for (const Finger& finger : kFingers) sculptFinger(arm, frame, finger, style);
}

} // namespace mannequin
