// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/PositionAttitudeTransform>

/// Three figures: one walks, one waves, and the one between them does half of each.
osg::ref_ptr<osg::Node> blendClips(const std::string& file) {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (int i = 0; i < 3; ++i) {
        const float waving = 0.5f * float(i);
        const osgSkin::Character character = osgSkin::loadCharacter(file);
        osgAnimation::BasicAnimationManager& manager = *character.manager;
        manager.stopAll();
        for (const osg::ref_ptr<osgAnimation::Animation>& clip : manager.getAnimationList()) {
            const float weight = clip->getName() == "wave" ? waving : 1.0f - waving;
            if (weight > 0.0f) manager.playAnimation(clip, 0, weight); // one priority for both
        }
        const osg::ref_ptr<osg::PositionAttitudeTransform> place =
            new osg::PositionAttitudeTransform;
        place->setPosition(osg::Vec3d(1.1 * i - 1.1, 0.0, 0.0));
        place->addChild(character.root);
        scene->addChild(place);
    }
    return scene;
}
