// SPDX-License-Identifier: MIT
#include "BodyParts.h"

namespace mannequin {
namespace {

/// A level section of the jaw and the face: half its breadth, and its outline along z.
struct Level {
    double y, halfBreadth, back, widest, front;
};

const Level kFace[] = {
    {1.558, 0.022, 0.045, 0.065, 0.088}, // chin
    {1.572, 0.038, 0.020, 0.058, 0.099},  {1.590, 0.051, -0.010, 0.040, 0.098},
    {1.610, 0.059, -0.030, 0.030, 0.095},                                       // mouth
    {1.640, 0.065, -0.050, 0.020, 0.095}, {1.670, 0.068, -0.050, 0.020, 0.094}, // cheekbones
    {1.700, 0.068, -0.050, 0.020, 0.096}, {1.730, 0.066, -0.050, 0.020, 0.096},
};

void sculptNeck(Sculpture& head) {
    const LoftFrame frame = LoftFrame::make({0, 1.440, -0.050}, {0, 0.175, 0.045}, {1, 0, 0});
    head.add(Loft(frame, {{0.00, 0, 0, 0.068, 0.068, 0.055, 0.055, 2},
                          {0.06, 0, 0, 0.062, 0.062, 0.056, 0.056, 2},
                          {0.12, 0, 0, 0.058, 0.058, 0.060, 0.058, 2},
                          {0.21, 0, 0, 0.058, 0.058, 0.062, 0.060, 2}}),
             0);
    // Sternomastoids and larynx.
    head.addPair(RoundCone{{0.050, 1.610, -0.020}, {0.016, 1.462, 0.012}, 0.014, 0.010}, 0.020);
    head.add(RoundCone{{0, 1.545, 0.030}, {0, 1.515, 0.022}, 0.012, 0.012}, 0.020);
}

void sculptSkull(Sculpture& head) {
    head.add(Ellipsoid{{0, 1.710, -0.010}, {0.0775, 0.090, 0.096}}, 0.030);
    head.add(Ellipsoid{{0, 1.725, 0.036}, {0.066, 0.062, 0.066}}, 0.030);
    std::vector<LoftSection> sections;
    for (const Level& l : kFace)
        sections.push_back({l.y, 0, -l.widest, l.halfBreadth, l.halfBreadth, l.widest - l.back,
                            l.front - l.widest, 2.2});
    head.add(Loft(LoftFrame::make({0, 0, 0}, {0, 1, 0}, {1, 0, 0}), sections), 0.015);
    head.add(Ellipsoid{{0, 1.574, 0.088}, {0.022, 0.014, 0.016}}, 0.020);
    head.addPair(Ellipsoid{{0.043, 1.667, 0.064}, {0.022, 0.016, 0.020}}, 0.020);
}

void sculptFace(Sculpture& head) {
    // Eye sockets under the brow, with the eyeballs in them.
    head.carvePair(Ellipsoid{{0.033, 1.688, 0.104}, {0.019, 0.013, 0.018}, rotation(0, 15, 0)},
                   0.016);
    head.addPair(RoundCone{{0.014, 1.705, 0.096}, {0.050, 1.704, 0.078}, 0.008, 0.006}, 0.014);
    head.addPair(Ellipsoid{{0.032, 1.685, 0.078}, {0.0155, 0.0125, 0.0135}}, 0.005);
    // Nose: bridge, tip, wings.
    head.add(RoundCone{{0, 1.695, 0.094}, {0, 1.652, 0.112}, 0.008, 0.0115}, 0.012);
    head.addPair(Ellipsoid{{0.011, 1.646, 0.104}, {0.008, 0.008, 0.011}}, 0.008);
    // Lips, with the mouth's line between them.
    head.add(Ellipsoid{{0, 1.619, 0.095}, {0.025, 0.0075, 0.012}}, 0.008);
    head.add(Ellipsoid{{0, 1.606, 0.094}, {0.021, 0.0075, 0.012}}, 0.008);
    head.carve(Ellipsoid{{0, 1.6125, 0.110}, {0.026, 0.0018, 0.010}}, 0.006);
    head.carve(Ellipsoid{{0, 1.593, 0.108}, {0.018, 0.005, 0.008}}, 0.012);
}

void sculptEars(Sculpture& head) {
    const glm::dmat3 turned = rotation(-12, -22, 0);
    head.addPair(Ellipsoid{{0.078, 1.667, -0.012}, {0.008, 0.031, 0.019}, turned}, 0.008);
    head.carvePair(Ellipsoid{{0.087, 1.670, -0.006}, {0.006, 0.019, 0.010}, turned}, 0.006);
}

} // namespace

Sculpture sculptHead() {
    Sculpture head;
    sculptNeck(head);
    sculptSkull(head);
    sculptFace(head);
    sculptEars(head);
    return head;
}

} // namespace mannequin
