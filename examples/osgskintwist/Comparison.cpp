// SPDX-License-Identifier: MIT
#include "Comparison.h"

#include "DualQuaternionBlend.h"
#include "LinearBlend.h"

#include <osgSkin/GlmOsg>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinRig/Clip>
#include <osgSkinRig/MakeSkeleton>

#include <osgAnimation/BoneMapVisitor>
#include <osgAnimation/UpdateBone>

#include <algorithm>

namespace twist {
namespace {

constexpr char kUpperBone[] = "upper";

/// Two bones, the upper one turning about the origin. The chain's two ends lie inside the skin, as
/// a body's hips and wrists do: the end joint never turns, but shows how long the upper bone is.
osgSkin::RestSkeleton twoBones() {
    constexpr double end = Cylinder::kHalfLength - 0.5;
    osgSkin::RestSkeleton bones;
    bones.joints = {{"lower", -1, {0, 0, -end}, {}},
                    {kUpperBone, 0, {0, 0, 0}, {}},
                    {"end", 1, {0, 0, end}, glm::dvec3(0, 0, Cylinder::kHalfLength)}};
    return bones;
}

/// Weights of the two bones that change over one radius to either side of the joint.
compare::SkinWeights smoothWeights(const std::vector<glm::dvec3>& rest) {
    compare::SkinWeights weights;
    for (const glm::dvec3& position : rest) {
        const double t = std::clamp(0.5 * (position.z + 1.0), 0.0, 1.0);
        const double upper = t * t * (3.0 - 2.0 * t);
        weights.add({{0, 1.0 - upper}, {1, upper}});
    }
    return weights;
}

/// The part of the bone's update callback that an animation, or a key press here, turns it by.
osg::ref_ptr<osgAnimation::StackedQuaternionElement> turnOf(osgAnimation::Skeleton& skeleton) {
    osgAnimation::BoneMapVisitor visitor;
    skeleton.accept(visitor);
    auto& update = dynamic_cast<osgAnimation::UpdateBone&>(
        *visitor.getBoneMap().at(kUpperBone)->getUpdateCallback());
    for (const auto& element : update.getStackedTransforms())
        if (auto* turn = dynamic_cast<osgAnimation::StackedQuaternionElement*>(element.get()))
            return turn;
    return nullptr; // never: makeSkeleton() gives every bone one
}

} // namespace

const char* nameOf(Method method) {
    switch (method) {
    case Method::Linear:
        return "linear blending";
    case Method::DualQuaternion:
        return "dual quaternions";
    default:
        return "osgSkin";
    }
}

Comparison::Comparison()
    : _update(new osgUtil::UpdateVisitor),
      _linear(_cylinder.part, _cylinder.mesh.positions, smoothWeights(_cylinder.mesh.positions),
              compare::linearBlendMatrices),
      _dualQuaternion(_cylinder.part, _cylinder.mesh.positions,
                      smoothWeights(_cylinder.mesh.positions),
                      compare::dualQuaternionBlendMatrices) {
    const osgSkin::RestSkeleton bones = twoBones();
    _skeleton = osgSkin::makeSkeleton(bones);
    osgSkin::BindOptions
        options; // the paper's model alone: a fold that is pressed flat loses volume
    options.shapes = osgSkin::BindOptions::Shapes::None;
    const osgSkin::AttachedSkin attached =
        osgSkin::attachSkin(*_skeleton, _cylinder.mesh, {_cylinder.part},
                            osgSkin::bind(_cylinder.mesh, bones, options));
    _skin = attached.skins.front().drawable;
    _skinSource = attached.skins.front().part.sourceVertex;
    _turn = turnOf(*_skeleton);
    setPose({});
}

void Comparison::setPose(const TwistPose& pose) {
    const glm::dquat rotation = pose.rotation();
    _turn->setQuaternion(osgSkin::toOsg(rotation));
    // The joint is the origin, so its skinning matrix is the turn alone.
    const std::vector<glm::dmat4> skinning{glm::dmat4(1.0), glm::mat4_cast(rotation)};
    _linear.setPose(skinning);
    _dualQuaternion.setPose(skinning);
}

osg::Node* Comparison::node(Method method) const {
    if (method == Method::Ours) return _skeleton.get();
    return (method == Method::Linear ? _linear : _dualQuaternion).geometry();
}

std::vector<glm::dvec3> Comparison::positions(Method method) {
    if (method == Method::Linear) return _linear.positions();
    if (method == Method::DualQuaternion) return _dualQuaternion.positions();
    _skeleton->accept(*_update);
    const auto& posed =
        static_cast<const osg::Vec3Array&>(*_skin->getDeformedGeometry()->getVertexArray());
    std::vector<glm::dvec3> result(_cylinder.mesh.positions.size());
    for (std::size_t i = 0; i < posed.size(); ++i)
        result[_skinSource[i]] = osgSkin::toGlm(osg::Vec3d(posed[i]));
    return result;
}

} // namespace twist
