// SPDX-License-Identifier: MIT
#include "players/ClipLayers.h"

#include "clips/BakedClip.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace osgSkin {
namespace {

/// The most loops of one step whose events are called.
constexpr double kMaxLoops = 1000.0;

double finite(double number) {
    return std::isfinite(number) ? number : 0.0;
}

double clampedWeight(double weight) {
    return std::clamp(finite(weight), 0.0, 1.0);
}

double eased(ClipPlayer::Easing easing, double share) {
    return easing == ClipPlayer::Easing::Smooth ? glm::smoothstep(0.0, 1.0, share) : share;
}

/// Without a loop.
double endOf(const SampledClip& clip) {
    return clip.step() * static_cast<double>(clip.sampleCount() - 1);
}

bool isNamed(const ClipPlayer::Layer& layer, const std::string& joint) {
    return layer.joints.empty() ||
           std::find(layer.joints.begin(), layer.joints.end(), joint) != layer.joints.end();
}

/// Whether a clip has all joints of another one, and more.
bool covers(const SampledClip& clip, const SampledClip& other) {
    return clip.joints().size() > other.joints().size() &&
           std::all_of(other.joints().begin(), other.joints().end(),
                       [&](const auto& joint) { return clip.find(joint.name) >= 0; });
}

/// Adds the change from one sample to another, in the space of the joint's parent.
void add(JointSample& below, const JointSample& from, const JointSample& to,
         const SampleBlend& weighted) {
    const JointSample part =
        weighted({}, {to.rotation * glm::conjugate(from.rotation),
                      to.translation - from.translation, to.scale / from.scale});
    below.rotation = part.rotation * below.rotation;
    below.translation += part.translation;
    below.scale *= part.scale;
}

} // namespace

const ClipLayers::Layer& ClipLayers::get(std::size_t index) const {
    static const Layer kNone;
    return index < _slots.size() ? _slots[index].layer : kNone;
}

void ClipLayers::set(std::size_t index, const Layer& layer) {
    if (index >= ClipPlayer::kMaxLayers) return;
    if (index >= _slots.size()) _slots.resize(index + 1);
    if (index == 1) _crosses = false;
    Slot& slot = _slots[index];
    const bool isOther = slot.layer.clip != layer.clip;
    const bool wasActive = slot.isActive();
    slot.starts = slot.starts || isOther || slot.layer.time != layer.time;
    assign(slot, layer);
    slot.jumps = slot.jumps || (isOther && (wasActive || slot.isActive()));
}

void ClipLayers::assign(Slot& slot, const Layer& layer) {
    _known = _known && slot.layer.clip == layer.clip && slot.layer.joints == layer.joints &&
             slot.layer.jointWeights == layer.jointWeights &&
             slot.layer.additive == layer.additive && slot.layer.reference == layer.reference;
    slot.layer = layer;
    slot.layer.time = finite(layer.time);
    slot.layer.speed = finite(layer.speed);
    slot.layer.weight = clampedWeight(layer.weight);
    slot.layer.reference = finite(layer.reference);
    slot.fadeSeconds = 0.0;
    slot.ends = false;
    slot.steps = nullptr;
    if (layer.inStep && layer.loop && layer.clip && layer.clip->footContacts().hasSteps())
        slot.steps = &layer.clip->footContacts();
}

/// Sets a layer so that twists continue.
void ClipLayers::replace(std::size_t index, const Layer& layer) {
    if (index >= _slots.size()) _slots.resize(index + 1);
    Slot& slot = _slots[index];
    assign(slot, layer);
    slot.posedTime = slot.layer.time;
    slot.starts = true;
}

void ClipLayers::seek(std::size_t index, double time) {
    if (index >= _slots.size()) return;
    _slots[index].starts = true;
    _slots[index].layer.time = finite(time);
}

void ClipLayers::setPhase(double phase) {
    for (std::size_t i = 0; i < _slots.size(); ++i) {
        const Layer& layer = _slots[i].layer;
        if (!layer.clip || !layer.loop) continue;
        const FootContacts& contacts = layer.clip->footContacts();
        seek(i, contacts.hasSteps() ? contacts.timeAt(phase) : phase * layer.clip->duration());
    }
}

void ClipLayers::setSpeed(std::size_t index, double speed) {
    if (index < _slots.size()) _slots[index].layer.speed = finite(speed);
}

void ClipLayers::fade(std::size_t index, double weight, double seconds, Easing easing) {
    if (index >= _slots.size() || !std::isfinite(weight)) return;
    if (index == 1) _crosses = false;
    startFade(_slots[index], weight, seconds, easing);
}

