// SPDX-License-Identifier: MIT
#include <osgSkin/BoneReader>

#include <osgSkin/GlmOsg>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace osgSkin {
namespace {

class OwnBones : public osgAnimation::BoneMapVisitor {
public:
    using osgAnimation::BoneMapVisitor::apply;
    void apply(osg::Transform& node) override {
        const osg::NodePath& path = getNodePath();
        if (path.size() > 1 && dynamic_cast<osgAnimation::Skeleton*>(&node)) return;
        if (path.size() > 1) _above.emplace(&node, path[path.size() - 2]->asGroup());
        osgAnimation::BoneMapVisitor::apply(node);
    }

    /// The node's parent on the way from the skeleton; null above that.
    const osg::Group* above(const osg::Node* node) const {
        const auto found = _above.find(node);
        return found == _above.end() ? nullptr : found->second;
    }

private:
    std::map<const osg::Node*, const osg::Group*> _above;
};

bool isChild(const std::pair<const osg::Node*, const osg::Group*>& link) {
    for (unsigned i = 0; i < link.first->getNumParents(); ++i)
        if (link.first->getParent(i) == link.second) return true;
    return false;
}

} // namespace

osgAnimation::BoneMap bonesOf(osgAnimation::Skeleton& skeleton) {
    OwnBones visitor;
    skeleton.accept(visitor);
    return visitor.getBoneMap();
}

BoneReader::BoneReader(const std::vector<BoundJoint>& joints, osgAnimation::Skeleton& skeleton) {
    OwnBones visitor;
    skeleton.accept(visitor);
    const osgAnimation::BoneMap& bones = visitor.getBoneMap();
    std::set<const osg::Node*> linked;
    _bones.reserve(joints.size());
    for (const BoundJoint& joint : joints) {
        const auto found = bones.find(joint.name);
        if (found == bones.end()) {
            _missing.push_back(joint.name);
            _bones.push_back(joint.parent < 0 ? nullptr
                                              : _bones[static_cast<std::size_t>(joint.parent)]);
        } else {
            _bones.emplace_back(found->second);
            const osg::Node* node = found->second;
            while (const osg::Group* above =
                       linked.insert(node).second ? visitor.above(node) : nullptr) {
                _links.emplace_back(node, above);
                node = above;
            }
        }
        if (_bones.back().valid()) ++_alive;
    }
}

bool BoneReader::isOutdated() const {
    const auto isAlive = [](const auto& bone) { return bone.valid(); };
    const auto alive = std::count_if(_bones.begin(), _bones.end(), isAlive);
    // A link's node is a bone, alive then, or the parent of the link before.
    return static_cast<std::size_t>(alive) < _alive ||
           !std::all_of(_links.begin(), _links.end(), isChild);
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
