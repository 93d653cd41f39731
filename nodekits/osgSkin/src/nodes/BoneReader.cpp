// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>

#include <osgSkin/GlmOsg>

#include <utility>
#include <vector>

namespace osgSkin {
namespace {

class OwnBones : public osgAnimation::BoneMapVisitor {
public:
    using osgAnimation::BoneMapVisitor::apply;
    void apply(osg::Transform& node) override {
        if (getNodePath().size() > 1 && dynamic_cast<osgAnimation::Skeleton*>(&node)) return;
        osgAnimation::BoneMapVisitor::apply(node);
    }
    osgAnimation::BoneMap take() { return std::move(_map); }
};

} // namespace

osgAnimation::BoneMap bonesOf(osgAnimation::Skeleton& skeleton) {
    OwnBones visitor;
    skeleton.accept(visitor);
    return visitor.take();
}

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton,
                       const osg::Node* skin)
    : _skeleton(&skeleton) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    _bones.reserve(joints.size());
    for (const BoundJoint& joint : joints) {
        const auto bone = bones.find(joint.name);
        if (bone != bones.end()) {
            _bones.emplace_back(bone->second->getOrCreateObserverSet());
        } else {
            _missing.push_back(joint.name);
            _bones.emplace_back(
                joint.parent < 0 ? nullptr : _bones[static_cast<std::size_t>(joint.parent)].get());
        }
    }
    _places = placesOf(skin);
}

const osgAnimation::Bone* BoneReader::boneOf(std::size_t joint) const {
    const osg::ObserverSet* const observer = _bones[joint].get();
    return observer ? static_cast<const osgAnimation::Bone*>(observer->getObserverdObject())
                    : nullptr;
}

std::uint64_t BoneReader::placesOf(const osg::Node* skin) const {
    std::uint64_t result = 14695981039346656037u; // FNV-1a, a number at a time
    const auto add = [&result](std::uintptr_t number) {
        result = (result ^ number) * 1099511628211u;
    };
    const auto addParent = [&add](const osg::Node* node) {
        const osg::Group* parent = node && node->getNumParents() > 0 ? node->getParent(0) : nullptr;
        add(reinterpret_cast<std::uintptr_t>(parent));
    };
    for (std::size_t j = 0; j < _bones.size(); ++j) addParent(boneOf(j));
    addParent(skin);
    if (_missing.empty()) return result;
    const auto addChildren = [&add](const osg::Group* node) {
        add(node ? node->getNumChildren() : 0);
    };
    for (std::size_t j = 0; j < _bones.size(); ++j) addChildren(boneOf(j));
    addChildren(_skeleton.get());
    return result;
}

bool BoneReader::isOutdated(const osg::Node* skin) const {
    return placesOf(skin) != _places;
}

const std::vector<glm::dmat4>& BoneReader::read() const {
    // Shared by the readers of a thread: a crowd has many.
    static thread_local std::vector<glm::dmat4> skinning;
    skinning.assign(_bones.size(), glm::dmat4(1.0));
    for (std::size_t j = 0; j < _bones.size(); ++j)
        if (const osgAnimation::Bone* bone = boneOf(j))
            skinning[j] =
                toGlm(bone->getInvBindMatrixInSkeletonSpace() * bone->getMatrixInSkeletonSpace());
    return skinning;
}

} // namespace osgSkin
