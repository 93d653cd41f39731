// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

/// Plays a clip by its name, in place of the first one.
osg::ref_ptr<osg::Node> chooseClip(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    osgAnimation::BasicAnimationManager& manager = *character.manager;
    manager.stopAll();
    for (const osg::ref_ptr<osgAnimation::Animation>& clip : manager.getAnimationList())
        if (clip->getName() == "wave") manager.playAnimation(clip);
    return character.root;
}
