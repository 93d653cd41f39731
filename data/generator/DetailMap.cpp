// SPDX-License-Identifier: MIT
#include "DetailMap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace mannequin {
namespace {

constexpr double kPlain = 0.0345;
constexpr double kGrowth = 0.28; // of the edge length per unit of distance from a region

const DetailRegion kRegions[] = {

    {{{0.000, 1.612, 0.098}, {0.018, 1.612, 0.094}, 0.010, 0.009}, 0.0045},   // mouth
    {{{0.000, 1.680, 0.105}, {0.000, 1.648, 0.115}, 0.010, 0.018}, 0.0055},   // nose
    {{{0.024, 1.690, 0.088}, {0.044, 1.689, 0.080}, 0.013, 0.012}, 0.0046},   // eye
    {{{0.000, 1.680, 0.080}, {0.000, 1.590, 0.080}, 0.042, 0.032}, 0.0113},   // face
    {{{0.080, 1.672, -0.014}, {0.078, 1.650, -0.008}, 0.022, 0.016}, 0.0075}, // ear
    {{{0.000, 1.700, 0.000}, {0.000, 1.600, 0.040}, 0.090, 0.060}, 0.0185},   // head
    {{{0.640, 1.050, 0.020}, {0.685, 1.010, 0.030}, 0.035, 0.035}, 0.0170},   // palm
    {{{0.714, 0.990, 0.022}, {0.745, 0.940, 0.030}, 0.050, 0.055}, 0.0075},   // fingers
    {{{0.650, 1.035, 0.060}, {0.665, 1.010, 0.095}, 0.018, 0.015}, 0.0080},   // thumb
    {{{0.120, 0.020, 0.200}, {0.190, 0.020, 0.180}, 0.032, 0.025}, 0.0088},   // toes
    {{{0.130, 0.040, -0.030}, {0.155, 0.030, 0.140}, 0.050, 0.050}, 0.0215},  // foot
    {{{0.112, 0.510, 0.000}, {0.112, 0.520, 0.020}, 0.070, 0.070}, 0.0275},   // knee
    {{{0.420, 1.236, -0.036}, {0.421, 1.235, -0.036}, 0.060, 0.060}, 0.0235}, // elbow
    {{{0.170, 1.440, -0.030}, {0.190, 1.370, -0.030}, 0.070, 0.050}, 0.0270}, // shoulder
    {{{0.125, 0.300, -0.010}, {0.132, 0.100, -0.020}, 0.060, 0.060}, 0.0265}, // shank
    {{{0.420, 1.236, -0.036}, {0.618, 1.070, 0.010}, 0.050, 0.050}, 0.0215},  // forearm
    {{{0.300, 1.340, -0.030}, {0.420, 1.236, -0.036}, 0.055, 0.050}, 0.0265}, // upper arm
    {{{0.185, 1.345, -0.070}, {0.185, 1.345, 0.020}, 0.022, 0.022}, 0.0165},  // armpit
    {{{0.010, 1.310, 0.105}, {0.120, 1.310, 0.080}, 0.035, 0.035}, 0.0225},   // chest
    {{{0.130, 0.075, -0.030}, {0.128, 0.030, -0.045}, 0.045, 0.040}, 0.0180}, // ankle, heel
    {{{0.000, 0.845, -0.070}, {0.000, 0.845, 0.060}, 0.026, 0.026}, 0.0140},  // crotch
};

} // namespace

DetailMap::DetailMap(double plain, std::vector<DetailRegion> regions)
    : _plain(plain), _regions(std::move(regions)) {}

double DetailMap::edgeLength(const glm::dvec3& point) const {
    const glm::dvec3 left(std::abs(point.x), point.y, point.z);
    double length = _plain;
    for (const DetailRegion& region : _regions)
        length = std::min(length, region.edgeLength +
                                      kGrowth * std::max(0.0, region.bounds.distance(left)));
    return length;
}

DetailMap bareDetail() {
    return {kPlain, {std::begin(kRegions), std::end(kRegions)}};
}

} // namespace mannequin
