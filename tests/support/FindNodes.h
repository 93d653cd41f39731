// SPDX-License-Identifier: MIT
#pragma once

#include <osg/NodeVisitor>
#include <osg/Transform>

#include <vector>

namespace test {

template <typename T>
struct FoundNode {
    T* node;
    osg::Matrixd toWorld; ///< from its own space, its own transform included
};

/// All nodes and drawables of a type, including `root`, once per path to them, in traversal order.
template <typename T>
std::vector<FoundNode<T>> findNodes(osg::Node& root) {
    struct Visitor : osg::NodeVisitor {
        Visitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Node& node) override {
            if (auto* of = dynamic_cast<T*>(&node))
                found.push_back({of, osg::computeLocalToWorld(getNodePath())});
            traverse(node);
        }
        std::vector<FoundNode<T>> found;
    } visitor;
    root.accept(visitor);
    return visitor.found;
}

} // namespace test