void ClipLayers::startFade(Slot& slot, double weight, double seconds, Easing easing) {
    slot.easing = easing;
    slot.fadeFrom = slot.layer.weight;
    slot.fadeTo = clampedWeight(weight);
    slot.fadeSeconds = seconds > 0.0 ? seconds : 0.0;
    slot.faded = 0.0;
    slot.ends = false;
    if (slot.fadeSeconds == 0.0) slot.layer.weight = slot.fadeTo;
}

void ClipLayers::play(const Layer& layer, double seconds, Easing easing, const JointSample* posed) {
    if (_slots.size() < 2) _slots.resize(2);
    const bool fades = _slots[0].layer.clip && seconds > 0.0;
    if (fades && playBack(layer, seconds, easing)) return;
    Layer next{layer.clip, layer.time, layer.speed, layer.loop, fades ? 0.0 : 1.0};
    next.inStep = layer.inStep;
    if (fades && _slots[1].isFull())
        moveDown();
    else if (fades && _slots[1].isActive())
        replace(0, Layer{frozen(posed)});
    replace(fades ? 1 : 0, next);
    if (fades)
        startFade(_slots[1], 1.0, seconds, easing);
    else
        replace(1, {});
    _crosses = fades;
}

/// Fades back to the clip from which a fade in step still goes on.
/// \return false where there is no such fade
bool ClipLayers::playBack(const Layer& layer, double seconds, Easing easing) {
    if (!_crosses || !layer.inStep || layer.clip != _slots[0].layer.clip || !_slots[0].steps ||
        !_slots[1].steps || !_slots[1].isActive())
        return false;
    const double weight = 1.0 - _slots[1].layer.weight;
    std::swap(_slots[0], _slots[1]);
    _slots[0].layer.weight = 1.0;
    _slots[0].fadeSeconds = 0.0;
    _slots[1].layer.weight = weight;
    _slots[1].layer.speed = finite(layer.speed);
    startFade(_slots[1], 1.0, seconds, easing);
    _known = false;
    return true;
}

/// Layer 1 becomes layer 0.
void ClipLayers::moveDown() {
    std::swap(_slots[0], _slots[1]);
    replace(1, {});
    _crosses = _known = false;
}

void ClipLayers::playOn(const Layer& layer, double seconds, Easing easing) {
    Layer next = layer;
    const Layer& present = get(ClipPlayer::kPartLayer);
    next.weight = present.clip ? present.weight : 0.0;
    const double weight = layer.weight;
    replace(ClipPlayer::kPartLayer, next);
    startFade(_slots[ClipPlayer::kPartLayer], weight, seconds, easing);
}

void ClipLayers::stopOn(double seconds, Easing easing) {
    if (!get(ClipPlayer::kPartLayer).clip) return;
    Slot& slot = _slots[ClipPlayer::kPartLayer];
    startFade(slot, 0.0, seconds, easing);
    slot.ends = true;
    if (slot.layer.weight == 0.0) replace(ClipPlayer::kPartLayer, {});
}

/// The present pose of layers 0 and 1 as a clip of one sample.
osg::ref_ptr<const SampledClip> ClipLayers::frozen(const JointSample* posed) {
    const SampledClip& base = *prepare();
    const osg::ref_ptr<SampledClip> result = new SampledClip;
    result->_name = base.name();
    result->_joints = base.joints();
    result->_root = base.rootJoint();
    sampleBelow(2, result->_samples, posed);
    return result;
}

void ClipLayers::addEvent(const SampledClip* clip, double time, const std::string& name,
                          const ClipPlayer::Event& event) {
    if (clip && std::isfinite(time))
        _events.push_back(std::make_shared<const Event>(Event{clip, time, name, event}));
}

void ClipLayers::onEvent(const std::string& name, const ClipPlayer::Event& event) {
    for (std::shared_ptr<const Event>& each : _events)
        if (each->name == name)
            each = std::make_shared<const Event>(Event{each->clip, each->time, name, event});
}

void ClipLayers::removeEvents(const SampledClip* clip) {
    _events.erase(std::remove_if(_events.begin(), _events.end(),
                                 [clip](const auto& event) { return event->clip == clip; }),
                  _events.end());
}

void ClipLayers::advance(double seconds) {
    advanceTimes(seconds);
    if (extracts() && prepare()) advanceRoot();
    for (std::size_t i = 0; i < _slots.size(); ++i) {
        Slot& slot = _slots[i];
        if (!slot.layer.clip) continue;
        const bool wasActive = slot.isActive();
        advanceFade(slot, std::abs(seconds));
        if (wasActive || slot.isActive()) findReached(i);
        if (slot.layer.time != slot.before) slot.starts = false;
        if (slot.ends && slot.layer.weight == 0.0) replace(i, {});
    }
    if (_crosses && _slots[1].fadeSeconds == 0.0) moveDown();
    std::sort(_reached.begin(), _reached.end(), [](const Reached& a, const Reached& b) {
        return std::tie(a.share, a.layer, a.order) < std::tie(b.share, b.layer, b.order);
    });
}

