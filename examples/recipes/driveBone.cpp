// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/RotateBone>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <cmath>

namespace {

/// Raises and lowers an arm on top of the clip that plays.
struct Raise : osg::NodeCallback {
    explicit Raise(const osg::Vec3d& skeletonAxis) : axis(skeletonAxis) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // all bones below are now in the clip's pose
        const double time = nv->getFrameStamp()->getSimulationTime();
        const osg::Quat rotation(1.7 + 0.4 * std::sin(3.0 * time), axis);
        osgSkin::rotateBone(static_cast<osgAnimation::Bone&>(*node), rotation);
    }
    osg::Vec3d axis; ///< in the skeleton's space
};

} // namespace

/// A figure that walks with a raised arm.
osg::ref_ptr<osg::Node> driveBone(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    // About the direction in which the figure looks: -Y in the scene.
    const osg::Matrixd fromScene = osg::Matrixd::inverse(character.toWorld);
    osg::Vec3d axis = osg::Matrixd::transform3x3(osg::Vec3d(0, -1, 0), fromScene);
    axis.normalize();
    character.boneByRole("LeftUpperArm")->addUpdateCallback(new Raise(axis));
    return character.root;
}
