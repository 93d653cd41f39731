// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/PositionAttitudeTransform>

#include <stdexcept>

/// Three figures: one plays the first clip, one the last, and the one between half of each.
osg::ref_ptr<osg::Node> blendClips(const std::string& file) {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (int i = 0; i < 3; ++i) {
        const float share = 0.5f * float(i);
        const osgSkin::Character character = osgSkin::loadCharacter(file);
        if (character.motions.empty()) throw std::runtime_error(file + ": has no clips to blend");
        osgAnimation::BasicAnimationManager& manager = *character.manager;
        manager.stopAll();
        if (share < 1.0f) // one priority for both
            manager.playAnimation(character.motions.front().animation, 0, 1.0f - share);
        if (share > 0.0f) manager.playAnimation(character.motions.back().animation, 0, share);
        const osg::ref_ptr<osg::PositionAttitudeTransform> place =
            new osg::PositionAttitudeTransform;
        const double apart = 1.1 * double(character.root->getBound().radius());
        place->setPosition(osg::Vec3d(apart * (i - 1), 0.0, 0.0));
        place->addChild(character.root);
        scene->addChild(place);
    }
    return scene;
}
