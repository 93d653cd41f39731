// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinRig/RotateBone>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <cmath>

namespace {

/// Raises and lowers a bone on top of the clip that plays.
struct Raise : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // all bones below are now in the clip's pose
        const double time = nv->getFrameStamp()->getSimulationTime();
        // The thrower's skeleton has Y up and faces +Z: the left arm goes up about Z.
        const osg::Quat rotation(1.7 + 0.4 * std::sin(3.0 * time), osg::Vec3d(0, 0, 1));
        osgSkin::rotateBone(static_cast<osgAnimation::Bone&>(*node), rotation);
    }
};

} // namespace

/// A figure that walks with a raised arm.
osg::ref_ptr<osg::Node> driveBone(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    character.bone("LeftArm")->addUpdateCallback(new Raise);
    return character.root;
}
