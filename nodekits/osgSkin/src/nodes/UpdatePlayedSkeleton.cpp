// SPDX-License-Identifier: MIT
#include <osgSkin/UpdatePlayedSkeleton>

#include <osgSkin/GlmOsg>
#include <osgSkin/RigidPart>

#include <osg/NodeVisitor>
#include <osg/observer_ptr>
#include <osgAnimation/Channel>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <atomic>
#include <limits>
#include <typeinfo>
#include <unordered_map>
#include <utility>

namespace osgSkin {
namespace {

using osgAnimation::Bone;
using osgAnimation::Channel;
using osgAnimation::Skeleton;
using osgAnimation::StackedMatrixElement;
using osgAnimation::StackedQuaternionElement;
using osgAnimation::StackedScaleElement;
using osgAnimation::StackedTranslateElement;
using QuatKeys = osgAnimation::TemplateKeyframeContainer<osg::Quat>;
using Vec3Keys = osgAnimation::TemplateKeyframeContainer<osg::Vec3>;

/// Whether a channel has set the target since its last reset().
struct TargetState : osgAnimation::Target {
    static bool isSet(const osgAnimation::Target& target) {
        return target.*(&TargetState::_weight) > 0.0f ||
               target.*(&TargetState::_priorityWeight) > 0.0f;
    }
};

/// Keys that are tried linearly before a binary search.
constexpr std::size_t kNearKeys = 4;

/// Prefetches; any address is allowed.
void prefetch([[maybe_unused]] std::uintptr_t address) {
#ifdef __GNUC__
    __builtin_prefetch(reinterpret_cast<const void*>(address));
#endif
}

osg::Vec3 between(const osg::Vec3& a, const osg::Vec3& b, float share) {
    return a * (1.0f - share) + b * share;
}

osg::Quat between(const osg::Quat& a, const osg::Quat& b, float share) {
    osg::Quat result;
    result.slerp(static_cast<double>(share), a, b);
    return result;
}

// Named for OSG's row-vector order; glm's columns are OSG's rows.

void preTranslate(glm::dmat4& m, const osg::Vec3& v) {
    m[3] += double(v.x()) * m[0] + double(v.y()) * m[1] + double(v.z()) * m[2];
}

void preScale(glm::dmat4& m, const osg::Vec3& v) {
    m[0] *= double(v.x());
    m[1] *= double(v.y());
    m[2] *= double(v.z());
}

/// As osg::Matrixd::preMultRotate(): a quaternion that is not unit is normalised.
void preRotate(glm::dmat4& m, const osg::Quat& q) {
    const double length2 = q.length2();
    // As in OSG, a quaternion of zeros makes a singular matrix.
    const double twice = length2 <= std::numeric_limits<double>::min() ? 0.0 : 2.0 / length2;
    const double one = twice == 0.0 ? 0.0 : 1.0;
    const double x2 = q.x() * twice, y2 = q.y() * twice, z2 = q.z() * twice;
    const double xx = q.x() * x2, xy = q.x() * y2, xz = q.x() * z2;
    const double yy = q.y() * y2, yz = q.y() * z2, zz = q.z() * z2;
    const double wx = q.w() * x2, wy = q.w() * y2, wz = q.w() * z2;
    const glm::dvec4 a = m[0], b = m[1], c = m[2];
    m[0] = (one - (yy + zz)) * a + (xy + wz) * b + (xz - wy) * c;
    m[1] = (xy - wz) * a + (one - (xx + zz)) * b + (yz + wx) * c;
    m[2] = (xz + wy) * a + (yz - wx) * b + (one - (xx + yy)) * c;
}

bool isAffine(const osg::Matrixd& m) {
    return m(0, 3) == 0.0 && m(1, 3) == 0.0 && m(2, 3) == 0.0 && m(3, 3) == 1.0;
}

/// An element of a bone's stack of transforms.
struct Element {
    enum Kind { kTranslate, kRotate, kScale, kMatrix, kUnknown };

    explicit Element(osgAnimation::StackedTransformElement* of) : element(of) {
        if (dynamic_cast<StackedTranslateElement*>(of))
            kind = kTranslate;
        else if (dynamic_cast<StackedQuaternionElement*>(of))
            kind = kRotate;
        else if (dynamic_cast<StackedScaleElement*>(of))
            kind = kScale;
        else if (auto* matrix = dynamic_cast<StackedMatrixElement*>(of))
            kind = !matrix->getTarget() && isAffine(matrix->getMatrix()) ? kMatrix : kUnknown;
        target = of ? of->getTarget() : nullptr;
    }

