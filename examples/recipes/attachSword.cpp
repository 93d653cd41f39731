// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

namespace {

/// A sword along +Z, its grip at the origin.
osg::ref_ptr<osg::Node> makeSword() {
    osg::ref_ptr<osg::Group> sword = new osg::Group;
    sword->addChild(
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(0, 0, 0.5f), 0.05f, 0.012f, 0.8f)));
    sword->addChild(
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(0, 0, 0.1f), 0.2f, 0.03f, 0.03f)));
    sword->addChild(new osg::ShapeDrawable(new osg::Cylinder(osg::Vec3(), 0.017f, 0.2f)));
    return sword;
}

} // namespace

/// A sword that moves with the right hand.
osg::ref_ptr<osg::Node> attachSword(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::ref_ptr<osgAnimation::Bone> hand = character.boneByRole("RightHand");

    // In the scene, in the bind pose: in the palm, pointing ahead (-Y), as large as suits a figure.
    const osg::Vec3d wrist = character.restPosition("RightHand");
    const osg::Vec3d forearm = wrist - character.restPosition("RightLowerArm");
    const osg::Matrixd inScene =
        osg::Matrixd::scale(osg::Vec3d(1, 1, 1) * (character.restPosition("Head").z() / 1.6)) *
        osg::Matrixd::rotate(osg::Vec3d(0, 0, 1), osg::Vec3d(0.3, -1, 0.35)) *
        osg::Matrixd::translate(wrist + forearm * 0.35);
    const osg::ref_ptr<osg::MatrixTransform> inHand =
        new osg::MatrixTransform(inScene * osg::Matrixd::inverse(character.toWorld) *
                                 hand->getInvBindMatrixInSkeletonSpace());
    inHand->addChild(makeSword());
    hand->addChild(inHand);
    return character.root;
}
