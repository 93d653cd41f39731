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
    const osg::ref_ptr<osgAnimation::Bone> hand = character.bone("RightHand");

    // Where the sword is when the figure stands as its mesh does, in the mesh's space: in the
    // palm, which is between the wrist and the fingers, and across the fingers.
    const osg::Matrixd rest = osg::Matrixd::rotate(osg::Vec3d(0, 0, 1), osg::Vec3d(0.33, 0.37, 1)) *
                              osg::Matrixd::translate(osg::Vec3d(-0.65, 1.01, 0.03));
    // The inverse bind matrix leads from there to the bone.
    const osg::ref_ptr<osg::MatrixTransform> inHand =
        new osg::MatrixTransform(rest * hand->getInvBindMatrixInSkeletonSpace());
    inHand->addChild(makeSword());
    hand->addChild(inHand);
    return character.root;
}
