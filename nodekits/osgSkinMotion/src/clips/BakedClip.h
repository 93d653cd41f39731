// SPDX-License-Identifier: MIT
#ifndef OSGSKINMOTION_CLIPS_BAKEDCLIP_H
#define OSGSKINMOTION_CLIPS_BAKEDCLIP_H

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>
#include <osgSkinMotion/SampledClip>

#include <osg/BoundingBox>
#include <osg/Matrixd>
#include <osg/Referenced>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// All samples of a clip, prepared for one character: split poses, and bounds of the skins'
/// vertices at the samples and the interpolated sample.
class BakedClip : public osg::Referenced {
public:
    /// Intervals between two samples that have a box each.
    static constexpr std::size_t kParts = 4;

    struct Skin {
        osg::ref_ptr<const SkinModel> model;  ///< whose joints were posed
        std::vector<Pose> poses;              ///< of each sample
        std::vector<osg::BoundingBox> bounds; ///< of each sample
        std::vector<osg::BoundingBox> sweeps; ///< [sample * kParts + part]; see sweptBounds()

        /// A box that holds the skin at a position in the clip; not valid where none is known.
        const osg::BoundingBox& boundsAt(const SampledClip::Interval& interval) const {
            if (!(interval.share > 0.0)) return bounds[interval.from];
            const auto part = static_cast<std::size_t>(interval.share * double(kParts));
            return sweeps[interval.from * kParts + std::min(part, kParts - 1)];
        }
    };

    osg::ref_ptr<const SampledClip> clip;
    std::vector<Skin> skins;                       ///< as the player has them
    std::vector<std::vector<osg::Matrixd>> rigids; ///< [rigid][sample]

protected:
    ~BakedClip() override = default;
};

/// Interpolates two samples of many joints by one share, from which the series' factors are
/// computed once.
class SampleBlend {
public:
    /// \param share 0 for the first sample, 1 for the second
    explicit SampleBlend(double share) noexcept;

    /// From `a` at share 0 to `b` at share 1, both exactly.
    ///
    /// \param a one joint's sample
    /// \param b the second
    /// \return between them
    JointSample operator()(const JointSample& a, const JointSample& b) const noexcept;

private:
    static constexpr std::size_t kTerms = 8;

    /// Of both samples, side by side for the processor's vectors.
    using Pair = std::array<double, 2>;

    Pair _shares;
    std::array<Pair, kTerms> _powers; ///< the series' coefficients
};

} // namespace osgSkin

#endif
