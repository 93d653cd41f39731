// SPDX-License-Identifier: MIT
#include <osgSkin/CharacterGroup>

#include <osg/NodeVisitor>
#include <osg/StateSet>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

namespace osgSkin {
namespace {

/// Whether a callback touches nothing but its character.
bool isOwn(const osg::Callback& callback) {
    if (std::strcmp(callback.libraryName(), "osgSkin") == 0) return true;
    if (std::strcmp(callback.libraryName(), "osgAnimation") != 0) return false;
    constexpr std::array<const char*, 4> kOwn = {"UpdateBone", "UpdateSkeleton",
                                                 "UpdateMatrixTransform", "BasicAnimationManager"};
    return std::any_of(kOwn.begin(), kOwn.end(), [&](const char* name) {
        return std::strcmp(callback.className(), name) == 0;
    });
}

/// Updates one character, as osgUtil::UpdateVisitor does. Stops at what may touch others.
class CharacterUpdate : public osg::NodeVisitor {
public:
    CharacterUpdate() : osg::NodeVisitor(UPDATE_VISITOR, TRAVERSE_ACTIVE_CHILDREN) {}

    /// \return false where it has stopped
    bool update(osg::Node& child, const osg::NodeVisitor& nv) {
        setFrameStamp(const_cast<osg::FrameStamp*>(nv.getFrameStamp()));
        setTraversalNumber(nv.getTraversalNumber());
        setTraversalMask(nv.getTraversalMask());
        setNodeMaskOverride(nv.getNodeMaskOverride());
        getNodePath() = nv.getNodePath();
        _hasStopped = false;
        child.accept(*this);
        getNodePath().clear();
        setFrameStamp(nullptr);
        return !_hasStopped;
    }

    void apply(osg::Node& node) override {
        if (_hasStopped) return;
        const osg::StateSet* const state = node.getStateSet();
        osg::Callback* const callback = node.getUpdateCallback();
        _hasStopped = (state && state->requiresUpdateTraversal()) || node.asCamera();
        for (const osg::Callback* c = callback; c && !_hasStopped; c = c->getNestedCallback())
            _hasStopped = !isOwn(*c);
        if (_hasStopped) return;
        if (callback)
            callback->run(&node, this);
        else if (node.getNumChildrenRequiringUpdateTraversal() > 0)
            traverse(node);
    }

private:
    bool _hasStopped = false;
};

/// The skins and the callbacks below a node.
class FindParts : public osg::NodeVisitor {
public:
    FindParts() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Node& node) override {
        for (const osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            callbacks.push_back(c);
        if (auto* skin = dynamic_cast<DeformableSkin*>(&node)) skins.emplace_back(skin);
        traverse(node);
    }
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    std::vector<const osg::Callback*> callbacks;
};

} // namespace

std::size_t CharacterGroup::ordinaryChildren() const {
    return static_cast<std::size_t>(
        std::count_if(_children.begin(), _children.end(),
                      [](const Child& child) { return child.isOrdinary || child.isNew; }));
}

void CharacterGroup::findChildren() {
    const unsigned int count = getNumChildren();
    bool isSame = _children.size() == count;
    for (unsigned int i = 0; i < count && isSame; ++i)
        isSame = _children[i].node == getChild(i) && !_children[i].isNew;
    if (isSame) return;
    std::vector<Child> before = std::move(_children);
    std::sort(before.begin(), before.end(),
              [](const Child& a, const Child& b) { return a.node < b.node; });
    _children.assign(count, Child());
    std::set<const osg::Callback*> seen;
    for (unsigned int i = 0; i < count; ++i) {
        Child& child = _children[i];
        child.node = getChild(i);
        const auto known =
            std::lower_bound(before.begin(), before.end(), child.node,
                             [](const Child& a, const osg::Node* node) { return a.node < node; });
        child.isNew = known == before.end() || known->node != child.node;
        FindParts find;
        getChild(i)->accept(find);
        for (const osg::Callback* callback : find.callbacks)
            if (!seen.insert(callback).second) child.isOrdinary = true;
        child.isOrdinary = child.isOrdinary || (!child.isNew && known->isOrdinary);
        child.skins = std::move(find.skins);
    }
}

void CharacterGroup::update(osg::NodeVisitor& nv) {
    findChildren();
    if (!_pool) _pool = new DeformPool;
    dirtyBound(); // now: then characters that mark theirs on several threads do not write here
    _pool->forEach(_children.size(), [&](std::size_t i) {
        Child& child = _children[i];
        if (child.isOrdinary || child.isNew) return;
        static thread_local osg::ref_ptr<CharacterUpdate> visitor = new CharacterUpdate;
        osg::Node& node = *getChild(static_cast<unsigned int>(i));
        child.isOrdinary = !visitor->update(node, nv);
        if (child.isOrdinary) return;
        for (const osg::ref_ptr<DeformableSkin>& skin : child.skins)
            if (skin->needsDeform() && skin->wasSeen()) skin->getDeformedGeometry();
        node.getBound();
    });
    // Whatever is made at the first update is made on one thread: characters may share it.
    for (std::size_t i = 0; i < _children.size(); ++i) {
        Child& child = _children[i];
        if (!child.isOrdinary && !child.isNew) continue;
        getChild(static_cast<unsigned int>(i))->accept(nv);
        getChild(static_cast<unsigned int>(i))->getBound();
    }
}

void CharacterGroup::traverse(osg::NodeVisitor& nv) {
    if (nv.getVisitorType() != osg::NodeVisitor::UPDATE_VISITOR) {
        osg::Group::traverse(nv);
        return;
    }
    update(nv);
    for (Child& child : _children) child.isNew = false;
}

} // namespace osgSkin
