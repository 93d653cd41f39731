// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/RotateBone>

#include <osg/ShapeDrawable>

namespace {

/// Turns a head towards a point while a clip plays.
struct LookAt : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv);
        auto& head = static_cast<osgAnimation::Bone&>(*node);
        osgSkin::lookAt(head, forward, target, osg::DegreesToRadians(70.0));
    }
    osg::Vec3d forward, target; ///< in the skeleton's space
};

} // namespace

/// A figure that walks and looks at a ball.
osg::ref_ptr<osg::Node> lookAtTarget(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    // In the scene, where Z is up and the figure faces -Y, in parts of its height.
    const osg::Vec3d head = character.restPosition("Head");
    const osg::Vec3d ball = head + osg::Vec3d(0.45, -0.45, -0.25) * head.z();
    character.root->addChild(new osg::ShapeDrawable(new osg::Sphere(ball, float(0.05 * head.z()))));
    const osg::Matrixd fromScene = osg::Matrixd::inverse(character.toWorld);
    const osg::ref_ptr<LookAt> lookAt = new LookAt;
    lookAt->forward = osg::Matrixd::transform3x3(osg::Vec3d(0, -1, 0), fromScene);
    lookAt->target = ball * fromScene;
    character.boneByRole("Head")->addUpdateCallback(lookAt);
    return character.root;
}