/// Layers in step get one phase, which advances at the mean of their rates; one that starts is put
/// to the phase of the layer that is seen most.
void ClipLayers::advanceTimes(double seconds) {
    const Slot* lead = nullptr;
    double rate = 0.0, seen = 0.0, most = 0.0, uncovered = 1.0;
    std::size_t count = 0;
    for (std::size_t i = _slots.size(); i-- > 0;) {
        Slot& slot = _slots[i];
        slot.before = slot.layer.time;
        const double share = slot.isActive() ? uncovered * slot.layer.weight : 0.0;
        if (slot.layer.joints.empty() && !slot.layer.additive) uncovered -= share;
        if (!slot.steps) {
            slot.layer.time = finite(slot.layer.time + slot.layer.speed * seconds);
            continue;
        }
        ++count;
        seen += share;
        rate += share * slot.layer.speed * slot.steps->rateAt(slot.before);
        if (share < most || share == 0.0) continue;
        most = share;
        lead = &slot;
    }
    const double phase = lead && count > 1 ? lead->steps->phaseAt(lead->before) : 0.0;
    for (Slot& slot : _slots) {
        if (!slot.steps) continue;
        if (!lead || count == 1) {
            slot.layer.time = finite(slot.layer.time + slot.layer.speed * seconds);
            continue;
        }
        const double own = slot.steps->phaseAt(slot.before);
        const double now = phase + std::round(own - phase); // in the loop in which it is
        if (&slot != lead && (slot.starts || !slot.isActive()))
            slot.before = slot.posedTime = slot.steps->timeAt(now);
        slot.layer.time = finite(slot.steps->timeAt(now + rate / seen * seconds));
    }
}

void ClipLayers::advanceFade(Slot& slot, double seconds) {
    Layer& layer = slot.layer;
    if (slot.fadeSeconds > 0.0) {
        slot.faded += seconds;
        const double share = std::min(1.0, slot.faded / slot.fadeSeconds);
        layer.weight = slot.fadeFrom + (slot.fadeTo - slot.fadeFrom) * eased(slot.easing, share);
        if (share == 1.0) {
            layer.weight = slot.fadeTo;
            slot.fadeSeconds = 0.0;
        }
    }
    if (layer.loop || !(layer.fadeOut >= 0.0) || layer.speed == 0.0 || slot.ends) return;
    const double way = layer.speed > 0.0 ? endOf(*layer.clip) - layer.time : layer.time;
    const double left = way / std::abs(layer.speed);
    if (left > layer.fadeOut) return;
    startFade(slot, 0.0, left, slot.easing);
    slot.ends = true;
}

/// Finds the events of a layer in the step of advance().
void ClipLayers::findReached(std::size_t index) {
    const Slot& slot = _slots[index];
    const Layer& layer = slot.layer;
    if (layer.time == slot.before) return;
    for (std::size_t e = 0; e < _events.size(); ++e) {
        const std::shared_ptr<const Event>& event = _events[e];
        if (event->clip != layer.clip) continue;
        // Loops of the clip from the event to the step's ends, counted in the step's direction.
        // Both ends of neighbouring steps are computed alike, so that no event is lost to rounding.
        const double time =
            layer.loop ? event->time : std::clamp(event->time, 0.0, endOf(*layer.clip));
        const double length = layer.clip->duration() * (layer.time > slot.before ? 1.0 : -1.0);
        const double from = (slot.before - time) / length, to = (layer.time - time) / length;
        double first = slot.starts ? std::ceil(from) : std::floor(from) + 1.0;
        double last = std::floor(to);
        if (!layer.loop) {
            first = std::max(first, 0.0);
            last = std::min(last, 0.0);
        }
        const double count = std::min(last - first + 1.0, kMaxLoops);
        for (double i = 1.0; i <= count; ++i)
            _reached.push_back({(last - count + i - from) / (to - from), index, e, event});
    }
}

void ClipLayers::callEvents(ClipPlayer& player) {
    std::vector<Reached> reached;
    reached.swap(_reached); // a callback may advance the player
    for (const Reached& each : reached)
        if (each.event->call) each.event->call(player, each.layer);
    reached.clear();
    _reached.swap(reached);
}

/// The topmost of the first layers that hides all below it; 0 where none does.
std::size_t ClipLayers::firstSeen(std::size_t end) const {
    std::size_t first = 0;
    for (std::size_t i = 0; i < std::min(end, _slots.size()); ++i)
        if (_slots[i].isFull()) first = i;
    return first;
}

