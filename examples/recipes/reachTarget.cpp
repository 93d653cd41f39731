// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/RotateBone>

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
    const osg::Vec3d shoulder = character.restPosition("RightUpperArm");
    const double arm = (character.restPosition("RightHand") - shoulder).length();
    const osg::Vec3d ball = shoulder + osg::Vec3d(-0.4, -0.7, -0.45) * arm;
    character.root->addChild(new osg::ShapeDrawable(new osg::Sphere(ball, float(0.3 * arm))));
    const osg::ref_ptr<Reach> reach = new Reach;
    reach->forearm = character.boneByRole("RightLowerArm");
    reach->hand = character.boneByRole("RightHand");
    const osg::Matrixd fromScene = osg::Matrixd::inverse(character.toWorld);
    reach->target = (ball + osg::Vec3d(0, 0, 0.4 * arm)) * fromScene;
    reach->elbow = osg::Matrixd::transform3x3(osg::Vec3d(-1, 0, -1), fromScene);
    character.boneByRole("RightUpperArm")->addUpdateCallback(reach);
    return character.root;
}
