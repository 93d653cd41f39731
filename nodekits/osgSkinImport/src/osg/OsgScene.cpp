// SPDX-License-Identifier: MIT
#include "osg/OsgScene.h"

#include "text/FileText.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinRig/ReadSkeleton>

#include <osg/NodeVisitor>
#include <osg/Transform>
#include <osgAnimation/Bone>

namespace osgSkin {
namespace {

class SkeletonFinder : public osg::NodeVisitor {
public:
    SkeletonFinder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    osgAnimation::Skeleton* found = nullptr;
    osg::NodePath path;

    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Bone*>(&node) != nullptr && found == nullptr)
            for (auto above = getNodePath().begin(); above != getNodePath().end(); ++above)
                if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(*above)) {
                    found = skeleton;
                    path.assign(getNodePath().begin(), above + 1);
                }
        if (found == nullptr) traverse(node);
    }
};

} // namespace

RestSkeleton readOsgSkeleton(osg::Node& scene, const std::string& path) {
    SkeletonFinder finder;
    scene.accept(finder);
    if (finder.found == nullptr)
        failFile(path, "no skeleton, expected an osgAnimation::Skeleton with bones");
    RestSkeleton result;
    try {
        result = readSkeleton(*finder.found);
    } catch (const Error& error) {
        failFile(path, error.what());
    }
    const osg::Matrixd toScene = osg::computeLocalToWorld(finder.path);
    for (RestJoint& joint : result.joints)
        joint.centre = toGlm(osg::Vec3d(toOsg(joint.centre) * toScene));
    return result;
}

} // namespace osgSkin
