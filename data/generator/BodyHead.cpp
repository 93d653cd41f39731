// SPDX-License-Identifier: MIT
#include "BodyHead.h"

#include "BodyParts.h"

#include <cmath>

namespace mannequin {
namespace {

/// A horizontal cross-section of the jaw and the face: half its breadth, and its outline along z.
struct Level {
    double y, halfBreadth, back, widest, front;
};

const Level kFace[] = {

    {1.557, 0.020, 0.045, 0.065, 0.086}, // chin
    {1.572, 0.037, 0.020, 0.056, 0.098},  {1.590, 0.051, -0.010, 0.040, 0.096},
    {1.610, 0.059, -0.030, 0.030, 0.096},                                       // mouth
    {1.640, 0.065, -0.050, 0.020, 0.097}, {1.670, 0.068, -0.050, 0.020, 0.094}, // cheekbones
    {1.700, 0.068, -0.050, 0.020, 0.096}, {1.730, 0.064, -0.050, 0.020, 0.093},
    {1.760, 0.050, -0.040, 0.020, 0.075},
};

void sculptNeck(Sculpture& head) {
    const LoftFrame frame = LoftFrame::make({0, 1.440, -0.050}, {0, 0.175, 0.045}, {1, 0, 0});
    head.add(Loft(frame, {{0.00, 0, 0, 0.066, 0.066, 0.055, 0.055, 2},
                          {0.06, 0, 0, 0.058, 0.058, 0.055, 0.055, 2},
                          {0.12, 0, 0, 0.055, 0.055, 0.058, 0.056, 2},
                          {0.21, 0, 0, 0.052, 0.052, 0.060, 0.056, 2}}),
             0);
    // Sternomastoids and larynx.
    head.addPair(RoundCone{{0.044, 1.625, -0.024}, {0.016, 1.462, 0.012}, 0.013, 0.010}, 0.020);
    head.add(RoundCone{{0, 1.545, 0.030}, {0, 1.515, 0.022}, 0.012, 0.012}, 0.020);
}

void sculptSkull(Sculpture& head) {
    head.add(Ellipsoid{{0, 1.709, -0.006}, {0.0745, 0.088, 0.090}}, 0.030);
    head.addPair(Ellipsoid{{0.026, 1.730, -0.028}, {0.044, 0.056, 0.060}}, 0.030);
    head.add(Ellipsoid{{0, 1.725, 0.036}, {0.066, 0.062, 0.066}}, 0.030);
    std::vector<LoftSection> sections;
    for (const Level& l : kFace)
        sections.push_back({l.y, 0, -l.widest, l.halfBreadth, l.halfBreadth, l.widest - l.back,
                            l.front - l.widest, 2.1});
    head.add(Loft(LoftFrame::make({0, 0, 0}, {0, 1, 0}, {1, 0, 0}), sections), 0.015);
    head.add(Ellipsoid{{0, 1.574, 0.088}, {0.022, 0.014, 0.016}}, 0.020);
    head.addPair(Ellipsoid{{0.042, 1.667, 0.064}, {0.020, 0.015, 0.018}}, 0.032);
}

void sculptFace(Sculpture& head) {
    // Eye sockets under the brow, with the eyeballs in them.
    head.carvePair(Ellipsoid{{0.0345, 1.687, 0.100}, {0.0185, 0.0120, 0.0205}, rotation(0, 18, 0)},
                   0.014);
    head.addPair(RoundCone{{0.012, 1.7045, 0.093}, {0.033, 1.7085, 0.088}, 0.0070, 0.0065}, 0.012);
    head.addPair(RoundCone{{0.033, 1.7075, 0.089}, {0.054, 1.700, 0.072}, 0.0065, 0.0060}, 0.012);
    head.addPair(Ellipsoid{{0.0325, 1.6865, 0.0755}, {0.0165, 0.0108, 0.0140}}, 0.005);
    // Nose: bridge, tip, wings.
    head.add(RoundCone{{0, 1.694, 0.090}, {0, 1.655, 0.1105}, 0.0075, 0.0085}, 0.012);
    head.add(Ellipsoid{{0, 1.6505, 0.114}, {0.0110, 0.0090, 0.0110}}, 0.006);
    head.addPair(Ellipsoid{{0.0110, 1.6470, 0.1035}, {0.0075, 0.0075, 0.0105}}, 0.009);
    // Lips, the line between them, and the hollow above the chin.
    head.add(Ellipsoid{{0, 1.6185, 0.0930}, {0.0240, 0.0075, 0.0130}, rotation(-15, 0, 0)}, 0.008);
    head.add(Ellipsoid{{0, 1.6050, 0.0910}, {0.0205, 0.0075, 0.0130}, rotation(10, 0, 0)}, 0.008);
    head.carvePair(RoundCone{{0, 1.6118, 0.1090}, {0.024, 1.6118, 0.0945}, 0.0035, 0.0025}, 0.006);
    head.carve(Ellipsoid{{0, 1.5930, 0.1060}, {0.018, 0.0050, 0.0090}}, 0.012);
}

void sculptEars(Sculpture& head) {
    const glm::dmat3 turned = rotation(-12, -24, 0);
    head.addPair(Ellipsoid{{0.076, 1.669, -0.012}, {0.0090, 0.0310, 0.0190}, turned}, 0.008);
    head.addPair(Ellipsoid{{0.074, 1.645, -0.005}, {0.0060, 0.0100, 0.0085}, turned}, 0.010);
    head.carvePair(Ellipsoid{{0.087, 1.671, -0.005}, {0.0060, 0.0170, 0.0090}, turned}, 0.006);
}

void sculptPlainFace(Sculpture& head) {
    head.carvePair(Ellipsoid{{0.034, 1.687, 0.102}, {0.022, 0.013, 0.020}, rotation(0, 18, 0)},
                   0.016);
    head.addPair(RoundCone{{0.012, 1.706, 0.092}, {0.050, 1.704, 0.076}, 0.0075, 0.0065}, 0.014);
    head.add(RoundCone{{0, 1.694, 0.090}, {0, 1.655, 0.112}, 0.0085, 0.0105}, 0.014);
    head.add(Ellipsoid{{0, 1.650, 0.108}, {0.0190, 0.0105, 0.0150}}, 0.010);
    head.add(Ellipsoid{{0, 1.612, 0.0920}, {0.0260, 0.0130, 0.0120}}, 0.012);
    head.addPair(Ellipsoid{{0.078, 1.667, -0.012}, {0.0120, 0.0310, 0.0190}, rotation(-12, -24, 0)},
                 0.010);
}

} // namespace

Sculpture sculptHair() {
    Sculpture hair;
    hair.add(Ellipsoid{{0, 1.713, -0.010}, {0.0835, 0.096, 0.100}}, 0.030);
    hair.add(Ellipsoid{{0, 1.742, 0.022}, {0.070, 0.066, 0.078}}, 0.030);
    hair.add(Ellipsoid{{0.012, 1.768, 0.048}, {0.050, 0.034, 0.044}}, 0.030); // parted on the right
    return hair;
}

double hairLine(const glm::dvec3& point) {
    // A plane from the brow over the ears to the nape, higher at the temples.
    constexpr double kSlope = 1.08;
    const double side = (point.y - 1.748 - kSlope * (point.z - 0.086) - 2.2 * point.x * point.x) /
                        std::hypot(1, kSlope);
    return smoothMin(side, point.y - 1.604, 0.03); // the nape is bare
}

Sculpture sculptPlainHead() {
    Sculpture head;
    sculptNeck(head);
    sculptSkull(head);
    sculptPlainFace(head);
    return head;
}

Sculpture sculptHead() {
    Sculpture head;
    sculptNeck(head);
    sculptSkull(head);
    sculptFace(head);
    sculptEars(head);
    return head;
}

} // namespace mannequin