    Kind kind = kUnknown;
    bool isStepped = false;
    std::size_t cursor = 0; ///< the first one of the two keys that were used last
    osgAnimation::StackedTransformElement* element;
    osgAnimation::Target* target; ///< the element's; null: no channel has been linked with it
    osg::ref_ptr<const osgAnimation::KeyframeContainer> keys; ///< of the clip; may be null
    std::uintptr_t lastKey = 0;                               ///< at `cursor`; may be gone
};

/// The value of an element's keys at a time, as osgAnimation's channels compute it.
///
/// \param step expected advance in keys (a hint)
template <typename Value, typename Keys>
Value sample(Element& element, double time, std::ptrdiff_t step) {
    const auto& container = static_cast<const Keys&>(*element.keys);
    const auto* const keys = &container.front();
    const std::size_t count = container.size();
    const auto isAt = [&](std::size_t k) {
        return k < count - 1 && keys[k].getTime() < time && time <= keys[k + 1].getTime();
    };
    // The last key of all and the first are in other memory: they are looked at only if the time is
    // not near the last one's.
    std::size_t k = element.cursor + static_cast<std::size_t>(step);
    for (std::size_t tried = 0; tried < kNearKeys && !isAt(k); ++tried) ++k;
    if (!isAt(k)) {
        if (time >= keys[count - 1].getTime()) return keys[count - 1].getValue();
        if (time <= keys[0].getTime()) return keys[0].getValue();
        const auto* const after =
            std::lower_bound(keys, keys + count, time,
                             [](const auto& key, double wanted) { return key.getTime() < wanted; });
        k = static_cast<std::size_t>(after - keys) - 1;
    }
    element.cursor = k;
    element.lastKey = reinterpret_cast<std::uintptr_t>(keys + k);
    if (element.isStepped) {
        // On a key, osgAnimation takes the one before, but for the last.
        return keys[k + 2 == count && time >= keys[k + 1].getTime() ? k + 1 : k].getValue();
    }
    const double interval = keys[k + 1].getTime() - keys[k].getTime();
    const auto share = static_cast<float>((time - keys[k].getTime()) / interval);
    return between(keys[k].getValue(), keys[k + 1].getValue(), share);
}

template <typename Value, typename Get>
Value valueOf(const Element& element, const Get& get) {
    if (!element.target) return get();
    return static_cast<const osgAnimation::TemplateTarget<Value>*>(element.target)->getValue();
}

void apply(Element& e, double time, std::ptrdiff_t step, glm::dmat4& m) {
    switch (e.kind) {
    case Element::kTranslate:
        preTranslate(
            m, e.keys ? sample<osg::Vec3, Vec3Keys>(e, time, step) : valueOf<osg::Vec3>(e, [&] {
                return static_cast<StackedTranslateElement*>(e.element)->getTranslate();
            }));
        break;
    case Element::kRotate:
        preRotate(m,
                  e.keys ? sample<osg::Quat, QuatKeys>(e, time, step) : valueOf<osg::Quat>(e, [&] {
                      return static_cast<StackedQuaternionElement*>(e.element)->getQuaternion();
                  }));
        break;
    case Element::kScale:
        preScale(m,
                 e.keys ? sample<osg::Vec3, Vec3Keys>(e, time, step) : valueOf<osg::Vec3>(e, [&] {
                     return static_cast<StackedScaleElement*>(e.element)->getScale();
                 }));
        break;
    case Element::kMatrix:
        m = m * toGlm(static_cast<StackedMatrixElement*>(e.element)->getMatrix());
        break;
    case Element::kUnknown:
        break;
    }
}

/// A channel's keys, if they are of a kind that sample() knows.
template <typename Linear, typename Stepped>
bool takeKeys(const Channel& channel, Element& element) {
    const auto* linear = dynamic_cast<const Linear*>(&channel);
    const auto* stepped = dynamic_cast<const Stepped*>(&channel);
    if (linear && linear->getSamplerTyped())
        element.keys = linear->getSamplerTyped()->getKeyframeContainerTyped();
    else if (stepped && stepped->getSamplerTyped())
        element.keys = stepped->getSamplerTyped()->getKeyframeContainerTyped();
    element.isStepped = stepped != nullptr;
    element.cursor = 0;
    return element.keys && element.keys->size() > 0;
}

bool takeKeys(const Channel& channel, Element& element) {
    switch (element.kind) {
    case Element::kTranslate:
    case Element::kScale:
        return takeKeys<osgAnimation::Vec3LinearChannel, osgAnimation::Vec3StepChannel>(channel,
                                                                                        element);
    case Element::kRotate:
        return takeKeys<osgAnimation::QuatSphericalLinearChannel, osgAnimation::QuatStepChannel>(
            channel, element);
    default:
        return false;
    }
}

/// Searches for OSG's rigs, which read bones.
class FindRigs : public osg::NodeVisitor {
public:
    FindRigs() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Drawable& drawable) override {
        if (dynamic_cast<osgAnimation::RigGeometry*>(&drawable)) found = true;
    }
    bool found = false;
};

/// A matrix of a cull visitor's own, as it uses for transforms.
struct MatrixPool : osgUtil::CullVisitor {
    static osg::RefMatrix* take(osgUtil::CullVisitor& cv) {
        return (cv.*(&MatrixPool::createOrReuseMatrix))(*cv.getModelViewMatrix());
    }
};

bool isBone(const osg::Node& node) {
    return dynamic_cast<const Bone*>(&node) != nullptr;
}

/// A bone and what is needed to detect changes.
struct PlayedBone {
    Bone* bone;
    int parent;
    osgAnimation::UpdateBone* update; ///< null if its callback is not a plain UpdateBone
    osg::Callback* callback;
    osg::Callback* nested;
    unsigned int updatedChildren;
    std::size_t firstChild, childCount;
    std::size_t firstElement, elementCount;
    glm::dmat4 inverseBind;
};

struct PlayedPart {
    osg::ref_ptr<RigidPart> part;
    std::size_t bone;
    osg::Matrixd toSkeleton; ///< from the bone's node, in the last pose()
};

struct PlayedChild {
    osg::Node* node;
    unsigned int updatedChildren;
};

unsigned int updatedChildrenOf(const osg::Node& node) {
    const osg::Group* group = node.asGroup();
    return group ? group->getNumChildrenRequiringUpdateTraversal() : 0;
}

} // namespace

