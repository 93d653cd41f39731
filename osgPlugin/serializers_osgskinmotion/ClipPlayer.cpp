// SPDX-License-Identifier: MIT
#include "AttachmentFile.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "players/ClipLayers.h"

#include <osgSkinMotion/ClipPlayer>

#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgSkinMotion {
using osgSkin::ClipPlayer; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace osgSkin {
namespace {

using ClipRef = osg::ref_ptr<const SampledClip>;

/// Joints, times, rotations of all samples, and what moves or scales. All numbers are doubles.
template <typename Archive>
void passClip(Archive& archive, ClipRef& clip) {
    std::string name;
    double step = 0.0;
    std::vector<SampledClip::Joint> joints;
    std::vector<JointSample> samples;
    if constexpr (!Archive::kReads) {
        name = clip->name();
        step = clip->step();
        joints = clip->joints();
        samples.assign(clip->sample(0), clip->sample(0) + clip->sampleCount() * joints.size());
    }
    archive(name, step);
    archive.list(joints, "joints", 8, [&](SampledClip::Joint& joint) {
        archive(joint.name, joint.parent, joint.centre);
    });
    archive.list(samples, "samples", 8, [&](JointSample& sample) { archive(sample.rotation); });
    if (joints.empty() || samples.size() % joints.size() != 0)
        archive.fail("a clip has no whole number of samples");
    std::vector<std::uint32_t> moving; // joints
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto joint = static_cast<std::uint32_t>(i % joints.size());
        if (samples[i].scale == 1.0 && samples[i].translation == glm::dvec3(0.0)) continue;
        if (std::find(moving.begin(), moving.end(), joint) == moving.end()) moving.push_back(joint);
    }
    archive.list(moving, "moving joints", 1, [&](std::uint32_t& joint) {
        archive(joint);
        if (joint >= joints.size()) archive.fail("it moves a joint that is not there");
        for (std::size_t i = joint; i < samples.size(); i += joints.size())
            archive(samples[i].translation, samples[i].scale);
    });
    if constexpr (Archive::kReads) clip = SampledClip::create(name, joints, samples, step);
}

/// All of a layer but its clip.
template <typename Archive>
void passLayer(Archive& archive, ClipPlayer::Layer& layer) {
    archive(layer.time, layer.speed, layer.loop, layer.weight, layer.additive, layer.reference,
            layer.fadeOut, layer.inStep);
    archive.list(layer.joints, "joints of a layer", 1, [&](std::string& name) { archive(name); });
    archive.list(layer.jointWeights, "weights of a layer's joints", 2,
                 [&](double& weight) { archive(weight); });
}

template <typename Archive, typename Slot>
void passFade(Archive& archive, Slot& slot) {
    archive.choice(slot.easing, 2, "a fade");
    archive(slot.fadeFrom, slot.fadeTo, slot.fadeSeconds, slot.faded, slot.ends, slot.starts);
    for (const double number : {slot.fadeFrom, slot.fadeTo, slot.fadeSeconds, slot.faded})
        if (!(number >= 0.0)) archive.fail("a fade has a number that is negative or none");
}

} // namespace

/// The clips of layers and events, which name them by numbers from 1 on; the layers with their
/// fades; how the root moves; the events.
template <typename Archive>
void AttachmentFile::pass(Archive& archive, ClipPlayer& player) {
    ClipLayers& layers = *player._layers;
    archive(player._isAttached, player._toWorld);
    if (!player._isAttached) {
        if constexpr (!Archive::kReads)
            OSG_NOTICE << "osgSkin: a ClipPlayer of skins without bones is not saved" << std::endl;
        return;
    }
    std::vector<ClipRef> clips;
    const auto passNumber = [&](ClipRef& clip) {
        const auto known = std::find(clips.begin(), clips.end(), clip);
        std::size_t number = clip ? std::size_t(known - clips.begin()) + 1 : 0;
        archive(number);
        if (number > clips.size()) archive.fail("it has no clip of this number");
        if constexpr (Archive::kReads) clip = number == 0 ? nullptr : clips[number - 1];
    };
    struct Event {
        ClipRef clip;
        double time = 0.0;
        std::string name;
    };
    std::vector<Event> events;
    if constexpr (!Archive::kReads) {
        bool hasFunctions = false;
        for (const auto& event : layers._events) {
            events.push_back({event->clip, event->time, event->name});
            hasFunctions = hasFunctions || event->call;
        }
        if (hasFunctions)
            OSG_NOTICE << "osgSkin: a ClipPlayer's functions are not saved; set them by onEvent()"
                       << std::endl;
        const auto add = [&](const ClipRef& clip) {
            if (clip && std::find(clips.begin(), clips.end(), clip) == clips.end())
                clips.push_back(clip);
        };
        for (const ClipLayers::Slot& slot : layers._slots) add(slot.layer.clip);
        for (const Event& event : events) add(event.clip);
    }
    archive.list(clips, "clips", 14, [&](ClipRef& clip) { passClip(archive, clip); });
    std::size_t index = 0;
    archive.list(layers._slots, "layers", 28, [&](ClipLayers::Slot& slot) {
        ClipPlayer::Layer layer = slot.layer;
        passNumber(layer.clip);
        passLayer(archive, layer);
        if constexpr (Archive::kReads) player.setLayer(index++, layer); // checks the numbers
        passFade(archive, slot);
    });
    if (layers._slots.size() > ClipPlayer::kMaxLayers) archive.fail("it has too many layers");
    archive(layers._crosses, layers._interpolated);
    archive.choice(layers._root, 5, "the root's movement");
    archive(layers._up, layers._motion.angle, layers._motion.shift);
    if (layers._crosses && layers._slots.size() < 2) archive.fail("it has no layers to fade");
    archive.list(events, "events", 4, [&](Event& event) {
        passNumber(event.clip);
        archive(event.time, event.name);
        if constexpr (Archive::kReads) player.addEvent(event.clip, event.time, event.name);
    });
}

} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_ClipPlayer, new osgSkin::ClipPlayer,
                         osgSkinMotion::ClipPlayer,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::ClipPlayer") {
    addFileVersion(*wrapper);
    addBlock<osgSkin::ClipPlayer, osgSkin::AttachmentFile>(*wrapper, "Layers", "clip player");
}
