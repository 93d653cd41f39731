// SPDX-License-Identifier: MIT
#include <osgSkin/AutoPlayManager>

#include <osgSkin/UpdatePlayedSkeleton>

#include <osgAnimation/Animation>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Channel>
#include <osgAnimation/LinkVisitor>
#include <osgAnimation/Skeleton>
#include <osgAnimation/UpdateBone>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <type_traits>
#include <typeindex>
#include <typeinfo>
#include <unordered_map>
#include <vector>

namespace osgSkin {
namespace {

/// The callback as one that links channels by its name. Null for derived classes: they may link
/// otherwise, as OSG's for morph targets does.
osgAnimation::UpdateMatrixTransform* linkedByName(osg::Callback& callback) {
    const std::type_info& type = typeid(callback);
    const bool plain = type == typeid(osgAnimation::UpdateBone) ||
                       type == typeid(osgAnimation::UpdateMatrixTransform);
    return plain && !callback.getName().empty()
               ? dynamic_cast<osgAnimation::UpdateMatrixTransform*>(&callback)
               : nullptr;
}

/// Whether a node below a skeleton has a manager of its own, as a rider has. Its bones must not be
/// linked: a channel has one target, and would lose this character's bone of the same name.
bool isAnotherCharacter(osg::Node& node, const osg::NodePath& path) {
    osg::Callback* callback = node.getUpdateCallback();
    while (callback && !dynamic_cast<osgAnimation::AnimationManagerBase*>(callback))
        callback = callback->getNestedCallback();
    return callback && std::any_of(path.begin(), path.end(), [&node](const osg::Node* above) {
               return above != &node && dynamic_cast<const osgAnimation::Skeleton*>(above);
           });
}

/// Links bones and transforms with the channels of their names. OSG's visitor compares (and copies)
/// each name with that of every channel: many seconds for thousands of bones.
class NameLinker : public osgAnimation::LinkVisitor {
public:
    /// \param animations none of them null
    explicit NameLinker(const osgAnimation::AnimationList& animations) {
        _animations = animations;
        for (const auto& animation : animations)
            for (const auto& channel : animation->getChannels())
                m_channels[channel->getTargetName()].push_back(channel.get());
    }

    void apply(osg::Node& node) override {
        if (isAnotherCharacter(node, getNodePath())) return;
        if (UpdatePlayedSkeleton* skeleton = UpdatePlayedSkeleton::of(node))
            skeletons.push_back(skeleton);
        if (osg::StateSet* states = node.getStateSet()) handle_stateset(states);
        for (osg::Callback* callback = node.getUpdateCallback(); callback != nullptr;
             callback = callback->getNestedCallback()) {
            if (auto* transform = linkedByName(*callback)) {
                const auto channels = m_channels.find(transform->getName());
                if (channels == m_channels.end()) continue;
                for (osgAnimation::Channel* channel : channels->second) transform->link(channel);
                _nbLinkedTarget += static_cast<unsigned int>(channels->second.size());
            } else if (auto* other =
                           dynamic_cast<osgAnimation::AnimationUpdateCallbackBase*>(callback)) {
                link(other);
            }
        }
        traverse(node);
    }

