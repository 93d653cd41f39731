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
    for (const osg::NodePath& way : scene.getParentalNodePaths())
        for (osg::Node* node : way) addClips(*node);
}

void RigCollector::apply(osg::Node& node) {
    addClips(node);
    traverse(node);
}

void RigCollector::apply(osg::Drawable& drawable) {
    auto* geometry = dynamic_cast<osgAnimation::RigGeometry*>(&drawable);
    if (geometry == nullptr) return;
    osg::NodePath way = getNodePath();
    if (!way.empty() && way.back() == geometry) way.pop_back();
    osgAnimation::Skeleton* skeleton = nullptr;
    auto below = way.end();
    while (below != way.begin() && skeleton == nullptr) {
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
    osg::NodePath nodes(below, way.end());
    if (std::find(rig.ways.begin(), rig.ways.end(), nodes) == rig.ways.end())
        rig.ways.push_back(nodes);
}

} // namespace osgSkin
