// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinRig/RotateBone>

#include <osg/ShapeDrawable>

namespace {

/// Puts a hand at a point while a clip plays: a callback of the upper arm.
struct Reach : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv);
        auto& arm = static_cast<osgAnimation::Bone&>(*node);
        osgSkin::reach(arm, *forearm, *hand, target, elbow);
    }
    osg::ref_ptr<osgAnimation::Bone> forearm, hand;
    osg::Vec3d target; ///< in the skeleton's space
    osg::Vec3d elbow;  ///< the direction in which it points
};

} // namespace

/// A figure that walks with a hand on a ball.
osg::ref_ptr<osg::Node> reachTarget(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::Vec3d ball(-0.25, -0.42, 1.25);
    character.root->addChild(new osg::ShapeDrawable(new osg::Sphere(ball, 0.08f)));
    const osg::ref_ptr<Reach> reach = new Reach;
    reach->forearm = character.bone("RightForeArm");
    reach->hand = character.bone("RightHand");
    const osg::Matrixd fromWorld = osg::Matrixd::inverse(character.toWorld);
    reach->target = (ball + osg::Vec3d(0, 0, 0.1)) * fromWorld;
    reach->elbow = osg::Matrixd::transform3x3(osg::Vec3d(-1, 0, -1), fromWorld);
    character.bone("RightArm")->addUpdateCallback(reach);
    return character.root;
}
