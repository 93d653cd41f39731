// SPDX-License-Identifier: MIT
#include <osgSkinMotion/Attach>

#include "bones/Figure.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkinRig/FindJoint>
#include <osgSkinRig/ReadSkeleton>

#include <osg/NodeVisitor>
#include <osgAnimation/Bone>

#include <typeinfo>

namespace osgSkin {
namespace {

/// An attachment and the node whose callback it is.
struct Attached {
    osg::ref_ptr<osg::Node> node;
    osg::ref_ptr<Attachment> attachment;
};

class AttachedBelow : public osg::NodeVisitor {
public:
    AttachedBelow() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        for (osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            if (auto* attachment = dynamic_cast<Attachment*>(c))
                found.push_back({&node, attachment});
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node)) {
            for (unsigned int i = 0; i < bone->getNumChildren(); ++i)
                if (dynamic_cast<osgAnimation::Bone*>(bone->getChild(i)))
                    bone->getChild(i)->accept(*this);
        } else {
            traverse(node);
        }
    }

    std::vector<Attached> found;
};

std::vector<Attached> attachedBelow(const osg::Node& root) {
    AttachedBelow visitor;
    const_cast<osg::Node&>(root).accept(visitor);
    return visitor.found;
}

/// The paths to the topmost skeletons.
class Skeletons : public osg::NodeVisitor {
public:
    Skeletons() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Skeleton*>(&node))
            paths.push_back(getNodePath());
        else
            traverse(node);
    }

    std::vector<osg::NodePath> paths;
};

} // namespace

void Figure::fail(const std::string& what) const {
    throw Error(label + what);
}

Figure findFigure(osg::Node& root, const std::string& what) {
    Figure result;
    result.label = what + ": \"" + root.getName() + "\": ";
    Skeletons skeletons;
    root.accept(skeletons);
    if (skeletons.paths.empty()) result.fail("expected a skeleton with bones below it");
    if (skeletons.paths.size() > 1)
        result.fail(std::to_string(skeletons.paths.size()) +
                    " skeletons are below it, expected the root of one figure");
    const osg::NodePath& path = skeletons.paths.front();
    result.skeleton = static_cast<osgAnimation::Skeleton*>(path.back());
    result.toWorld = osg::computeLocalToWorld(path);
    return result;
}

FigureJoints::FigureJoints(const Figure& figure)
    : _figure(figure), _bones(bonesOf(*figure.skeleton)) {}

void FigureJoints::resolve(std::string& name) {
    if (_bones.count(name) != 0) return;
    try {
        if (_rest.joints.empty()) {
            _rest = readSkeleton(*_figure.skeleton);
            _roles = recogniseJoints(_rest);
        }
        name = _rest.joints[findJoint(_rest, name, _roles)].name;
    } catch (const Error& error) {
        _figure.fail(error.what());
    }
}

osgAnimation::Skeleton* skeletonBelow(osg::Node& root) {
    Skeletons skeletons;
    root.accept(skeletons);
    return skeletons.paths.empty()
               ? nullptr
               : static_cast<osgAnimation::Skeleton*>(skeletons.paths.front().back());
}

osgAnimation::Bone& topBoneOf(const Figure& figure) {
    osgAnimation::Bone* last = nullptr;
    for (const auto& [name, bone] : bonesOf(*figure.skeleton)) {
        if (bone->getBoneParent()) continue;
        if (!last || figure.skeleton->getChildIndex(bone) > figure.skeleton->getChildIndex(last))
            last = bone;
    }
    if (!last) figure.fail("its skeleton has no bone");
    return *last;
}

Attachment::Attachment(const Attachment& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop) {}

bool Attachment::replaces(const Attachment& other) const {
    return typeid(other) == typeid(*this);
}

void attach(osg::Node& root, Attachment& attachment) {
    const osg::ref_ptr<Attachment> keep = &attachment; // it may be attached already
    osg::Node& node = attachment.nodeFor(root);
    for (const osg::ref_ptr<Attachment>& other : attachmentsOf(root))
        if (attachment.replaces(*other)) detach(root, *other);
    // A node's first callback is the last to act, because each calls the next one before.
    osg::Callback* before = nullptr;
    osg::Callback* next = node.getUpdateCallback();
    for (auto* later = dynamic_cast<Attachment*>(next);
         later && later->order() > attachment.order(); later = dynamic_cast<Attachment*>(next)) {
        before = next;
        next = next->getNestedCallback();
    }
    attachment.setNestedCallback(next);
    if (before)
        before->setNestedCallback(&attachment);
    else
        node.setUpdateCallback(&attachment);
    attachment.onAttach(root);
}

bool detach(osg::Node& root, Attachment& attachment) {
    const osg::ref_ptr<Attachment> keep = &attachment;
    for (const Attached& each : attachedBelow(root)) {
        if (each.attachment != &attachment) continue;
        each.node->removeUpdateCallback(&attachment);
        attachment.onDetach(*each.node);
        return true;
    }
    return false;
}

std::vector<osg::ref_ptr<Attachment>> attachmentsOf(const osg::Node& root) {
    std::vector<osg::ref_ptr<Attachment>> result;
    for (const Attached& each : attachedBelow(root)) result.push_back(each.attachment);
    return result;
}

osg::Matrixd toWorld(osg::Node& root) {
    return findFigure(root, "toWorld").toWorld;
}

} // namespace osgSkin
