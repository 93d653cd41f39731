// SPDX-License-Identifier: MIT
#include "players/FigureClips.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/UpdateMorphs>

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Channel>

#include <algorithm>

namespace osgSkin {
namespace {

class Managers : public osg::NodeVisitor {
public:
    Managers() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        for (osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            if (auto* manager = dynamic_cast<osgAnimation::AnimationManagerBase*>(c))
                found.push_back({&node, manager});
        traverse(node);
    }

    std::vector<std::pair<osg::Node*, osg::ref_ptr<osgAnimation::AnimationManagerBase>>> found;
};

} // namespace

osgAnimation::AnimationList animationsOf(osg::Node& root) {
    Managers managers;
    root.accept(managers);
    osgAnimation::AnimationList result;
    for (const auto& [node, manager] : managers.found)
        result.insert(result.end(), manager->getAnimationList().begin(),
                      manager->getAnimationList().end());
    return result;
}

std::vector<osg::ref_ptr<osg::Callback>> takeManagers(osg::Node& root) {
    Managers managers;
    root.accept(managers);
    std::vector<osg::ref_ptr<osg::Callback>> result;
    for (const auto& [node, manager] : managers.found) {
        node->removeUpdateCallback(manager);
        if (std::find(result.begin(), result.end(), manager) == result.end())
            result.emplace_back(manager);
    }
    return result;
}

osg::ref_ptr<const SampledClip> sampleNamed(const std::string& name,
                                            const osgAnimation::AnimationList& animations,
                                            osgAnimation::Skeleton& skeleton,
                                            const std::string& label) {
    std::vector<std::string> known;
    for (const auto& animation : animations) {
        if (animation->getName() == name) return sampleOf(*animation, skeleton);
        known.push_back(animation->getName());
    }
    throw Error(label + "no animation \"" + name + '"' +
                (known.empty() ? std::string("; it has none") : expectedNames(name, known)));
}

osg::ref_ptr<const SampledClip> sampleOf(const osgAnimation::Animation& animation,
                                         osgAnimation::Skeleton& skeleton,
                                         double samplesPerSecond) {
    for (const auto& channel : animation.getChannels()) {
        if (channel->getTargetName() != UpdateMorphs::kName) continue;
        OSG_NOTICE << onOneLine("osgSkin: animation \"" + animation.getName() +
                                "\" moves morph targets, which players leave as they are")
                   << std::endl;
        break;
    }
    return SampledClip::create(animation, skeleton, samplesPerSecond);
}

} // namespace osgSkin
