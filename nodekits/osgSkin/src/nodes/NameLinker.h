// SPDX-License-Identifier: MIT
#pragma once

#include <osgAnimation/Animation>
#include <osgAnimation/LinkVisitor>

#include <string>
#include <unordered_map>
#include <vector>

namespace osgSkin {

/// Links bones and transforms with the channels of their name. OSG's own visitor compares the name
/// of each with that of every channel, and copies it: thousands of bones would take many seconds.
class NameLinker : public osgAnimation::LinkVisitor {
public:
    /// \param animations as OSG's managers have them, none of them null
    explicit NameLinker(const osgAnimation::AnimationList& animations);

    void apply(osg::Node& node) override;

private:
    std::unordered_map<std::string, std::vector<osgAnimation::Channel*>> m_channels;
};

} // namespace osgSkin
