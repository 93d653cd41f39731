// SPDX-License-Identifier: MIT
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgAnimation/BoneMapVisitor>

namespace osgSkin {
namespace {

osgAnimation::Skeleton* nearestSkeleton(const osg::NodePath& path) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(*node)) return skeleton;
    return nullptr;
}

} // namespace

UpdateDeformableSkin::UpdateDeformableSkin(const UpdateDeformableSkin& other,
                                           const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop),
      osg::DrawableUpdateCallback(other, copyop) {
    // Bones are not copied: the copy finds those of the skeleton that it comes to stand under.
}

void UpdateDeformableSkin::update(osg::NodeVisitor* nv, osg::Drawable* drawable) {
    auto* skin = dynamic_cast<DeformableSkin*>(drawable);
    osgAnimation::Skeleton* skeleton = nv ? nearestSkeleton(nv->getNodePath()) : nullptr;
    if (skin && skeleton) pose(*skin, *skeleton);
}

bool UpdateDeformableSkin::pose(DeformableSkin& skin, osgAnimation::Skeleton& skeleton) {
    if (!skin.getModel()) return false;
    if (_skeleton.get() != &skeleton || _linkedModel != skin.getModel().get()) link(skin, skeleton);
    const std::vector<BoundJoint>& joints = skin.getModel()->joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (const osgAnimation::Bone* bone = _bones[j].get())
            _skinning[j] = toGlm(bone->getInvBindMatrixInSkeletonSpace() *
                                 bone->getMatrixInSkeletonSpace());
        else
            _skinning[j] = joints[j].parent < 0
                               ? glm::dmat4(1.0)
                               : _skinning[static_cast<std::size_t>(joints[j].parent)];
    }
    return skin.setPose(_skinning.data(), _skinning.size());
}

void UpdateDeformableSkin::link(const DeformableSkin& skin, osgAnimation::Skeleton& skeleton) {
    osgAnimation::BoneMapVisitor visitor;
    skeleton.accept(visitor);
    const osgAnimation::BoneMap& bones = visitor.getBoneMap();
    const std::vector<BoundJoint>& joints = skin.getModel()->joints();
    _bones.assign(joints.size(), nullptr);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto found = bones.find(joints[j].name);
        if (found != bones.end())
            _bones[j] = found->second;
        else
            OSG_WARN << "osgSkin: skin \"" << skin.getName() << "\": skeleton \""
                     << skeleton.getName() << "\" has no bone \"" << joints[j].name
                     << "\"; the joint moves with its parent" << std::endl;
    }
    _skinning.assign(joints.size(), glm::dmat4(1.0));
    _skeleton = &skeleton;
    _linkedModel = skin.getModel().get();
}

} // namespace osgSkin
