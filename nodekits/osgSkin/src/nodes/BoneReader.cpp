// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>

#include <osgSkin/GlmOsg>

#include <algorithm>

namespace osgSkin {
namespace {

class OwnBones : public osgAnimation::BoneMapVisitor {
public:
    using osgAnimation::BoneMapVisitor::apply;
    void apply(osg::Transform& node) override {
        if (getNodePath().size() > 1 && dynamic_cast<osgAnimation::Skeleton*>(&node)) return;
        osgAnimation::BoneMapVisitor::apply(node);
    }
};

} // namespace

osgAnimation::BoneMap bonesOf(osgAnimation::Skeleton& skeleton) {
    OwnBones visitor;
    skeleton.accept(visitor);
    return visitor.getBoneMap();
}

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    _bones.reserve(joints.size());
    for (const BoundJoint& joint : joints) {
        const auto found = bones.find(joint.name);
        if (found != bones.end()) {
            _bones.push_back(found->second);
            continue;
        }
        _missing.push_back(joint.name);
        _bones.push_back(joint.parent < 0 ? nullptr
                                          : _bones[static_cast<std::size_t>(joint.parent)]);
    }
}

bool BoneReader::isOutdated() const {
    return std::any_of(_bones.begin(), _bones.end(),
                       [](const auto& bone) { return bone && bone->getNumParents() == 0; });
}

const std::vector<glm::dmat4>& BoneReader::read() const {
    // Not the reader's own: a crowd has many of them.
    static thread_local std::vector<glm::dmat4> skinning;
    skinning.assign(_bones.size(), glm::dmat4(1.0));
    for (std::size_t j = 0; j < _bones.size(); ++j)
        if (const osgAnimation::Bone* bone = _bones[j].get())
            skinning[j] =
                toGlm(bone->getInvBindMatrixInSkeletonSpace() * bone->getMatrixInSkeletonSpace());
    return skinning;
}

} // namespace osgSkin
