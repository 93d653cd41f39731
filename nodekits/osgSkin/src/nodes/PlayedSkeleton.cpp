// SPDX-License-Identifier: MIT
#include "nodes/PlayedSkeleton.h"

#include <osgSkin/GlmOsg>

#include <osg/NodeVisitor>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>

#include <algorithm>
#include <typeinfo>

namespace osgSkin {
namespace {

using osgAnimation::Bone;
using osgAnimation::Skeleton;
using osgAnimation::StackedMatrixElement;
using osgAnimation::StackedQuaternionElement;
using osgAnimation::StackedScaleElement;
using osgAnimation::StackedTranslateElement;

/// Searches for OSG's rigs, which read bones.
class FindRigs : public osg::NodeVisitor {
public:
    FindRigs() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Drawable& drawable) override {
        if (dynamic_cast<osgAnimation::RigGeometry*>(&drawable)) found = true;
    }
    bool found = false;
};

unsigned int updatedChildrenOf(const osg::Node& node) {
    const osg::Group* group = node.asGroup();
    return group ? group->getNumChildrenRequiringUpdateTraversal() : 0;
}

} // namespace

PlayedElement::PlayedElement(osgAnimation::StackedTransformElement* of) : element(of) {
    if (dynamic_cast<StackedTranslateElement*>(of))
        kind = kTranslate;
    else if (dynamic_cast<StackedQuaternionElement*>(of))
        kind = kRotate;
    else if (dynamic_cast<StackedScaleElement*>(of))
        kind = kScale;
    else if (auto* matrix = dynamic_cast<StackedMatrixElement*>(of))
        kind = !matrix->getTarget() && isAffine(matrix->getMatrix()) ? kMatrix : kUnknown;
    target = of ? of->getTarget() : nullptr;
}

void UpdatePlayedSkeleton::Playing::findBones(osg::Group& parent, int parentBone) {
    for (unsigned int i = 0; i < parent.getNumChildren(); ++i) {
        auto* bone = dynamic_cast<Bone*>(parent.getChild(i));
        if (!bone) continue;
        PlayedBone found{};
        found.bone = bone;
        found.parent = parentBone;
        found.callback = bone->getUpdateCallback();
        found.nested = found.callback ? found.callback->getNestedCallback() : nullptr;
        found.updatedChildren = bone->getNumChildrenRequiringUpdateTraversal();
        found.inverseBind = toGlm(bone->getInvBindMatrixInSkeletonSpace());
        found.firstChild = children.size();
        found.childCount = bone->getNumChildren();
        found.firstElement = elements.size();
        auto* update = dynamic_cast<osgAnimation::UpdateBone*>(found.callback);
        if (update && typeid(*update) == typeid(osgAnimation::UpdateBone) && !found.nested)
            found.update = update;
        if (found.update)
            for (const auto& element : found.update->getStackedTransforms())
                elements.emplace_back(element.get());
        found.elementCount = elements.size() - found.firstElement;
        isPlain = isPlain && found.update && bone->getNumParents() == 1 &&
                  bone->getReferenceFrame() == osg::Transform::RELATIVE_RF &&
                  isAffine(bone->getInvBindMatrixInSkeletonSpace()) &&
                  std::all_of(elements.begin() + static_cast<std::ptrdiff_t>(found.firstElement),
                              elements.end(), [](const PlayedElement& e) {
                                  return e.kind != PlayedElement::kUnknown;
                              });
        const int index = static_cast<int>(bones.size());
        unsigned int updatedBones = 0;
        for (unsigned int c = 0; c < bone->getNumChildren(); ++c) {
            osg::Node* const child = bone->getChild(c);
            children.push_back(child);
            if (isBone(*child)) {
                if (child->getUpdateCallback() || updatedChildrenOf(*child) > 0) ++updatedBones;
                continue;
            }
            auto* part = dynamic_cast<RigidPart*>(child);
            if (part && part->getNumParents() == 1 &&
                part->getReferenceFrame() == osg::Transform::RELATIVE_RF)
                parts.push_back({part, bones.size(), {}});
            else
                isPlain = false;
        }
        isPlain = isPlain && found.updatedChildren == updatedBones;
        bones.push_back(found);
        findBones(*bone, index);
    }
}

void UpdatePlayedSkeleton::Playing::find(Skeleton& from) {
    // A callback on two living skeletons cannot keep the state of both.
    if (skeleton.valid() && skeleton.get() != &from) {
        for (osg::Callback* c = skeleton->getUpdateCallback(); c; c = c->getNestedCallback())
            for (osg::Callback* own = from.getUpdateCallback(); own; own = own->getNestedCallback())
                isShared = isShared || (c == own && dynamic_cast<UpdatePlayedSkeleton*>(c));
    }
    skeleton = &from;
    top.clear();
    bones.clear();
    children.clear();
    elements.clear();
    parts.clear();
    isPlain = true;
    findBones(from, -1);
    FindRigs rigs;
    for (unsigned int i = 0; i < from.getNumChildren(); ++i) {
        osg::Node& child = *from.getChild(i);
        top.push_back({&child, updatedChildrenOf(child)});
        if (!isBone(child)) child.accept(rigs);
    }
    isPlain = isPlain && !rigs.found && !bones.empty();
    inSkeleton.resize(bones.size());
    skinning.resize(bones.size());
}

bool UpdatePlayedSkeleton::Playing::isSame(const Skeleton& now) {
    if (skeleton.get() != &now || now.getNumChildren() != top.size()) return false;
    for (std::size_t i = 0; i < top.size(); ++i) {
        const osg::Node* child = now.getChild(static_cast<unsigned int>(i));
        if (child != top[i].node || updatedChildrenOf(*child) != top[i].updatedChildren)
            return false;
    }
    isDrawnPlain = true;
    // Parents come first, so that no pointer is followed whose owner has dropped it.
    for (const PlayedBone& was : bones) {
        const Bone& bone = *was.bone;
        if (bone.getUpdateCallback() != was.callback || bone.getNumChildren() != was.childCount ||
            bone.getNumChildrenRequiringUpdateTraversal() != was.updatedChildren)
            return false;
        for (std::size_t c = 0; c < was.childCount; ++c)
            if (bone.getChild(static_cast<unsigned int>(c)) != children[was.firstChild + c])
                return false;
        if (was.callback && was.callback->getNestedCallback() != was.nested) return false;
        isDrawnPlain = isDrawnPlain && !bone.getStateSet() && !bone.getCullCallback() &&
                       bone.getNodeMask() == ~0u;
        if (!was.update) continue;
        const osgAnimation::StackedTransform& stack = was.update->getStackedTransforms();
        if (stack.size() != was.elementCount) return false;
        for (std::size_t e = 0; e < was.elementCount; ++e)
            if (stack[e].get() != elements[was.firstElement + e].element) return false;
    }
    return true;
}

} // namespace osgSkin
