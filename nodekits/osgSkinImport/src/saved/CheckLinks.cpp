// SPDX-License-Identifier: MIT
#include "saved/CheckLinks.h"

#include "text/FileText.h"

#include <osgAnimation/Animation>
#include <osgAnimation/AnimationUpdateCallback>

#include <map>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

using osgAnimation::AnimationUpdateCallbackBase;
using osgAnimation::Channel;

} // namespace

void checkLinks(const SavedStream::IdentifierMap& objects, const ReadLimits& limits,
                const std::string& path) {
    std::map<std::string, std::vector<AnimationUpdateCallbackBase*>> moved;
    const std::vector<AnimationUpdateCallbackBase*> nothing;
    for (const auto& [id, object] : objects)
        if (auto* callback = dynamic_cast<AnimationUpdateCallbackBase*>(object.get()))
            moved[callback->getName()].push_back(callback);
    std::size_t links = 0;
    for (const auto& [id, object] : objects) {
        const auto* animation = dynamic_cast<const osgAnimation::Animation*>(object.get());
        if (animation == nullptr) continue;
        std::size_t idle = 0;
        std::string first;
        for (const osg::ref_ptr<Channel>& channel : animation->getChannels()) {
            const auto found = moved.find(channel->getTargetName());
            const bool isThere = found != moved.end() && !found->first.empty(); // as OSG links
            bool moves = false;
            for (AnimationUpdateCallbackBase* callback : isThere ? found->second : nothing) {
                if (++links > limits.samples)
                    failFile(path, "channels move more things called alike than " +
                                       std::to_string(limits.samples) + " (option maxSamples)");
                const osg::ref_ptr<Channel> tried = channel->clone();
                moves = callback->link(tried.get()) || moves;
                if (tried->getTarget() == nullptr)
                    failFile(path, "animation " + inQuotes(animation->getName()) + ": channel " +
                                       inQuotes(channel->getName()) + " of " +
                                       inQuotes(channel->getTargetName()) +
                                       " is of another kind than what it moves");
            }
            if (!moves && idle++ == 0)
                first = inQuotes(channel->getName()) + " of " + inQuotes(channel->getTargetName());
        }
        if (idle > 0)
            tellOf(path, "animation " + inQuotes(animation->getName()) + ": " +
                             std::to_string(idle) + " of its " +
                             std::to_string(animation->getChannels().size()) +
                             " channels move nothing that is here, the first " + first);
    }
}

} // namespace osgSkin
