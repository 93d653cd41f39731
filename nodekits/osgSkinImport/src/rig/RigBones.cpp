// SPDX-License-Identifier: MIT
#include "rig/RigBones.h"

#include "assimp/AssimpScene.h"
#include "assimp/SceneBind.h"

#include <osgSkin/GlmOsg>

#include <osgAnimation/Bone>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace osgSkin {
namespace {

osg::ref_ptr<osgAnimation::Bone> makeBone(const std::string& name, const glm::dmat4& local,
                                          bool moves) {
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
    const osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
    osgAnimation::StackedTransform& stack = update->getStackedTransforms();
    if (moves) {
        const NodeTransform parts = decompose(local);
        stack.push_back(new osgAnimation::StackedTranslateElement(
            "translate", osg::Vec3(toOsg(parts.translation))));
        stack.push_back(
            new osgAnimation::StackedQuaternionElement("quaternion", toOsg(parts.rotation)));
        stack.push_back(
            new osgAnimation::StackedScaleElement("scale", osg::Vec3(toOsg(parts.scale))));
    } else {
        stack.push_back(new osgAnimation::StackedMatrixElement("matrix", toOsg(local)));
    }
    bone->setUpdateCallback(update);
    bone->setMatrix(toOsg(local));
    return bone;
}

} // namespace

NodeTransform decompose(const glm::dmat4& matrix) {
    glm::dmat4 unmirrored = matrix;
    NodeTransform result{glm::dvec3(matrix[3]), {1.0, 0.0, 0.0, 0.0}, glm::dvec3(1.0)};
    for (int axis = 0; axis < 3; ++axis) result.scale[axis] = glm::length(glm::dvec3(matrix[axis]));
    if (glm::determinant(glm::dmat3(matrix)) < 0.0) {
        result.scale.x = -result.scale.x;
        unmirrored[0] = -unmirrored[0];
    }
    result.rotation = rotationOf(unmirrored);
    return result;
}

osg::ref_ptr<osgAnimation::Skeleton> makeBones(const SceneSkeleton& joints,
                                               const std::vector<bool>& moves) {
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setName("skeleton");
    skeleton->setDefaultUpdateCallback();
    osg::Group* top = skeleton.get();
    if (joints.aboveRoot != glm::dmat4(1.0)) {
        const osg::ref_ptr<osgAnimation::Bone> above =
            makeBone(joints.rest.joints[0].name + ":above", joints.aboveRoot, false);
        above->setMatrixInSkeletonSpace(toOsg(joints.aboveRoot));
        skeleton->addChild(above);
        top = above.get();
    }
    std::vector<osgAnimation::Bone*> bones;
    std::vector<glm::dmat4> toScene;
    for (std::size_t j = 0; j < joints.nodes.size(); ++j) {
        const RestJoint& joint = joints.rest.joints[j];
        const glm::dmat4 local = toGlm(joints.nodes[j]->mTransformation);
        const osg::ref_ptr<osgAnimation::Bone> bone = makeBone(joint.name, local, moves[j]);
        const auto parent = static_cast<std::size_t>(joint.parent);
        toScene.push_back((joint.parent < 0 ? joints.aboveRoot : toScene[parent]) * local);
        bone->setMatrixInSkeletonSpace(toOsg(toScene[j]));
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(toOsg(joints.bind[j])));
        (joint.parent < 0 ? top : bones[parent])->addChild(bone);
        bones.push_back(bone);
    }
    return skeleton;
}

} // namespace osgSkin
