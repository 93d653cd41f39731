// SPDX-License-Identifier: MIT
#include "bones/BoneChannels.h"

#include "bones/HoldInCallback.h"

#include <osgSkin/Error>

namespace osgSkin {
namespace {

template <typename Made>
void make(const osgAnimation::UpdateBone& update, const osg::Object& element,
          osg::ref_ptr<Made>& channel, std::vector<osg::ref_ptr<osgAnimation::Channel>>& all) {
    channel = new Made;
    channel->setName(element.getName());
    channel->setTargetName(update.getName());
    all.emplace_back(channel);
}

template <typename Channel, typename Value>
void addKey(Channel& channel, double time, const Value& value) {
    auto* keys = channel.getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back({time, value});
}

} // namespace

BoneChannels::BoneChannels(osgAnimation::Bone& bone) : _bone(bone.getName()) {
    osgAnimation::UpdateBone* update = updateOf(bone);
    HoldingElements held;
    const bool found = update && !update->getName().empty() && held.find(*update) && !held.matrix;
    if (!found || held.translate->getName().empty() || held.rotate->getName().empty() ||
        (held.scale && held.scale->getName().empty()))
        throw Error("bone \"" + _bone +
                    "\" cannot be moved by channels, expected a named update callback with a named "
                    "translation and a named rotation, perhaps a scale, and nothing else");
    make(*update, *held.translate, _translate, _channels);
    make(*update, *held.rotate, _rotate, _channels);
    if (held.scale) make(*update, *held.scale, _scale, _channels);
}

void BoneChannels::add(double time, const osg::Matrixd& local) {
    osg::Vec3d translation, scale;
    osg::Quat rotation, scaleAxes;
    local.decompose(translation, rotation, scale, scaleAxes);
    if (!_scale && isScaled(scale))
        throw Error("bone \"" + _bone +
                    "\" is scaled against the bone above, expected an element for its scale");
    // q and -q are the same rotation; the nearer one makes the interpolation take the short arc.
    if (_last.asVec4() * rotation.asVec4() < 0.0) rotation = -rotation;
    _last = rotation;
    addKey(*_translate, time, osg::Vec3(translation));
    addKey(*_rotate, time, rotation);
    if (_scale) addKey(*_scale, time, osg::Vec3(scale));
}

} // namespace osgSkin
