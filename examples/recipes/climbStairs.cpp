// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/FootPlacement>
#include <osgSkinMotion/MakeWalker>

#include <osgUtil/LineSegmentIntersector>

/// A figure that walks over a ground, such as stairs or a slope, in its own size.
osg::ref_ptr<osg::Node> climbStairs(const std::string& file, osg::Node& ground) {
    /// Moves a figure along by the steps of its clip, and to the ground, before its bones move.
    struct Climb : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            auto& place = static_cast<osg::MatrixTransform&>(*node->getParent(0));
            place.preMult(player->takeRootMatrix()); // the player has advanced
            const osg::Vec3d at = place.getMatrix().getTrans(), up(0, 0, node->getBound().radius());
            const osg::ref_ptr line = new osgUtil::LineSegmentIntersector(at + up, at - up);
            ground->accept(*osg::ref_ptr(new osgUtil::IntersectionVisitor(line)));
            if (line->containsIntersections())
                place.postMult(osg::Matrixd::translate(
                    line->getFirstIntersection().getWorldIntersectPoint() - at));
            traverse(node, nv);
        }
        osg::ref_ptr<osgSkin::ClipPlayer> player;
        osg::Node* ground = nullptr;
    };
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    osgSkin::WalkerReport clips;
    osgSkin::makeWalker(*character.root, {}, &clips); // knows which of the clips is a walk
    osgSkin::attach<osgSkin::FootPlacement>(*character.root)->setGround(&ground);
    const osg::ref_ptr<Climb> climb = new Climb;
    climb->player = osgSkin::attach<osgSkin::ClipPlayer>(*character.root);
    climb->player->setRoot(osgSkin::ClipPlayer::Root::FromFeet);
    climb->player->play({climb->player->clip(clips.walking)});
    climb->ground = &ground;
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(character.root);
    character.root->addUpdateCallback(climb); // after the player
    return place;
}
