// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>

#include <osgSkin/GlmOsg>

#include <map>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

class OwnBones : public osgAnimation::BoneMapVisitor {
public:
    using osgAnimation::BoneMapVisitor::apply;
    void apply(osg::Transform& node) override {
        const osg::NodePath& path = getNodePath();
        if (path.size() > 1 && dynamic_cast<osgAnimation::Skeleton*>(&node)) return;
        if (path.size() > 1) _parents.emplace(&node, path[path.size() - 2]->asGroup());
        osgAnimation::BoneMapVisitor::apply(node);
    }

    /// On the way from the skeleton.
    const osg::Group* parentOf(const osg::Node& node) const { return _parents.at(&node); }

private:
    std::map<const osg::Node*, const osg::Group*> _parents;
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

bool standsBelow(const osg::Node& node, const osg::Group* parent) {
    for (unsigned i = 0; i < node.getNumParents(); ++i)
        if (node.getParent(i) == parent) return true;
    return false;
}

} // namespace

osgAnimation::BoneMap bonesOf(osgAnimation::Skeleton& skeleton) {
    OwnBones visitor;
    skeleton.accept(visitor);
    return visitor.getBoneMap();
}

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton,
                       const osg::Node* skin) {
    OwnBones visitor;
    skeleton.accept(visitor);
    const osgAnimation::BoneMap& bones = visitor.getBoneMap();
    const std::set<const osg::Node*> above = nodesAbove(skin);
    _bones.reserve(joints.size());
    _parents.reserve(joints.size());
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
        if (keepsSkin) _above.push_back({j, found[j]});
        _bones.emplace_back(keepsSkin ? nullptr : found[j]);
        _parents.push_back(found[j] ? visitor.parentOf(*found[j]) : nullptr);
    }
}

const osgAnimation::Bone* BoneReader::boneOf(std::size_t joint) const {
    if (_bones[joint] || _above.empty()) return _bones[joint].get();
    for (const Above& above : _above)
        if (above.joint == joint) return above.bone.get();
    return nullptr;
}

bool BoneReader::isOutdated() const {
    for (std::size_t j = 0; j < _parents.size(); ++j) {
        if (!_parents[j]) continue;
        const osgAnimation::Bone* bone = boneOf(j);
        if (!bone || !standsBelow(*bone, _parents[j])) return true;
    }
    return false;
}

const std::vector<glm::dmat4>& BoneReader::read() const {
    // Not the reader's own: a crowd has many of them.
    static thread_local std::vector<glm::dmat4> skinning;
    skinning.assign(_bones.size(), glm::dmat4(1.0));
    for (std::size_t j = 0; j < _bones.size(); ++j)
        if (const osgAnimation::Bone* bone = boneOf(j))
            skinning[j] =
                toGlm(bone->getInvBindMatrixInSkeletonSpace() * bone->getMatrixInSkeletonSpace());
    return skinning;
}

} // namespace osgSkin
