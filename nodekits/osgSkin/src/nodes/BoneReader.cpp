// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>

#include <osgSkin/GlmOsg>

#include <set>
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
};

std::set<const osg::Node*> nodesAbove(const osg::Node* node) {
    std::set<const osg::Node*> result;
    std::vector<const osg::Node*> open;
    if (node) open.push_back(node);
    while (!open.empty()) {
        const osg::Node& next = *open.back();
        open.pop_back();
        for (unsigned i = 0; i < next.getNumParents(); ++i)
            if (result.insert(next.getParent(i)).second) open.push_back(next.getParent(i));
    }
    return result;
}

} // namespace

osgAnimation::BoneMap bonesOf(osgAnimation::Skeleton& skeleton) {
    OwnBones visitor;
    skeleton.accept(visitor);
    return visitor.getBoneMap();
}

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton,
                       const osg::Node* skin) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    const std::set<const osg::Node*> above = nodesAbove(skin);
    _bones.reserve(joints.size());
    std::vector<osgAnimation::Bone*> found(joints.size(), nullptr);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto bone = bones.find(joints[j].name);
        if (bone != bones.end()) {
            found[j] = bone->second;
        } else {
            _missing.push_back(joints[j].name);
            if (joints[j].parent >= 0) found[j] = found[static_cast<std::size_t>(joints[j].parent)];
        }
        const bool keepsSkin = found[j] && above.count(found[j]) > 0;
        _bones.emplace_back(keepsSkin ? nullptr : found[j]);
        if (!keepsSkin) continue;
        if (!_above) _above = new Above;
        _above->bones[j] = found[j];
    }
    _places = placesOf(skin);
}

const osgAnimation::Bone* BoneReader::boneOf(std::size_t joint) const {
    if (_bones[joint] || !_above) return _bones[joint].get();
    const auto found = _above->bones.find(joint);
    return found == _above->bones.end() ? nullptr : found->second.get();
}

std::uint64_t BoneReader::placesOf(const osg::Node* skin) const {
    std::uint64_t result = 14695981039346656037u; // FNV-1a, an address at a time
    const auto add = [&](const osg::Node* node) {
        const osg::Group* parent = node && node->getNumParents() > 0 ? node->getParent(0) : nullptr;
        result = (result ^ reinterpret_cast<std::uintptr_t>(parent)) * 1099511628211u;
    };
    for (std::size_t j = 0; j < _bones.size(); ++j) add(boneOf(j));
    add(skin);
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
