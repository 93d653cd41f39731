// SPDX-License-Identifier: MIT
// Short clips of a tube, and skins that players pose by them.
#pragma once

#include "PlayedFigure.h"
#include "TubeSkin.h"

#include <osgSkinMotion/SampledClip>

#include <utility>

namespace played {

/// The tube's joints; `swapped` exchanges the names of the last two.
inline osgSkin::RestSkeleton namedRig(bool swapped) {
    osgSkin::RestSkeleton rig = tubeRig();
    if (swapped) std::swap(rig.joints[1].name, rig.joints[2].name);
    return rig;
}

/// Each joint bends by a different angle.
inline osgSkin::Clip bentMotion() {
    osgSkin::Clip clip;
    clip.frameTime = 0.1;
    clip.frames = 2;
    clip.joints = 3;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        for (const double angle : {0.1, 0.4, 0.9})
            clip.rotations.push_back(glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
        clip.rootPositions.emplace_back(0, 0, 0);
    }
    return clip;
}

inline osg::ref_ptr<const osgSkin::SampledClip> bentClip(bool swapped = false) {
    return osgSkin::SampledClip::create(bentMotion(), namedRig(swapped));
}

/// The vertices of a player that has not played anything else.
inline Vertices posedAfresh(const osg::ref_ptr<const osgSkin::SkinModel>& model,
                            const osg::ref_ptr<const osgSkin::SampledClip>& clip) {
    const auto skin = test::makeSkin();
    skin->setSkin(test::makeGeometry(test::Tube()), model);
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    player->addSkin(skin);
    player->setLayer(0, {clip});
    return posedBy(*player, *skin);
}

inline osg::ref_ptr<const osgSkin::SkinModel> modelWithOtherNames() {
    test::Tube tube;
    std::swap(tube.binding.joints[1].name, tube.binding.joints[2].name);
    return tube.model();
}

} // namespace played
