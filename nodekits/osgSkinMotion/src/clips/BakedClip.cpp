// SPDX-License-Identifier: MIT
#include "clips/BakedClip.h"

#include <cmath>

namespace osgSkin {
namespace {

/// cos(theta) - 1 down to which the series is exact to double precision: samples up to 28
/// degrees apart.
constexpr double kNear = -0.03;

} // namespace

// sin(t theta) / sin(theta), slerp's weight, is a power series of x = cos(theta) - 1: it is
// t (1 + f_1 x (1 + f_2 x (1 + ...))) with f_i = (t^2 - i^2) / (i (2 i + 1)). No arc cosine, no
// sine, and as exact as those where the samples are near each other.
SampleBlend::SampleBlend(double share) noexcept : _shares{1.0 - share, share} {
    Pair power = _shares;
    for (std::size_t k = 0; k < kTerms; ++k) {
        _powers[k] = power;
        const auto i = static_cast<double>(k + 1);
        for (std::size_t s = 0; s < 2; ++s)
            power[s] *= (_shares[s] * _shares[s] - i * i) / (i * (2.0 * i + 1.0));
    }
}

JointSample SampleBlend::operator()(const JointSample& a, const JointSample& b) const noexcept {
    JointSample result; // the only one that is returned: it is not copied
    const bool isFirst = !(_shares[1] > 0.0);
    if (isFirst || _shares[1] >= 1.0) {
        result = isFirst ? a : b;
        return result;
    }
    const double cosine = glm::dot(a.rotation, b.rotation);
    const double x = std::abs(cosine) - 1.0;
    if (x < kNear) {
        result.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, _shares[1]));
    } else {
        // In pairs and pairs of pairs, which do not wait for each other.
        const auto& c = _powers;
        const double x2 = x * x, x4 = x2 * x2;
        Pair weight;
        for (std::size_t s = 0; s < 2; ++s)
            weight[s] = (c[0][s] + c[1][s] * x) + (c[2][s] + c[3][s] * x) * x2 +
                        ((c[4][s] + c[5][s] * x) + (c[6][s] + c[7][s] * x) * x2) * x4;
        const double from = weight[0], to = std::copysign(weight[1], cosine);
        for (glm::length_t i = 0; i < 4; ++i)
            result.rotation[i] = from * a.rotation[i] + to * b.rotation[i];
    }
    for (glm::length_t i = 0; i < 3; ++i)
        result.translation[i] = _shares[0] * a.translation[i] + _shares[1] * b.translation[i];
    result.scale = _shares[0] * a.scale + _shares[1] * b.scale;
    return result;
}

} // namespace osgSkin