/// The skeleton as it was found, the clip's channels on it, and its pose.
struct UpdatePlayedSkeleton::Playing {
    void find(Skeleton& skeleton);
    void findBones(osg::Group& parent, int parentBone);
    void link(osgAnimation::Animation& animation);
    bool isSame(const Skeleton& skeleton);
    void updateChannels(const std::vector<osg::ref_ptr<Channel>>& list) const {
        for (const osg::ref_ptr<Channel>& channel : list) channel->reset();
        for (const osg::ref_ptr<Channel>& channel : list)
            channel->update(time, clip->getWeight(), 0);
    }
    void poseBones(osg::Group& parent) const;
    std::ptrdiff_t prefetchKeys();
    void pose();

    osg::observer_ptr<Skeleton> skeleton;
    std::vector<PlayedChild> top; ///< the skeleton's children
    std::vector<PlayedBone> bones;
    std::vector<osg::Node*> children; ///< of all bones
    std::vector<Element> elements;    ///< of all bones
    std::vector<PlayedPart> parts;
    bool isPlain = false;      ///< nothing is known that needs the bones
    bool isDrawnPlain = false; ///< bones have no state, mask or callback of their own
    bool isShared = false;     ///< the callback serves another skeleton, too

    osg::ref_ptr<osgAnimation::Animation> clip;
    std::size_t channelCount = 0;
    std::vector<osg::ref_ptr<Channel>> driving; ///< bones
    std::vector<osg::ref_ptr<Channel>> others;
    bool isLinked = false; ///< all channels of bones are known ones

    bool hasPlayed = false; ///< play() was called since the last update
    double time = 0.0;

    std::vector<glm::dmat4> inSkeleton;
    std::vector<glm::dmat4> skinning;
};

