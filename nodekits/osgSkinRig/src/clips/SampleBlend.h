// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/SampledClip>

#include <array>
#include <cstddef>

namespace osgSkin {

/// blend() at one share, for many joints: what depends on the share alone is worked out once.
class SampleBlend {
public:
    /// \param share of the way from one sample to the other
    explicit SampleBlend(double share) noexcept;

    /// From `a` at share 0 to `b` at share 1, both exactly.
    ///
    /// \param a one joint's sample
    /// \param b its other one
    /// \return between them
    JointSample operator()(const JointSample& a, const JointSample& b) const noexcept;

private:
    static constexpr std::size_t kTerms = 8;

    double _share, _rest;
    std::array<double, kTerms> _ofShare, _ofRest; ///< factors of the series
};

} // namespace osgSkin
