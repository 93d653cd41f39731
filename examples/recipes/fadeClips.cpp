// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipPlayer>

namespace {

/// Moves a figure along by the steps of its clips.
struct Walk : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // the player has advanced
        static_cast<osg::MatrixTransform&>(*node).preMult(player->takeRootMatrix());
    }
    osg::ref_ptr<osgSkin::ClipPlayer> player;
};

} // namespace

/// A figure that walks, with what is played on its upper body: a wave.
osg::ref_ptr<osg::Node> fadeClips(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::ref_ptr<Walk> walk = new Walk;
    walk->player = osgSkin::attach<osgSkin::ClipPlayer>(*character.root); // the manager pauses
    walk->player->setRoot(osgSkin::ClipPlayer::Root::ExtractedWithTurn);
    if (!character.motions.empty()) {
        walk->player->play({walk->player->clip(character.motions.front().name())}, 0.3);
        osgSkin::ClipPlayer::Layer wave{walk->player->clip(character.motions.back().name())};
        wave.joints = osgSkin::jointsBelowRole(*wave.clip, "Spine");
        wave.weight = 0.0;
        walk->player->setLayer(3, wave);
        walk->player->fade(3, 1.0, 0.2, osgSkin::ClipPlayer::Easing::Smooth);
    }
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(character.root);
    place->setUpdateCallback(walk);
    return place;
}