void UpdatePlayedSkeleton::Playing::findBones(osg::Group& parent, int parentBone) {
    for (unsigned int i = 0; i < parent.getNumChildren(); ++i) {
        auto* bone = dynamic_cast<Bone*>(parent.getChild(i));
        if (!bone) continue;
        PlayedBone found{};
        found.bone = bone;
        found.parent = parentBone;
        found.callback = bone->getUpdateCallback();
        found.nested = found.callback ? found.callback->getNestedCallback() : nullptr;
        found.updatedChildren = bone->getNumChildrenRequiringUpdateTraversal();
        found.inverseBind = toGlm(bone->getInvBindMatrixInSkeletonSpace());
        found.firstChild = children.size();
        found.childCount = bone->getNumChildren();
        found.firstElement = elements.size();
        auto* update = dynamic_cast<osgAnimation::UpdateBone*>(found.callback);
        if (update && typeid(*update) == typeid(osgAnimation::UpdateBone) && !found.nested)
            found.update = update;
        if (found.update)
            for (const auto& element : found.update->getStackedTransforms())
                elements.emplace_back(element.get());
        found.elementCount = elements.size() - found.firstElement;
        isPlain = isPlain && found.update && bone->getNumParents() == 1 &&
                  bone->getReferenceFrame() == osg::Transform::RELATIVE_RF &&
                  isAffine(bone->getInvBindMatrixInSkeletonSpace()) &&
                  std::all_of(elements.begin() + static_cast<std::ptrdiff_t>(found.firstElement),
                              elements.end(),
                              [](const Element& e) { return e.kind != Element::kUnknown; });
        const int index = static_cast<int>(bones.size());
        unsigned int updatedBones = 0;
        for (unsigned int c = 0; c < bone->getNumChildren(); ++c) {
            osg::Node* const child = bone->getChild(c);
            children.push_back(child);
            if (isBone(*child)) {
                if (child->getUpdateCallback() || updatedChildrenOf(*child) > 0) ++updatedBones;
                continue;
            }
            auto* part = dynamic_cast<RigidPart*>(child);
            if (part && part->getNumParents() == 1 &&
                part->getReferenceFrame() == osg::Transform::RELATIVE_RF)
                parts.push_back({part, bones.size(), {}});
            else
                isPlain = false;
        }
        isPlain = isPlain && found.updatedChildren == updatedBones;
        bones.push_back(found);
        findBones(*bone, index);
    }
}

void UpdatePlayedSkeleton::Playing::find(Skeleton& from) {
    // A callback on two living skeletons cannot keep the state of both.
    if (skeleton.valid() && skeleton.get() != &from) {
        for (osg::Callback* c = skeleton->getUpdateCallback(); c; c = c->getNestedCallback())
            for (osg::Callback* own = from.getUpdateCallback(); own; own = own->getNestedCallback())
                isShared = isShared || (c == own && dynamic_cast<UpdatePlayedSkeleton*>(c));
    }
    skeleton = &from;
    top.clear();
    bones.clear();
    children.clear();
    elements.clear();
    parts.clear();
    isPlain = true;
    findBones(from, -1);
    FindRigs rigs;
    for (unsigned int i = 0; i < from.getNumChildren(); ++i) {
        osg::Node& child = *from.getChild(i);
        top.push_back({&child, updatedChildrenOf(child)});
        if (!isBone(child)) child.accept(rigs);
    }
    isPlain = isPlain && !rigs.found && !bones.empty();
    inSkeleton.resize(bones.size());
    skinning.resize(bones.size());
}

bool UpdatePlayedSkeleton::Playing::isSame(const Skeleton& now) {
    if (skeleton.get() != &now || now.getNumChildren() != top.size()) return false;
    for (std::size_t i = 0; i < top.size(); ++i) {
        const osg::Node* child = now.getChild(static_cast<unsigned int>(i));
        if (child != top[i].node || updatedChildrenOf(*child) != top[i].updatedChildren)
            return false;
    }
    isDrawnPlain = true;
    // Parents come first, so that no pointer is followed whose owner has dropped it.
    for (const PlayedBone& was : bones) {
        const Bone& bone = *was.bone;
        if (bone.getUpdateCallback() != was.callback || bone.getNumChildren() != was.childCount ||
            bone.getNumChildrenRequiringUpdateTraversal() != was.updatedChildren)
            return false;
        for (std::size_t c = 0; c < was.childCount; ++c)
            if (bone.getChild(static_cast<unsigned int>(c)) != children[was.firstChild + c])
                return false;
        if (was.callback && was.callback->getNestedCallback() != was.nested) return false;
        isDrawnPlain = isDrawnPlain && !bone.getStateSet() && !bone.getCullCallback() &&
                       bone.getNodeMask() == ~0u;
        if (!was.update) continue;
        const osgAnimation::StackedTransform& stack = was.update->getStackedTransforms();
        if (stack.size() != was.elementCount) return false;
        for (std::size_t e = 0; e < was.elementCount; ++e)
            if (stack[e].get() != elements[was.firstElement + e].element) return false;
    }
    return true;
}

