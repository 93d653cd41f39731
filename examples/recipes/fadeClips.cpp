// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/MakeWalker>

#include <stdexcept>

/// A figure that walks, with another clip on its upper body: a wave.
osg::ref_ptr<osg::Node> fadeClips(const std::string& file) {
    /// Moves a figure along by the steps of its clips.
    struct Walk : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            traverse(node, nv); // the player has advanced
            static_cast<osg::MatrixTransform&>(*node).preMult(player->takeRootMatrix());
        }
        osg::ref_ptr<osgSkin::ClipPlayer> player;
    };
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    osgSkin::WalkerReport clips;
    osgSkin::makeWalker(*character.root, {}, &clips); // knows which of the clips is a walk
    std::string other;
    for (const osgSkin::CharacterMotion& motion : character.motions)
        if (other.empty() && motion.name() != clips.walking) other = motion.name();
    if (other.empty()) throw std::runtime_error(file + ": has no clip but a walk");
    const osg::ref_ptr<Walk> walk = new Walk;
    walk->player = osgSkin::attach<osgSkin::ClipPlayer>(*character.root); // the manager pauses
    walk->player->setRoot(osgSkin::ClipPlayer::Root::FromFeet);
    walk->player->play({walk->player->clip(clips.walking)}, 0.3);
    osgSkin::ClipPlayer::Layer wave{walk->player->clip(other)};
    wave.joints = osgSkin::jointsBelow(*wave.clip, "Spine");
    wave.weight = 0.0;
    walk->player->setLayer(3, wave);
    walk->player->fade(3, 1.0, 0.2, osgSkin::ClipPlayer::Easing::Smooth);
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(character.root);
    place->setUpdateCallback(walk);
    return place;
}
