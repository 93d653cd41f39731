// SPDX-License-Identifier: MIT
#include "clips/BakedClip.h"

#include <glm/common.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// cos(theta) - 1 down to which the series are exact to double precision: samples up to 28 degrees
/// apart.
constexpr double kNear = -0.03;
/// The same for the first kFew terms: up to 2.6 degrees apart, as most samples are.
constexpr double kNearer = -0.001;
constexpr std::size_t kFew = 5;

} // namespace

// sin(t theta) / sin(theta), slerp's weight, is a power series of x = cos(theta) - 1: it is
// t (1 + f_1 x (1 + f_2 x (1 + ...))) with f_i = (t^2 - i^2) / (i (2 i + 1)). No arc cosine, no
// sine, and as exact as those where the samples are near each other.
SampleBlend::SampleBlend(double share) noexcept : _share(share), _rest(1.0 - share) {
    for (std::size_t k = 0; k < kTerms; ++k) {
        const auto i = static_cast<double>(k + 1);
        _ofShare[k] = (_share * _share - i * i) / (i * (2.0 * i + 1.0));
        _ofRest[k] = (_rest * _rest - i * i) / (i * (2.0 * i + 1.0));
    }
}

JointSample SampleBlend::operator()(const JointSample& a, const JointSample& b) const noexcept {
    if (!(_share > 0.0)) return a;
    if (_share >= 1.0) return b;
    JointSample result;
    const double cosine = glm::dot(a.rotation, b.rotation);
    const double x = std::abs(cosine) - 1.0;
    if (x < kNear) {
        result.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, _share));
    } else {
        double from = 1.0, to = 1.0;
        for (std::size_t k = x < kNearer ? kTerms : kFew; k-- > 0;) {
            from = 1.0 + _ofRest[k] * x * from;
            to = 1.0 + _ofShare[k] * x * to;
        }
        from *= _rest;
        to *= cosine < 0.0 ? -_share : _share;
        result.rotation = {
            from * a.rotation.w + to * b.rotation.w, from * a.rotation.x + to * b.rotation.x,
            from * a.rotation.y + to * b.rotation.y, from * a.rotation.z + to * b.rotation.z};
    }
    result.translation = glm::mix(a.translation, b.translation, _share);
    result.scale = glm::mix(a.scale, b.scale, _share);
    return result;
}

} // namespace osgSkin
