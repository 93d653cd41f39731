// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/BonesFirst.h"

#include <osg/NodeVisitor>
#include <osg/Transform>
#include <osgAnimation/Bone>

#include <algorithm>
#include <vector>

namespace osgSkin {
namespace {

bool isBone(const osg::ref_ptr<osg::Node>& node) {
    return dynamic_cast<osgAnimation::Bone*>(node.get()) != nullptr;
}

class Sorter : public osg::NodeVisitor {
public:
    Sorter() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Bone*>(&node) != nullptr) sort(node);
        traverse(node);
    }

private:
    static void sort(osg::Group& bone) {
        std::vector<osg::ref_ptr<osg::Node>> children;
        for (unsigned int c = 0; c < bone.getNumChildren(); ++c)
            children.emplace_back(bone.getChild(c));
        if (std::is_partitioned(children.begin(), children.end(), isBone)) return;
        std::stable_partition(children.begin(), children.end(), isBone);
        bone.removeChildren(0, bone.getNumChildren());
        for (const auto& child : children) bone.addChild(child);
    }
};

} // namespace

void putBonesFirst(osg::Node& scene) {
    Sorter sorter;
    scene.accept(sorter);
}

} // namespace osgSkin
