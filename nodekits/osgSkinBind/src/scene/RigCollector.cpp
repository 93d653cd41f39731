// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/RigCollector.h"

#include <osgAnimation/AnimationManagerBase>

#include <algorithm>

namespace osgSkin {

void RigCollector::addClips(osg::Node& node) {
    for (osg::Callback* callback = node.getUpdateCallback(); callback != nullptr;
         callback = callback->getNestedCallback()) {
        const auto* manager = dynamic_cast<osgAnimation::AnimationManagerBase*>(callback);
        if (manager == nullptr) continue;
        for (const auto& clip : manager->getAnimationList())
            if (clip && std::find(clips.begin(), clips.end(), clip) == clips.end())
                clips.push_back(clip);
    }
}

void RigCollector::lookAbove(osg::Node& scene) {
    for (const osg::NodePath& path : scene.getParentalNodePaths())
        for (osg::Node* node : path) addClips(*node);
}

void RigCollector::apply(osg::Node& node) {
    addClips(node);
    traverse(node);
}

void RigCollector::apply(osg::Drawable& drawable) {
    auto* geometry = dynamic_cast<osgAnimation::RigGeometry*>(&drawable);
    if (geometry == nullptr) return;
    osg::NodePath path = getNodePath();
    if (!path.empty() && path.back() == geometry) path.pop_back();
    osgAnimation::Skeleton* skeleton = nullptr;
    auto below = path.end();
    while (below != path.begin() && skeleton == nullptr) {
        skeleton = dynamic_cast<osgAnimation::Skeleton*>(*(below - 1));
        if (skeleton == nullptr) --below;
    }
    const auto [entry, isNew] = _index.emplace(geometry, rigs.size());
    if (isNew) {
        rigs.push_back({});
        rigs.back().geometry = geometry;
        rigs.back().skeleton = skeleton;
    }
    Rig& rig = rigs[entry->second];
    rig.severalSkeletons = rig.severalSkeletons || rig.skeleton != skeleton;
    osg::NodePath nodes(below, path.end());
    if (std::find(rig.nodePaths.begin(), rig.nodePaths.end(), nodes) == rig.nodePaths.end())
        rig.nodePaths.push_back(nodes);
}

} // namespace osgSkin
