// SPDX-License-Identifier: MIT
#include <osgSkinRig/MakeSkeleton>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinRig/ReadSkeleton>

#include <osg/NodeVisitor>
#include <osgAnimation/Bone>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <vector>

namespace osgSkin {

osg::ref_ptr<osgAnimation::Skeleton> makeSkeleton(const RestSkeleton& rig) {
    rig.validate();
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setName("skeleton");
    skeleton->setUpdateCallback(new UpdatePlayedSkeleton);

    std::vector<osgAnimation::Bone*> bones;
    for (const RestJoint& joint : rig.joints) {
        osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(joint.name);
        const auto parent = static_cast<std::size_t>(joint.parent);
        const glm::dvec3 offset =
            joint.parent < 0 ? joint.centre : joint.centre - rig.joints[parent].centre;

        osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(joint.name);
        osgAnimation::StackedTransform& stack = update->getStackedTransforms();
        stack.push_back(new osgAnimation::StackedTranslateElement("translate", toOsg(offset)));
        stack.push_back(new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
        bone->setUpdateCallback(update);

        // The rest pose holds before the first update too.
        const osg::Matrixd toSkeleton = osg::Matrixd::translate(toOsg(joint.centre));
        bone->setMatrix(osg::Matrixd::translate(toOsg(offset)));
        bone->setMatrixInSkeletonSpace(toSkeleton);
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(toSkeleton));

        osg::Group* above = skeleton.get();
        if (joint.parent >= 0) above = bones[parent];
        above->addChild(bone);
        bones.push_back(bone);
    }
    return skeleton;
}

namespace {

/// Lists the bones of one skeleton, parents before children.
class BoneLister : public osg::NodeVisitor {
public:
    BoneLister() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    struct Entry {
        const osgAnimation::Bone* bone;
        int parent;
        osg::Matrixd toSkeleton; ///< from the bone, as the transforms are now
    };
    std::vector<Entry> bones;

    void apply(osg::Transform& node) override {
        if (depth > 0 && dynamic_cast<osgAnimation::Skeleton*>(&node) != nullptr) return; // another
        const osg::Matrixd outer = toSkeleton;
        const int above = parent;
        if (depth > 0) node.computeLocalToWorldMatrix(toSkeleton, this);
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node)) {
            bones.push_back({bone, parent, toSkeleton});
            parent = static_cast<int>(bones.size()) - 1;
        }
        ++depth;
        traverse(node);
        --depth;
        parent = above;
        toSkeleton = outer;
    }

private:
    int depth = 0;
    int parent = -1;
    osg::Matrixd toSkeleton;
};

osg::Matrixd boundMatrix(const osgAnimation::Bone& bone) {
    osg::Matrixd bind;
    const osg::Matrixd& inverse = bone.getInvBindMatrixInSkeletonSpace();
    if (!inverse.valid() || !bind.invert(inverse))
        throw Error("bone \"" + bone.getName() + "\": its inverse bind matrix cannot be inverted");
    return bind;
}

glm::dquat rotationOf(const osg::Matrixd& matrix) {
    osg::Vec3d translation, scale;
    osg::Quat rotation, scaleAxes;
    matrix.decompose(translation, rotation, scale, scaleAxes);
    return toGlm(rotation);
}

} // namespace

RestSkeleton readSkeleton(const osgAnimation::Skeleton& skeleton) {
    BoneLister lister;
    const_cast<osgAnimation::Skeleton&>(skeleton).accept(lister); // visitors change nothing here
    const std::string name = "skeleton \"" + skeleton.getName() + "\"";
    if (lister.bones.empty()) throw Error(name + " has no bone, expected at least one");

    bool bound = false;
    std::size_t roots = 0;
    for (const BoneLister::Entry& entry : lister.bones) {
        bound = bound || !entry.bone->getInvBindMatrixInSkeletonSpace().isIdentity();
        roots += entry.parent < 0 ? 1 : 0;
    }
    RestSkeleton result;
    if (roots > 1) result.joints.push_back({skeleton.getName(), -1, glm::dvec3(0.0), {}});
    const int shift = static_cast<int>(result.joints.size());
    for (const BoneLister::Entry& entry : lister.bones) {
        const osg::Matrixd matrix = bound ? boundMatrix(*entry.bone) : entry.toSkeleton;
        const int parent = entry.parent < 0 ? shift - 1 : entry.parent + shift;
        result.joints.push_back({entry.bone->getName(),
                                 parent,
                                 toGlm(osg::Vec3d(matrix.getTrans())),
                                 {},
                                 rotationOf(matrix)});
    }
    try {
        result.validate();
    } catch (const Error& error) {
        throw Error(name + ": " + error.what());
    }
    return result;
}

} // namespace osgSkin