    std::vector<UpdatePlayedSkeleton*> skeletons;

private:
    std::unordered_map<std::string, std::vector<osgAnimation::Channel*>> m_channels;
};

/// A channel of its own around the same keys. Its target is not read: another thread may set it.
template <typename Kind>
osg::ref_ptr<osgAnimation::Channel> sharingKeys(const osgAnimation::Channel& from) {
    const osg::ref_ptr<Kind> result = new Kind;
    result->setName(from.getName());
    result->setTargetName(from.getTargetName());
    if (const auto* sampler = static_cast<const Kind&>(from).getSamplerTyped()) {
        using Keys = std::remove_const_t<
            std::remove_pointer_t<decltype(sampler->getKeyframeContainerTyped())>>;
        result->getOrCreateSampler()->setKeyframeContainer(
            const_cast<Keys*>(sampler->getKeyframeContainerTyped())); // which nothing changes
    }
    return result;
}

using MakeChannel = osg::ref_ptr<osgAnimation::Channel> (*)(const osgAnimation::Channel&);

/// Null for other kinds.
MakeChannel makerOf(const osgAnimation::Channel& channel) {
    using namespace osgAnimation;
    static const std::unordered_map<std::type_index, MakeChannel> kMakers{
        {typeid(Vec3LinearChannel), sharingKeys<Vec3LinearChannel>},
        {typeid(QuatSphericalLinearChannel), sharingKeys<QuatSphericalLinearChannel>},
        {typeid(FloatLinearChannel), sharingKeys<FloatLinearChannel>},
        {typeid(Vec3StepChannel), sharingKeys<Vec3StepChannel>},
        {typeid(QuatStepChannel), sharingKeys<QuatStepChannel>},
        {typeid(FloatStepChannel), sharingKeys<FloatStepChannel>}};
    const auto found = kMakers.find(typeid(channel));
    return found == kMakers.end() ? nullptr : found->second;
}

/// An animation whose channels may be shared by copies.
struct SharedClip : osgAnimation::Animation {
    static bool isPossible(const osgAnimation::Animation& clip) {
        const osgAnimation::ChannelList& channels = clip.getChannels();
        return typeid(clip) == typeid(osgAnimation::Animation) &&
               std::all_of(channels.begin(), channels.end(),
                           [](const auto& channel) { return channel && makerOf(*channel); });
    }
    static osg::ref_ptr<osgAnimation::Animation> copy(const osgAnimation::Animation& clip) {
        osg::ref_ptr<osgAnimation::Animation> result = new osgAnimation::Animation;
        result->setName(clip.getName());
        result->setDataVariance(clip.getDataVariance());
        result->setPlayMode(clip.getPlayMode());
        result->setWeight(clip.getWeight());
        result->setStartTime(clip.getStartTime());
        // addChannel() would compute the duration each time.
        (*result).*(&SharedClip::_duration) = clip.*(&SharedClip::_duration);
        (*result).*(&SharedClip::_originalDuration) = clip.*(&SharedClip::_originalDuration);
        result->getChannels() = clip.getChannels();
        return result;
    }
};

void ownChannels(osgAnimation::Animation& clip) {
    for (osg::ref_ptr<osgAnimation::Channel>& channel : clip.getChannels())
        channel = makerOf(*channel)(*channel);
}

/// The time in a clip's keys, as osgAnimation::Animation::update() computes it.
struct ClipTime : osgAnimation::Animation {
    /// \return false where the clip is over
    static bool find(osgAnimation::Animation& clip, double time, double& result) {
        if (clip.getDuration() == 0.0) clip.computeDuration();
        const double whole = clip.*(&ClipTime::_originalDuration);
        double t = (time - clip.getStartTime()) * (whole / clip.getDuration());
        switch (clip.getPlayMode()) {
        case ONCE:
            if (t > whole) return false;
            break;
        case STAY:
            t = std::min(t, whole);
            break;
        case LOOP:
            if (whole == 0.0)
                t = clip.getStartTime();
            else if (t > whole)
                t = std::fmod(t, whole);
            break;
        case PPONG: {
            if (whole == 0.0) {
                t = clip.getStartTime();
                break;
            }
            const bool isBack = static_cast<int>(t / whole) % 2 != 0;
            t = std::fmod(t, whole);
            if (isBack) t = whole - t;
            break;
        }
        }
        result = t;
        return true;
    }
};

} // namespace

AutoPlayManager::AutoPlayManager() = default;
AutoPlayManager::~AutoPlayManager() = default;

// The base's copy constructor would copy every channel.
// NOLINTNEXTLINE(bugprone-copy-constructor-init)
AutoPlayManager::AutoPlayManager(const AutoPlayManager& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop),
      osgAnimation::BasicAnimationManager() { // NOLINT(readability-redundant-member-init)
    // A copy plays nothing yet, so it starts itself, too.
    _animations.reserve(other._animations.size());
    for (const osg::ref_ptr<osgAnimation::Animation>& clip : other._animations) {
        if (SharedClip::isPossible(*clip)) {
            _animations.push_back(SharedClip::copy(*clip));
            _sharing.insert(_animations.back());
        } else {
            _animations.push_back(osg::clone(clip.get(), copyop));
        }
    }
    _automaticLink = other._automaticLink;
    _needToLink = true;
}

/// The animations with channels of their own.
osgAnimation::AnimationList AutoPlayManager::ownClips() const {
    osgAnimation::AnimationList result;
    for (const osg::ref_ptr<osgAnimation::Animation>& clip : _animations)
        if (_sharing.count(clip) == 0) result.push_back(clip);
    return result;
}

/// Gives animations that play channels of their own, and links these.
void AutoPlayManager::ownPlayingClips() {
    if (_sharing.empty()) return;
    osgAnimation::AnimationList started;
    for (const auto& layer : _animationsPlaying)
        for (const osg::ref_ptr<osgAnimation::Animation>& clip : layer.second)
            if (_sharing.erase(clip) > 0) started.push_back(clip);
    for (const osg::ref_ptr<osgAnimation::Animation>& clip : started) ownChannels(*clip);
    if (!started.empty() && _linked.valid()) linkClips(*_linked, started);
}

void AutoPlayManager::registerAnimations(const osgAnimation::AnimationList& animations) {
    if (animations.empty()) return;
    _animations.insert(_animations.end(), animations.begin(), animations.end() - 1);
    registerAnimation(animations.back());
}

void AutoPlayManager::link(osg::Node* subgraph) {
    _skeleton = nullptr;
    _playsDirectly = false;
    if (_linker.valid()) { // the application's
        for (const osg::ref_ptr<osgAnimation::Animation>& clip : _animations)
            if (_sharing.erase(clip) > 0) ownChannels(*clip);
        osgAnimation::BasicAnimationManager::link(subgraph);
        return;
    }
    _linked = subgraph;
    _targets.clear();
    linkClips(*subgraph, ownClips());
    _needToLink = false;
}

void AutoPlayManager::linkClips(osg::Node& subgraph, const osgAnimation::AnimationList& clips) {
    const osg::ref_ptr<NameLinker> linker = new NameLinker(clips);
    subgraph.accept(*linker);
    _skeleton = linker->skeletons.size() == 1 ? linker->skeletons.front() : nullptr;
    for (const osg::ref_ptr<osgAnimation::Animation>& clip : clips)
        for (const osg::ref_ptr<osgAnimation::Channel>& channel : clip->getChannels())
            _targets.insert(channel->getTarget());
}

void AutoPlayManager::update(double time) {
    if (!std::isfinite(time)) return; // OSG would never recover
    if (!_started) {
        _started = true;
        const bool playing = std::any_of(_animationsPlaying.begin(), _animationsPlaying.end(),
                                         [](const auto& layer) { return !layer.second.empty(); });
        _lastUpdate = time;
        if (!playing && !_animations.empty()) playAnimation(_animations.front());
    }
    ownPlayingClips();
    // Unless it loops, OSG divides by the duration of a clip with a single key.
    for (const auto& layer : _animationsPlaying)
        for (const osg::ref_ptr<osgAnimation::Animation>& clip : layer.second)
            if (clip->getPlayMode() != osgAnimation::Animation::LOOP &&
                clip->getDuration() == 0.0 && clip->computeDurationFromChannels() == 0.0)
                clip->setPlayMode(osgAnimation::Animation::LOOP);
    _playsDirectly = playDirectly(time);
    if (!_playsDirectly) osgAnimation::BasicAnimationManager::update(time);
}

/// Plays the only playing clip through the skeleton's callback.
bool AutoPlayManager::playDirectly(double time) {
    if (!_skeleton) return false;
    osgAnimation::Animation* clip = nullptr;
    for (const auto& layer : _animationsPlaying)
        for (const osg::ref_ptr<osgAnimation::Animation>& playing : layer.second) {
            if (clip) return false;
            clip = playing.get();
        }
    double inClip = 0.0;
    // With less weight a channel does nothing.
    if (!clip || clip->getWeight() < 1e-4f || !ClipTime::find(*clip, time, inClip)) return false;
    if (!_playsDirectly) clearTargets(); // of clips that played before
    if (!_skeleton->play(*clip, inClip)) return false;
    _lastUpdate = time;
    return true;
}

} // namespace osgSkin
