// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>
#include <osgSkin/GlmOsg>

#include <osgAnimation/BoneMapVisitor>

namespace osgSkin {

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton)
    : _skinning(joints.size(), glm::dmat4(1.0)) {
    osgAnimation::BoneMapVisitor visitor;
    skeleton.accept(visitor);
    const osgAnimation::BoneMap& bones = visitor.getBoneMap();
    for (const BoundJoint& joint : joints) {
        const auto found = bones.find(joint.name);
        _entries.push_back({found != bones.end() ? found->second : nullptr, joint.parent});
        if (found == bones.end()) _missing.push_back(joint.name);
    }
}

const std::vector<glm::dmat4>& BoneReader::read() {
    for (std::size_t j = 0; j < _entries.size(); ++j) {
        const Entry& entry = _entries[j];
        if (const osgAnimation::Bone* bone = entry.bone.get())
            _skinning[j] =
                toGlm(bone->getInvBindMatrixInSkeletonSpace() * bone->getMatrixInSkeletonSpace());
        else
            _skinning[j] = entry.parent < 0 ? glm::dmat4(1.0)
                                            : _skinning[static_cast<std::size_t>(entry.parent)];
    }
    return _skinning;
}

} // namespace osgSkin