/// Divides a clip's channels into those that move the bones and others.
void UpdatePlayedSkeleton::Playing::link(osgAnimation::Animation& animation) {
    clip = &animation;
    channelCount = animation.getChannels().size();
    driving.clear();
    others.clear();
    isLinked = true;
    std::unordered_map<const osgAnimation::Target*, Element*> byTarget;
    for (Element& element : elements) {
        element.keys = nullptr;
        element.target = element.element ? element.element->getTarget() : nullptr;
        if (element.target) byTarget.emplace(element.target, &element);
    }
    for (const osg::ref_ptr<Channel>& channel : animation.getChannels()) {
        const auto found = byTarget.find(channel->getTarget());
        if (found == byTarget.end()) {
            others.push_back(channel);
            continue;
        }
        driving.push_back(channel);
        // A second channel of one target would be blended.
        isLinked = isLinked && !found->second->keys && takeKeys(*channel, *found->second);
    }
}

/// Asks for the keys and elements that pose() needs. Among many characters they have left the
/// caches, and each would be waited for.
///
/// \return how many keys the time has gone on, by the first channel: clips mostly have keys of all
///         bones at the same times
std::ptrdiff_t UpdatePlayedSkeleton::Playing::prefetchKeys() {
    const auto first = std::find_if(elements.begin(), elements.end(),
                                    [](const Element& element) { return element.keys.valid(); });
    if (first == elements.end()) return 0;
    const std::size_t before = first->cursor;
    glm::dmat4 unused(1.0);
    apply(*first, time, 0, unused);
    const auto step = static_cast<std::ptrdiff_t>(first->cursor - before);
    first->cursor = before;
    constexpr std::size_t kLine = 64;
    for (const Element& e : elements) {
        const auto at = reinterpret_cast<std::uintptr_t>(
            e.keys ? static_cast<const void*>(e.keys.get()) : e.element);
        prefetch(at);
        if (e.keys) {
            const std::size_t size = e.kind == Element::kRotate
                                         ? sizeof(osgAnimation::QuatKeyframe)
                                         : sizeof(osgAnimation::Vec3Keyframe);
            const std::uintptr_t key = e.lastKey + static_cast<std::size_t>(step) * size;
            prefetch(key);
            prefetch(key + kLine);
        } else if (e.target) {
            prefetch(reinterpret_cast<std::uintptr_t>(e.target));
        } else {
            prefetch(at + kLine);
        }
    }
    return step;
}

void UpdatePlayedSkeleton::Playing::pose() {
    const std::ptrdiff_t step = prefetchKeys();
    for (std::size_t b = 0; b < bones.size(); ++b) {
        const PlayedBone& bone = bones[b];
        glm::dmat4 own(1.0);
        for (std::size_t e = 0; e < bone.elementCount; ++e)
            apply(elements[bone.firstElement + e], time, step, own);
        glm::dmat4& m = inSkeleton[b];
        m = bone.parent < 0 ? own : inSkeleton[static_cast<std::size_t>(bone.parent)] * own;
        skinning[b] = m * bone.inverseBind;
        // Costs little: no bound above is marked as old, since nobody asks for the bones' bounds.
        bone.bone->setMatrix(toOsg(own));
        bone.bone->setMatrixInSkeletonSpace(toOsg(m));
    }
    for (PlayedPart& part : parts) part.toSkeleton = toOsg(inSkeleton[part.bone]);
}

UpdatePlayedSkeleton::UpdatePlayedSkeleton() = default;
UpdatePlayedSkeleton::~UpdatePlayedSkeleton() = default;

