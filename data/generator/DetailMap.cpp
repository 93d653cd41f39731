// SPDX-License-Identifier: MIT
#include "DetailMap.h"
#include "Primitives.h"

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

/// Inside its bounds the edges have this length.
struct Region {
    RoundCone bounds;
    double edgeLength;
};

constexpr double kPlain = 0.036;
constexpr double kGrowth = 0.22; // of the edge length over the distance from a region

// For the left side and the middle.
const Region kRegions[] = {
    {{{0.000, 1.680, 0.100}, {0.000, 1.600, 0.100}, 0.038, 0.030}, 0.0080},   // face
    {{{0.080, 1.667, -0.010}, {0.080, 1.668, -0.010}, 0.025, 0.025}, 0.0090}, // ear
    {{{0.000, 1.700, 0.000}, {0.000, 1.600, 0.040}, 0.090, 0.060}, 0.0160},   // head
    {{{0.640, 1.050, 0.020}, {0.685, 1.010, 0.030}, 0.035, 0.040}, 0.0130},   // palm
    {{{0.700, 1.000, 0.035}, {0.745, 0.935, 0.045}, 0.045, 0.055}, 0.0085},   // fingers
    {{{0.650, 1.035, 0.060}, {0.665, 1.010, 0.095}, 0.018, 0.015}, 0.0090},   // thumb
    {{{0.120, 0.020, 0.195}, {0.190, 0.020, 0.175}, 0.035, 0.030}, 0.0100},   // toes
    {{{0.130, 0.040, -0.030}, {0.155, 0.030, 0.140}, 0.050, 0.050}, 0.0190},  // foot
    {{{0.112, 0.510, 0.000}, {0.112, 0.520, 0.020}, 0.070, 0.070}, 0.0270},   // knee
    {{{0.420, 1.236, -0.036}, {0.421, 1.235, -0.036}, 0.060, 0.060}, 0.0220}, // elbow
    {{{0.170, 1.440, -0.030}, {0.190, 1.370, -0.030}, 0.070, 0.050}, 0.0270}, // shoulder, armpit
    {{{0.030, 0.860, 0.000}, {0.090, 0.860, -0.080}, 0.040, 0.050}, 0.0270}, // crotch, gluteal fold
};

} // namespace

double DetailMap::edgeLength(const glm::dvec3& point) const {
    const glm::dvec3 left(std::abs(point.x), point.y, point.z);
    double length = kPlain;
    for (const Region& region : kRegions)
        length = std::min(length, region.edgeLength +
                                      kGrowth * std::max(0.0, region.bounds.distance(left)));
    return length;
}

} // namespace mannequin
