// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/RotateBone>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <cmath>

namespace {

/// Raises and lowers an arm on top of the clip that plays.
struct Raise : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // all bones below are now in the clip's pose
        auto& arm = static_cast<osgAnimation::Bone&>(*node);
        const double angle = 0.5 + 0.4 * std::sin(3.0 * nv->getFrameStamp()->getSimulationTime());
        osg::Quat rotation; // from the clip's direction of the arm to the wanted one
        rotation.makeRotate(elbow->getMatrixInSkeletonSpace().getTrans() -
                                arm.getMatrixInSkeletonSpace().getTrans(),
                            side * std::cos(angle) + up * std::sin(angle));
        osgSkin::rotateBone(arm, rotation);
    }
    osg::ref_ptr<osgAnimation::Bone> elbow;
    osg::Vec3d side, up; ///< in the skeleton's space
};

} // namespace

/// A figure that walks with a raised arm.
osg::ref_ptr<osg::Node> driveBone(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::Matrixd fromScene = osg::Matrixd::inverse(character.toWorld);
    const osg::ref_ptr<Raise> raise = new Raise;
    raise->elbow = character.boneByRole("LeftLowerArm");
    raise->side = osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), fromScene); // its left
    raise->up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), fromScene);
    character.boneByRole("LeftUpperArm")->addUpdateCallback(raise);
    return character.root;
}