UpdatePlayedSkeleton::UpdatePlayedSkeleton(const UpdatePlayedSkeleton& other,
                                           const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop),
      osgAnimation::Skeleton::UpdateSkeleton(other, copyop), _bonesFollow(other._bonesFollow) {
    // OSG copies a node's callbacks before its children.
    const_cast<UpdatePlayedSkeleton&>(other).poseBones();
}

UpdatePlayedSkeleton* UpdatePlayedSkeleton::of(const osg::Node& skeleton) {
    for (const osg::Callback* c = skeleton.getUpdateCallback(); c; c = c->getNestedCallback())
        if (auto* found = dynamic_cast<const UpdatePlayedSkeleton*>(c))
            return const_cast<UpdatePlayedSkeleton*>(found);
    return nullptr;
}

bool UpdatePlayedSkeleton::play(osgAnimation::Animation& clip, double time) {
    Playing* const playing = _playing.get();
    if (!playing || playing->isShared) return false;
    if (playing->clip != &clip || playing->channelCount != clip.getChannels().size()) {
        if (_skipsBones) stopSkipping(); // the channels that lead there are about to be forgotten
        playing->link(clip);
    }
    if (!playing->isLinked) return false;
    playing->time = time;
    playing->hasPlayed = true;
    playing->updateChannels(playing->others);
    return true;
}

/// Sets bones to the last pose, as their callbacks would have; one that has lost its callback, too.
void UpdatePlayedSkeleton::Playing::poseBones(osg::Group& parent) const {
    const auto* const parentBone = dynamic_cast<const Bone*>(&parent);
    const osg::Matrixd above = parentBone ? parentBone->getMatrixInSkeletonSpace() : osg::Matrixd();
    for (unsigned int i = 0; i < parent.getNumChildren(); ++i) {
        auto* bone = dynamic_cast<Bone*>(parent.getChild(i));
        if (!bone) continue;
        const auto was = std::find_if(bones.begin(), bones.end(),
                                      [&](const PlayedBone& b) { return b.bone == bone; });
        if (auto* update = dynamic_cast<osgAnimation::UpdateBone*>(bone->getUpdateCallback())) {
            update->getStackedTransforms().update();
            bone->setMatrix(update->getStackedTransforms().getMatrix());
            bone->setMatrixInSkeletonSpace(bone->getMatrix() * above);
        } else if (was != bones.end()) {
            const osg::Matrixd m = toOsg(inSkeleton[static_cast<std::size_t>(was - bones.begin())]);
            bone->setMatrixInSkeletonSpace(m);
            bone->setMatrix(was->parent < 0
                                ? m
                                : m * osg::Matrixd::inverse(toOsg(
                                          inSkeleton[static_cast<std::size_t>(was->parent)])));
        }
        poseBones(*bone);
    }
}

/// Makes channels' targets, bones and rigid parts as if the bones had followed.
void UpdatePlayedSkeleton::stopSkipping() {
    _skipsBones = false;
    Playing& playing = *_playing;
    for (const osg::ref_ptr<Channel>& channel : playing.driving)
        // Those that are set are another animation's now.
        if (!TargetState::isSet(*channel->getTarget())) channel->update(playing.time, 1.0f, 0);
    if (!playing.skeleton.valid()) return;
    playing.poseBones(*playing.skeleton);
    playing.skeleton->dirtyBound(); // see PlayedSkeletonBound
}

void UpdatePlayedSkeleton::poseBones() {
    if (_skipsBones) stopSkipping();
}

const std::vector<glm::dmat4>& UpdatePlayedSkeleton::skinning() const {
    static const std::vector<glm::dmat4> none;
    return _playing ? _playing->skinning : none;
}

int UpdatePlayedSkeleton::find(const osgAnimation::Bone* bone) const {
    if (_playing)
        for (std::size_t b = 0; b < _playing->bones.size(); ++b)
            if (_playing->bones[b].bone == bone) return static_cast<int>(b);
    return -1;
}

