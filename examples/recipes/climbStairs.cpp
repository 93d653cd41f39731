// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/FootPlacement>

#include <osg/ShapeDrawable>

namespace {

/// Moves a figure along by the steps of its clip, and up by 20 degrees, before its bones move.
struct Climb : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        auto& place = static_cast<osg::MatrixTransform&>(*node->getParent(0));
        place.preMult(player->takeRootMatrix()); // the player has advanced
        osg::Matrixd next = place.getMatrix();
        next(3, 2) = 0.364 * osg::clampBetween(-1.0 - next(3, 1), 0.0, 4.32);
        place.setMatrix(next);
        traverse(node, nv);
    }
    osg::ref_ptr<osgSkin::ClipPlayer> player;
};

} // namespace

/// A figure that walks over a ground: up stairs, or a slope.
osg::ref_ptr<osg::Node> climbStairs(const std::string& file, osg::Node& ground) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    osgSkin::attach<osgSkin::FootPlacement>(*character.root)->setGround(&ground);
    const osg::ref_ptr<Climb> climb = new Climb;
    climb->player = osgSkin::attach<osgSkin::ClipPlayer>(*character.root);
    climb->player->setRoot(osgSkin::ClipPlayer::Root::ExtractedWithTurn);
    climb->player->play({climb->player->clip("walk")});
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(character.root);
    character.root->addUpdateCallback(climb); // after the player
    return place;
}
