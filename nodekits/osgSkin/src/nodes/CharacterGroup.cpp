// SPDX-License-Identifier: MIT
#include <osgSkin/CharacterGroup>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/StateSet>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

namespace osgSkin {
namespace {

/// Whether a callback touches nothing but its character.
bool isOwn(const osg::Callback& callback) {
    for (const char* kit : {"osgSkin", "osgSkinMotion"})
        if (std::strcmp(callback.libraryName(), kit) == 0) return true;
    if (std::strcmp(callback.libraryName(), "osgAnimation") != 0) return false;
    constexpr std::array<const char*, 4> kOwn = {"UpdateBone", "UpdateSkeleton",
                                                 "UpdateMatrixTransform", "BasicAnimationManager"};
    return std::any_of(kOwn.begin(), kOwn.end(), [&](const char* name) {
        return std::strcmp(callback.className(), name) == 0;
    });
}

/// Whether a callback does nothing but show a clip at the frame's time.
bool showsTime(const osg::Callback& callback) {
    constexpr std::array<const char*, 8> kClips = {
        "UpdateBone",           "UpdateSkeleton",        "UpdateMatrixTransform",
        "AutoPlayManager",      "BasicAnimationManager", "UpdatePlayedSkeleton",
        "UpdateDeformableSkin", "UpdateMorphs"};
    return isOwn(callback) && std::any_of(kClips.begin(), kClips.end(), [&](const char* name) {
               return std::strcmp(callback.className(), name) == 0;
           });
}

/// Whether a node wants update traversals for something else than what is below it.
bool updatesItself(const osg::Node& node) {
    const osg::Group* const group = node.asGroup();
    unsigned int below = 0;
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i) {
        const osg::Node& child = *group->getChild(i);
        if (child.getUpdateCallback() || child.getNumChildrenRequiringUpdateTraversal() > 0)
            ++below;
    }
    const osg::StateSet* const state = node.getStateSet();
    return node.getNumChildrenRequiringUpdateTraversal() > below ||
           (state && state->requiresUpdateTraversal());
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
    /// A collector: for other visitors walkers make poses of their own.
    FindParts() : osg::NodeVisitor(COLLECT_OCCLUDER_VISITOR, TRAVERSE_ALL_CHILDREN) {
        setNodeMaskOverride(~0u);
    }
    void apply(osg::Node& node) override {
        updatesItself = updatesItself || osgSkin::updatesItself(node);
        for (const osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            callbacks.push_back(c);
        if (auto* skin = dynamic_cast<DeformableSkin*>(&node)) skins.emplace_back(skin);
        traverse(node);
    }
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    std::vector<const osg::Callback*> callbacks;
    bool updatesItself = false;
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
        child.mayWait = !find.updatesItself && !child.isOrdinary &&
                        std::all_of(find.callbacks.begin(), find.callbacks.end(),
                                    [](const osg::Callback* c) { return showsTime(*c); });
        child.skins = std::move(find.skins);
    }
    _sizes = std::vector<std::atomic<float>>(count);
    for (std::atomic<float>& size : _sizes) size = -1.0f;
}

/// How many frames a child's update serves.
unsigned int CharacterGroup::framesOf(std::size_t index) {
    const float size = _sizes[index].exchange(-1.0f, std::memory_order_relaxed);
    const auto full = static_cast<float>(_fullRateSize);
    if (!_children[index].mayWait || size < 0.0f || size >= full) return 1;
    return size >= 0.5f * full ? 2 : size >= 0.25f * full ? 4 : 8;
}

/// \return false where the child needs an ordinary update
bool CharacterGroup::updateChild(std::size_t index, const osg::NodeVisitor& nv) {
    static thread_local osg::ref_ptr<CharacterUpdate> visitor = new CharacterUpdate;
    Child& child = _children[index];
    osg::Node& node = *getChild(static_cast<unsigned int>(index));
    child.isOrdinary = !visitor->update(node, nv);
    child.isLate = false;
    return !child.isOrdinary;
}

void CharacterGroup::update(osg::NodeVisitor& nv) {
    findChildren();
    if (!_pool) _pool = new DeformPool;
    dirtyBound(); // now: then characters that mark theirs on several threads do not write here
    _pool->forEach(_children.size(), [&](std::size_t i) {
        Child& child = _children[i];
        if (child.isOrdinary || child.isNew) return;
        child.isLate = (_updates + i) % framesOf(i) != 0;
        if (child.isLate) _isLate = true;
        if (child.isLate || !updateChild(i, nv)) return;
        for (const osg::ref_ptr<DeformableSkin>& skin : child.skins)
            if (skin->needsDeform() && skin->wasSeen()) skin->getDeformedGeometry();
        getChild(static_cast<unsigned int>(i))->getBound();
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
    const osg::NodeVisitor::VisitorType type = nv.getVisitorType();
    if (type != osg::NodeVisitor::UPDATE_VISITOR) {
        if (type == osg::NodeVisitor::CULL_VISITOR)
            measure(nv);
        else if (type != osg::NodeVisitor::EVENT_VISITOR && _isLate)
            catchUp();
        osg::Group::traverse(nv);
        return;
    }
    _isLate = false;
    ++_updates;
    update(nv);
    for (Child& child : _children) child.isNew = false;
    if (!_isLate) return;
    if (!_last) _last = new osg::NodeVisitor(osg::NodeVisitor::UPDATE_VISITOR);
    const osg::FrameStamp* const stamp = nv.getFrameStamp();
    _last->setFrameStamp(stamp ? new osg::FrameStamp(*stamp) : nullptr);
    _last->setTraversalNumber(nv.getTraversalNumber());
    _last->setTraversalMask(nv.getTraversalMask());
    _last->setNodeMaskOverride(nv.getNodeMaskOverride());
    _last->getNodePath() = nv.getNodePath();
}

/// Updates those that have waited.
void CharacterGroup::catchUp() {
    const std::lock_guard<std::mutex> lock(_catching);
    for (std::size_t i = 0; i < _children.size() && _isLate; ++i)
        if (_children[i].isLate && i < getNumChildren() &&
            _children[i].node == getChild(unsigned(i)))
            updateChild(i, *_last);
    _isLate = false;
}

/// Notes how large a camera sees the children.
void CharacterGroup::measure(osg::NodeVisitor& nv) {
    osgUtil::CullVisitor* const cv = nv.asCullVisitor();
    if (!cv || _fullRateSize == 0.0 || _sizes.size() != getNumChildren()) return;
    for (std::size_t i = 0; i < _sizes.size(); ++i) {
        const float size = std::max(0.0f, cv->pixelSize(getChild(unsigned(i))->getBound()));
        float before = _sizes[i].load(std::memory_order_relaxed);
        while (before < size &&
               !_sizes[i].compare_exchange_weak(before, size, std::memory_order_relaxed)) {
        }
    }
}

void CharacterGroup::setFullRateSize(double pixels) {
    if (pixels >= 0.0 && std::isfinite(pixels)) _fullRateSize = pixels;
}

} // namespace osgSkin