const SampledClip* ClipLayers::prepare() {
    const std::size_t first = firstSeen(_slots.size());
    bool isSame = _known && first == _first;
    for (Slot& slot : _slots) {
        isSame = isSame && slot.wasActive == slot.isActive();
        slot.wasActive = slot.isActive();
    }
    if (isSame) return _base;
    const SampledClip* base = nullptr;
    for (std::size_t i = first; i < _slots.size(); ++i) {
        const SampledClip* clip = _slots[i].isActive() ? _slots[i].layer.clip.get() : nullptr;
        if (clip && (!base || covers(*clip, *base))) base = clip;
    }
    for (std::size_t i = 0; i < _slots.size() && !base; ++i) base = _slots[i].layer.clip.get();
    const bool matches = !_known || base != _base;
    _known = true;
    _first = first;
    _base = base;
    if (matches)
        for (Slot& slot : _slots) matchJoints(slot);
    return _base;
}

void ClipLayers::matchJoints(Slot& slot) const {
    slot.joints.clear();
    slot.reference.clear();
    const Layer& layer = slot.layer;
    if (!layer.clip) return;
    const SampledClip& clip = *layer.clip;
    slot.movesRoot = isNamed(layer, clip.joints()[clip.rootJoint()].name);
    const SampledClip::Interval at = clip.intervalAt(layer.reference, false);
    for (std::size_t j = 0; j < _base->joints().size(); ++j) {
        const std::string& name = _base->joints()[j].name;
        const int own = &clip == _base ? static_cast<int>(j) : clip.find(name);
        if (!isNamed(layer, name)) continue;
        // A clip that moves the whole figure has the joints that it lacks at rest.
        if (own < 0 && (layer.additive || !layer.joints.empty())) continue;
        const auto named = std::find(layer.joints.begin(), layer.joints.end(), name);
        const auto place = static_cast<std::size_t>(named - layer.joints.begin());
        slot.joints.push_back(
            {j, own,
             place < layer.jointWeights.size() ? clampedWeight(layer.jointWeights[place]) : 1.0});
        if (!layer.additive) continue;
        const auto k = static_cast<std::size_t>(own);
        slot.reference.push_back(
            osgSkin::blend(clip.sample(at.from)[k], clip.sample(at.to)[k], at.share));
    }
}

/// Blends a layer over the joints below.
void ClipLayers::blend(const Slot& slot, const JointSample* posed,
                       std::vector<JointSample>& joints) const {
    const Layer& layer = slot.layer;
    const SampledClip& clip = *layer.clip;
    SampledClip::Interval at = clip.intervalAt(layer.time, layer.loop);
    if (!_interpolated || posed) at.share = 0.0;
    const JointSample* from = posed ? posed : clip.sample(at.from);
    const JointSample* next = posed ? posed : clip.sample(at.to);
    const SampleBlend between(at.share), whole(layer.weight);
    SampleBlend partial = whole;
    const int root = _root == Root::Moving ? -2 : static_cast<int>(clip.rootJoint());
    for (std::size_t k = 0; k < slot.joints.size(); ++k) {
        const Match& match = slot.joints[k];
        JointSample own;
        if (match.own >= 0) own = between(from[match.own], next[match.own]);
        if (match.own == root) keepInPlace(clip, own);
        JointSample& below = joints[match.joint];
        if (match.share < 1.0) partial = SampleBlend(layer.weight * match.share);
        const SampleBlend& weighted = match.share < 1.0 ? partial : whole;
        if (layer.additive) {
            JointSample reference = slot.reference[k];
            if (match.own == root) keepInPlace(clip, reference);
            add(below, reference, own, weighted);
        } else {
            below = weighted(below, own);
        }
    }
}

/// Blends the first layers.
void ClipLayers::sampleBelow(std::size_t end, std::vector<JointSample>& joints,
                             const JointSample* posed) const {
    const std::size_t first = firstSeen(end);
    joints.resize(_base->joints().size());
    if (!_slots[first].isFull()) std::fill(joints.begin(), joints.end(), JointSample());
    for (std::size_t i = first; i < std::min(end, _slots.size()); ++i)
        if (_slots[i].isActive()) blend(_slots[i], i == 0 ? posed : nullptr, joints);
}

const ClipLayers::Layer* ClipLayers::alone() const {
    if (!_slots[_first].isFull()) return nullptr;
    for (std::size_t i = _first + 1; i < _slots.size(); ++i)
        if (_slots[i].isActive()) return nullptr;
    return &_slots[_first].layer;
}

bool ClipLayers::isContinued() const {
    return std::all_of(_slots.begin(), _slots.end(), [](const Slot& slot) {
        return !slot.jumps && (!slot.isActive() || std::abs(slot.layer.time - slot.posedTime) <=
                                                       ClipPlayer::kSeekSeconds);
    });
}

void ClipLayers::markPosed() {
    for (Slot& slot : _slots) {
        slot.jumps = false;
        slot.posedTime = slot.layer.time;
    }
}

} // namespace osgSkin
