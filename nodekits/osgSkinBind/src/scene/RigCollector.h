// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RIGCOLLECTOR_H
#define OSGSKINBIND_RIGCOLLECTOR_H

#include <osg/NodeVisitor>
#include <osgAnimation/Animation>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>

#include <map>
#include <vector>

namespace osgSkin {

/// Finds a scene's rigs, with every node path from their skeleton to them.
class RigCollector : public osg::NodeVisitor {
public:
    RigCollector() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    struct Rig {
        osg::ref_ptr<osgAnimation::RigGeometry> geometry;
        /// Nodes from below the skeleton down to the rig's parent, one list for each parent.
        std::vector<osg::NodePath> nodePaths;
        osgAnimation::Skeleton* skeleton = nullptr;
        bool severalSkeletons = false;
    };
    /// In the order in which the scene holds them.
    std::vector<Rig> rigs;
    /// Of the animation managers met, and of those above the scene.
    osgAnimation::AnimationList clips;

    /// Collects the clips of what stands above `scene`.
    void lookAbove(osg::Node& scene);

    void apply(osg::Node& node) override;
    void apply(osg::Drawable& drawable) override;
    void apply(osg::Geometry& geometry) override { apply(static_cast<osg::Drawable&>(geometry)); }

private:
    void addClips(osg::Node& node);

    std::map<osgAnimation::RigGeometry*, std::size_t> _index;
};

} // namespace osgSkin

#endif
