// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>

#include <osgSkin/GlmOsg>

#include <osgAnimation/BoneMapVisitor>

namespace osgSkin {

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton) {
    osgAnimation::BoneMapVisitor visitor;
    skeleton.accept(visitor);
    const osgAnimation::BoneMap& bones = visitor.getBoneMap();
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
