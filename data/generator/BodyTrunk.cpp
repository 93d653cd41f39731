// SPDX-License-Identifier: MIT
#include "BodyTrunk.h"

#include "BodyParts.h"

namespace mannequin {
namespace {

/// A horizontal cross-section of the trunk: half its breadth, and its outline along z.
struct Level {
    double y, halfBreadth, back, widest, front, power;
};

const Level kLevels[] = {

    {0.870, 0.030, -0.050, -0.010, 0.030, 2.0}, // perineum
    {0.885, 0.075, -0.085, -0.010, 0.060, 2.0},
    {0.905, 0.120, -0.105, -0.010, 0.080, 2.1},
    {0.930, 0.148, -0.115, -0.010, 0.092, 2.2}, // trochanters
    {0.960, 0.158, -0.118, -0.010, 0.098, 2.3},
    {1.000, 0.159, -0.112, -0.008, 0.102, 2.3}, // iliac crests
    {1.050, 0.155, -0.098, -0.006, 0.104, 2.3},
    {1.090, 0.152, -0.093, -0.005, 0.106, 2.4}, // waist
    {1.140, 0.150, -0.094, -0.005, 0.106, 2.4},
    {1.200, 0.152, -0.106, -0.010, 0.108, 2.4}, // lowest ribs
    {1.260, 0.158, -0.118, -0.015, 0.112, 2.4},
    {1.320, 0.163, -0.129, -0.020, 0.113, 2.5}, // nipples
    {1.380, 0.162, -0.133, -0.030, 0.102, 2.5},
    {1.420, 0.150, -0.130, -0.035, 0.082, 2.4},
    {1.455, 0.122, -0.118, -0.040, 0.052, 2.2}, // clavicles
    {1.490, 0.080, -0.102, -0.042, 0.020, 2.0},
    {1.520, 0.050, -0.085, -0.042, 0.000, 2.0},
};

Loft core() {
    std::vector<LoftSection> sections;
    for (const Level& l : kLevels)
        sections.push_back({l.y, 0, -l.widest, l.halfBreadth, l.halfBreadth, l.widest - l.back,
                            l.front - l.widest, l.power});
    return {LoftFrame::make({0, 0, 0}, {0, 1, 0}, {1, 0, 0}), sections}; // v points backward
}

void sculptFront(Sculpture& trunk) {
    // Pectorals: a plate, and a fan towards the upper arm.
    trunk.addPair(Ellipsoid{{0.080, 1.340, 0.077}, {0.078, 0.055, 0.035}, rotation(-8, 20, 10)},
                  0.030);
    trunk.addPair(RoundCone{{0.085, 1.355, 0.066}, {0.165, 1.410, 0.010}, 0.036, 0.034}, 0.040);
    trunk.addPair(RoundCone{{0.018, 1.462, 0.022}, {0.160, 1.480, -0.020}, 0.010, 0.016}, 0.025);
    trunk.carve(RoundCone{{0, 1.410, 0.110}, {0, 1.300, 0.141}, 0.012, 0.014}, 0.025); // sternum
    // The front of the shoulder: fills the pit below the clavicle.
    trunk.addPair(RoundCone{{0.085, 1.415, 0.034}, {0.150, 1.440, -0.004}, 0.036, 0.036}, 0.030);
    // Rectus abdominis, and the hollow between the two halves and below the ribs.
    trunk.addPair(RoundCone{{0.038, 1.240, 0.078}, {0.028, 0.960, 0.060}, 0.030, 0.026}, 0.030);
    trunk.add(Ellipsoid{{0, 0.890, 0.058}, {0.034, 0.048, 0.032}, rotation(20, 0, 0)}, 0.040);
    trunk.carve(RoundCone{{0, 1.290, 0.128}, {0, 1.090, 0.116}, 0.007, 0.007}, 0.020);
}

void sculptBack(Sculpture& trunk) {
    // Latissimus dorsi, scapula, erector spinae, furrow of the spine.
    trunk.addPair(RoundCone{{0.133, 1.385, -0.055}, {0.100, 1.150, -0.030}, 0.060, 0.034}, 0.040);
    trunk.addPair(Ellipsoid{{0.088, 1.380, -0.102}, {0.050, 0.078, 0.030}, rotation(0, -20, 8)},
                  0.035);
    trunk.addPair(RoundCone{{0.034, 1.020, -0.070}, {0.034, 1.260, -0.092}, 0.030, 0.030}, 0.030);
    trunk.carve(RoundCone{{0, 1.030, -0.122}, {0, 1.400, -0.158}, 0.012, 0.012}, 0.040);
    // Gluteals.
    trunk.addPair(Ellipsoid{{0.078, 0.925, -0.076}, {0.080, 0.088, 0.063}, rotation(12, -12, -8)},
                  0.030);
    trunk.addPair(Ellipsoid{{0.105, 0.935, -0.025}, {0.055, 0.100, 0.080}}, 0.050);
}

void sculptShoulderGirdle(Sculpture& trunk) {
    // Trapezius, from the neck to the acromion.
    trunk.addPair(RoundCone{{0.026, 1.522, -0.058}, {0.165, 1.458, -0.046}, 0.032, 0.032}, 0.040);
    trunk.addPair(RoundCone{{0.040, 1.480, -0.070}, {0.130, 1.440, -0.070}, 0.045, 0.040}, 0.040);
}

} // namespace

Sculpture sculptTrunk() {
    Sculpture trunk;
    trunk.add(core(), 0);
    sculptFront(trunk);
    sculptBack(trunk);
    sculptShoulderGirdle(trunk);
    return trunk;
}

} // namespace mannequin
