// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/SampledClip>

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <osg/BoundingBox>
#include <osg/Matrixd>
#include <osg/Referenced>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// All samples of a clip made ready for one character: poses split, skins bounded by their own
/// vertices, there and between.
class BakedClip : public osg::Referenced {
public:
    /// Of the way from a sample to the next one, which have a box each.
    static constexpr std::size_t kParts = 4;

    struct Skin {
        osg::ref_ptr<const SkinModel> model;  ///< whose joints were posed
        std::vector<Pose> poses;              ///< of each sample
        std::vector<osg::BoundingBox> bounds; ///< of each sample
        std::vector<osg::BoundingBox> ways;   ///< [sample * kParts + part]; see boundWay()

        /// A box that holds the skin at a place in the clip; not valid where none is known.
        const osg::BoundingBox& boundsAt(const SampledClip::Place& place) const {
            if (!(place.share > 0.0)) return bounds[place.from];
            const auto part = static_cast<std::size_t>(place.share * double(kParts));
            return ways[place.from * kParts + std::min(part, kParts - 1)];
        }
    };

    osg::ref_ptr<const SampledClip> clip;
    std::vector<Skin> skins;                       ///< as the player has them
    std::vector<std::vector<osg::Matrixd>> rigids; ///< [rigid][sample]

protected:
    ~BakedClip() override = default;
};

} // namespace osgSkin
