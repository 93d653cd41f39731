// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinRig/RotateBone>

#include <osg/ShapeDrawable>

namespace {

/// Turns a head towards a point while a clip plays.
struct LookAt : osg::NodeCallback {
    explicit LookAt(const osg::Vec3d& skeletonTarget) : target(skeletonTarget) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv);
        // The face looks along +Z at rest.
        auto& head = static_cast<osgAnimation::Bone&>(*node);
        osgSkin::lookAt(head, osg::Vec3d(0, 0, 1), target, osg::DegreesToRadians(70.0));
    }
    osg::Vec3d target; ///< in the skeleton's space
};

} // namespace

/// A figure that walks and looks at a ball.
osg::ref_ptr<osg::Node> lookAtTarget(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::Vec3d ball(0.7, -0.7, 1.2); // in the scene: Z up, the figure faces -Y
    character.root->addChild(new osg::ShapeDrawable(new osg::Sphere(ball, 0.08f)));
    const osg::Vec3d target = ball * osg::Matrixd::inverse(character.toWorld);
    character.bone("Head")->addUpdateCallback(new LookAt(target));
    return character.root;
}
