// SPDX-License-Identifier: MIT
#include "nodes/NameLinker.h"

#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Skeleton>
#include <osgAnimation/UpdateBone>

#include <algorithm>
#include <typeinfo>

namespace osgSkin {

namespace {

/// A callback that links what has its name and nothing else; those that others derive from it may
/// do otherwise, as OSG's for morph targets does.
osgAnimation::UpdateMatrixTransform* linkedByName(osg::Callback& callback) {
    const std::type_info& type = typeid(callback);
    const bool plain = type == typeid(osgAnimation::UpdateBone) ||
                       type == typeid(osgAnimation::UpdateMatrixTransform);
    return plain && !callback.getName().empty()
               ? dynamic_cast<osgAnimation::UpdateMatrixTransform*>(&callback)
               : nullptr;
}

/// Another character, as a rider, is moved by its own manager. A channel moves one target alone: it
/// would leave this character's bone for the one of the same name below it.
bool isAnotherCharacter(osg::Node& node, const osg::NodePath& path) {
    osg::Callback* callback = node.getUpdateCallback();
    while (callback && !dynamic_cast<osgAnimation::AnimationManagerBase*>(callback))
        callback = callback->getNestedCallback();
    return callback && std::any_of(path.begin(), path.end(), [&node](const osg::Node* above) {
               return above != &node && dynamic_cast<const osgAnimation::Skeleton*>(above);
           });
}

} // namespace

NameLinker::NameLinker(const osgAnimation::AnimationList& animations) {
    _animations = animations;
    for (const auto& animation : animations)
        for (const auto& channel : animation->getChannels())
            m_channels[channel->getTargetName()].push_back(channel.get());
}

void NameLinker::apply(osg::Node& node) {
    if (isAnotherCharacter(node, getNodePath())) return;
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

} // namespace osgSkin
