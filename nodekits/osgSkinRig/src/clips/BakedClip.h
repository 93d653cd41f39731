// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/SampledClip>

#include <osgSkin/Pose>

#include <osg/BoundingBox>
#include <osg/Matrixd>
#include <osg/Referenced>

#include <vector>

namespace osgSkin {

/// All samples of a clip made ready for one character: poses split, skins bounded by their own
/// vertices.
class BakedClip : public osg::Referenced {
public:
    struct Skin {
        std::vector<Pose> poses;              ///< of each sample
        std::vector<osg::BoundingBox> bounds; ///< of each sample
    };

    osg::ref_ptr<const SampledClip> clip;
    std::vector<Skin> skins;                       ///< as the player has them
    std::vector<std::vector<osg::Matrixd>> rigids; ///< [rigid][sample]

protected:
    ~BakedClip() override = default;
};

} // namespace osgSkin