void UpdatePlayedSkeleton::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    auto* skeleton = dynamic_cast<Skeleton*>(node);
    if (!skeleton || !nv || nv->getVisitorType() != osg::NodeVisitor::UPDATE_VISITOR)
        return UpdateSkeleton::operator()(node, nv);
    if (!_playing) _playing = std::make_unique<Playing>();
    Playing& playing = *_playing;
    const bool hasPlayed = std::exchange(playing.hasPlayed, false);
    if (!playing.isShared && !playing.isSame(*skeleton)) {
        if (_skipsBones) stopSkipping();
        playing.find(*skeleton);
        static std::atomic<unsigned int> revisions{0};
        _revision = ++revisions;
        if (playing.clip) playing.link(*playing.clip);
        if (!skeleton->getCullCallback()) skeleton->setCullCallback(new CullPlayedSkeleton);
        if (!skeleton->getComputeBoundingSphereCallback())
            skeleton->setComputeBoundingSphereCallback(new PlayedSkeletonBound);
    }
    const bool skips = hasPlayed && playing.isLinked && playing.isPlain && !playing.isShared &&
                       !_bonesFollow && !getNestedCallback();
    if (!skips) {
        if (_skipsBones) stopSkipping();
        if (hasPlayed) playing.updateChannels(playing.driving);
        return UpdateSkeleton::operator()(node, nv);
    }
    if (!_skipsBones)
        for (const osg::ref_ptr<Channel>& channel : playing.driving) channel->reset();
    _skipsBones = true;
    playing.pose();
    skeleton->dirtyBound();
    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i)
        if (!isBone(*skeleton->getChild(i))) skeleton->getChild(i)->accept(*nv);
}

bool UpdatePlayedSkeleton::mayDrawWithoutBones() const {
    return _skipsBones && _playing->isDrawnPlain;
}

void UpdatePlayedSkeleton::CullPlayedSkeleton::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    osgUtil::CullVisitor* const cv = nv ? nv->asCullVisitor() : nullptr;
    osg::Group* const skeleton = node ? node->asGroup() : nullptr;
    const UpdatePlayedSkeleton* const played =
        cv && skeleton && !getNestedCallback() ? of(*node) : nullptr;
    if (!played || !played->mayDrawWithoutBones()) {
        traverse(node, nv);
        return;
    }
    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i)
        if (!isBone(*skeleton->getChild(i))) skeleton->getChild(i)->accept(*nv);
    for (const PlayedPart& part : played->_playing->parts) {
        osg::RefMatrix* const matrix = MatrixPool::take(*cv);
        matrix->preMult(part.toSkeleton);
        cv->pushModelViewMatrix(matrix, osg::Transform::RELATIVE_RF);
        part.part->accept(*nv);
        cv->popModelViewMatrix();
    }
}

// The bones' own bounds are not asked for, so they may stay marked as old while the skeleton's is
// new: stopSkipping() marks the latter, too.
osg::BoundingSphere
UpdatePlayedSkeleton::PlayedSkeletonBound::computeBound(const osg::Node& node) const {
    const auto* const skeleton = dynamic_cast<const Skeleton*>(&node);
    const UpdatePlayedSkeleton* const played = skeleton ? of(node) : nullptr;
    if (!played || !played->_skipsBones) return node.computeBound();
    osg::BoundingBox box;
    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i) {
        const osg::Node& child = *skeleton->getChild(i);
        if (isBone(child)) continue;
        const osg::Transform* const transform = child.asTransform();
        if (transform && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF) continue;
        if (const osg::Drawable* drawable = child.asDrawable())
            box.expandBy(drawable->getBoundingBox());
        else
            box.expandBy(child.getBound());
    }
    for (const PlayedPart& part : played->_playing->parts) {
        osg::BoundingSphere sphere = part.part->getBound();
        if (!sphere.valid()) continue;
        osg::BoundingSphere moved(sphere.center() * part.toSkeleton, 0.0f);
        for (const osg::Vec3& axis : {osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0), osg::Vec3(0, 0, 1)})
            moved.radius() = std::max(
                moved.radius(),
                sphere.radius() * osg::Matrixd::transform3x3(axis, part.toSkeleton).length());
        box.expandBy(moved);
    }
    osg::BoundingSphere result;
    if (!box.valid()) return result;
    const osg::Matrixd& toParent = skeleton->getMatrix();
    result.set(box.center() * toParent, 0.0f);
    for (unsigned int corner = 0; corner < 8; ++corner)
        result.radius() =
            std::max(result.radius(), (box.corner(corner) * toParent - result.center()).length());
    return result;
}

} // namespace osgSkin
