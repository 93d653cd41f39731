// SPDX-License-Identifier: MIT
#include <osgSkinMotion/Constraints>

#include "bones/BoneCallbacks.h"
#include "bones/Figure.h"

#include <osgSkin/Error>
#include <osgSkinMotion/RotateBone>

#include <osg/NodeVisitor>
#include <osg/observer_ptr>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace osgSkin {
namespace {

using osgAnimation::Bone;

constexpr double kTiny = 1e-12; ///< a distance without a direction
constexpr double kHuge = 1e12;  ///< a length whose square is far within range

bool isUsable(const glm::dquat& q) {
    return isFinite(q) && glm::length(q) > kTiny && glm::length(q) <= kHuge;
}

void check(Constraint& constraint) {
    bool isSound = isFinite(constraint.axis) && glm::length(constraint.axis) > kTiny &&
                   glm::length(constraint.axis) <= kHuge && constraint.weight >= 0.0 &&
                   constraint.weight <= 1.0;
    constraint.axis = glm::normalize(constraint.axis);
    for (Constraint::Joint* joint : {&constraint.joint, &constraint.source})
        for (glm::dquat* q : {&joint->rest, &joint->axes, &joint->above}) {
            isSound = isSound && isUsable(*q);
            *q = glm::normalize(*q);
        }
    if (!isSound)
        throw Error(
            "constraint of \"" + constraint.joint.name +
            "\": expected rotations and an axis with lengths above 1e-12 and up to 1e12, and "
            "a weight of 0 to 1");
}

/// From a joint's bind pose to its pose, in skeleton space.
glm::dquat turnOf(const Bone& bone) {
    return axesOf(osg::Matrixd(bone.getInvBindMatrixInSkeletonSpace()) *
                  bone.getMatrixInSkeletonSpace());
}

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// From a joint's parent's axes to skeleton space.
glm::dquat axesAbove(const Bone& bone, const Constraint::Joint& joint) {
    const Bone* const parent = bone.getBoneParent();
    if (!parent || endsWith(parent->getName(), kAboveRoot)) return joint.above;
    return turnOf(*parent) * joint.above;
}

/// The joint's rotation that a constraint wants, in its parent's axes.
/// \param above axesAbove() of the joint
glm::dquat wantedRotation(const Constraint& constraint, const Bone& bone, const Bone& source,
                          const glm::dquat& above) {
    const glm::dquat& rest = constraint.joint.rest;
    if (constraint.kind == Constraint::Kind::Aim) {
        const glm::dvec3 to = toGlm(source.getMatrixInSkeletonSpace().getTrans() -
                                    bone.getMatrixInSkeletonSpace().getTrans());
        if (!(glm::length(to) > kTiny)) return rest;
        const glm::dvec3 from = above * rest * constraint.axis;
        return glm::inverse(above) * shortestRotation(from, to) * above * rest;
    }
    const glm::dquat now = glm::inverse(axesAbove(source, constraint.source)) * turnOf(source) *
                           constraint.source.axes;
    const glm::dquat& before = constraint.source.rest;
    if (constraint.kind == Constraint::Kind::Rotation) return rest * glm::inverse(before) * now;
    // From the axes of the source's parent to those of the joint at rest.
    const glm::dquat turn = glm::inverse(rest) * now * glm::inverse(before) * rest;
    const glm::dvec3 turned = turn * constraint.axis;
    return rest * glm::inverse(shortestRotation(constraint.axis, turned)) * turn;
}

void apply(const Constraint& constraint, Bone& bone, const Bone& source) {
    const glm::dquat above = axesAbove(bone, constraint.joint);
    const glm::dquat wanted = glm::slerp(
        constraint.joint.rest, wantedRotation(constraint, bone, source, above), constraint.weight);
    const glm::dquat turn = above * wanted * glm::inverse(turnOf(bone) * constraint.joint.axes);
    if (isUsable(turn)) rotateBone(bone, toOsg(glm::normalize(turn)));
}

} // namespace

/// The constrained bones of one skeleton, in the order in which they are rotated. Does not keep
/// bones alive, which own it, nor the constraints.
class Constraints::Bones {
public:
    Bones(osgAnimation::Skeleton& skeleton, const std::vector<Constraint>& constraints)
        : _skeleton(&skeleton) {
        Places places;
        std::vector<Entry> entries;
        const osgAnimation::BoneMap bones = bonesOf(skeleton);
        for (const Constraint& constraint : constraints) {
            const auto bone = bones.find(constraint.joint.name);
            const auto source = bones.find(constraint.source.name);
            if (bone == bones.end() || source == bones.end()) continue;
            if (places.emplace(bone->second, entries.size()).second)
                entries.push_back({bone->second, source->second, &constraint});
        }
        for (const Entry& entry : entries) {
            _observed.emplace_back(entry.bone);
            if (places.count(entry.source) == 0) _observed.emplace_back(entry.source);
        }
        _entries.reserve(entries.size());
        std::vector<bool> isOpen(entries.size(), true);
        for (std::size_t i = 0; i < entries.size(); ++i) add(i, entries, places, isOpen);
    }

    /// Whether all bones are still there.
    bool fits(const osgAnimation::Skeleton& skeleton) const {
        return &skeleton == _skeleton && std::all_of(_observed.begin(), _observed.end(),
                                                     [](const auto& bone) { return bone.valid(); });
    }

    void apply() const {
        for (const Entry& entry : _entries)
            osgSkin::apply(*entry.constraint, *entry.bone, *entry.source);
    }

private:
    struct Entry {
        Bone *bone, *source; ///< valid if those in _observed are
        const Constraint* constraint;
    };
    using Places = std::unordered_map<const Bone*, std::size_t>;

    /// Adds what a constraint depends on, and then it. Chains may be long: no recursion.
    void add(std::size_t index, const std::vector<Entry>& entries, const Places& places,
             std::vector<bool>& isOpen) {
        std::vector<std::pair<std::size_t, bool>> stack{{index, false}}; // and whether it is next
        while (!stack.empty()) {
            const auto [top, isNext] = stack.back();
            stack.pop_back();
            const Entry& entry = entries[top];
            if (isNext) _entries.push_back(entry);
            if (isNext || !isOpen[top]) continue;
            isOpen[top] = false;
            stack.emplace_back(top, true);
            const auto addOf = [&](const Bone* bone) {
                if (const auto place = places.find(bone); place != places.end())
                    stack.emplace_back(place->second, false);
            };
            if (entry.constraint->kind == Constraint::Kind::Aim)
                for (const Bone* of : {entry.bone, entry.source})
                    for (const Bone* b = of->getBoneParent(); b; b = b->getBoneParent()) addOf(b);
            addOf(entry.source);
        }
    }

    const osgAnimation::Skeleton* _skeleton;
    std::vector<Entry> _entries;
    std::vector<osg::observer_ptr<Bone>> _observed; ///< all bones of the entries
};

std::vector<bool> inCircles(const std::vector<Constraint>& constraints) {
    std::unordered_map<std::string_view, std::size_t> places;
    for (std::size_t i = 0; i < constraints.size(); ++i)
        places.emplace(constraints[i].joint.name, i);
    std::vector<std::size_t> next; // the source's constraint
    for (const Constraint& constraint : constraints) {
        const auto found = places.find(constraint.source.name);
        next.push_back(found == places.end() ? constraints.size() : found->second);
    }
    std::vector<bool> result(constraints.size(), false);
    std::vector<std::size_t> walk(constraints.size(), 0); // the one that came by; from 1
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        std::size_t at = i;
        for (; at < next.size() && walk[at] == 0; at = next[at]) walk[at] = i + 1;
        if (at == next.size() || walk[at] != i + 1) continue;
        for (; !result[at]; at = next[at]) result[at] = true;
    }
    return result;
}

Constraints::Constraints() = default;

Constraints::Constraints(std::vector<Constraint> constraints) {
    set(std::move(constraints));
}

Constraints::Constraints(const Constraints& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), Attachment(other, copyop),
      _constraints(other._constraints) {}

Constraints::~Constraints() = default;

osg::ref_ptr<Constraints> Constraints::create(osg::Node& root,
                                              std::vector<Constraint> constraints) {
    const Figure figure = findFigure(root, "constraints");
    FigureJoints joints(figure);
    for (Constraint& constraint : constraints)
        for (Constraint::Joint* joint : {&constraint.joint, &constraint.source})
            joints.resolve(joint->name);
    try {
        return new Constraints(std::move(constraints));
    } catch (const Error& error) {
        figure.fail(error.what());
    }
}

osg::Node& Constraints::nodeFor(osg::Node& root) const {
    return topBoneOf(findFigure(root, "constraints"));
}

void Constraints::set(std::vector<Constraint> constraints) {
    for (Constraint& constraint : constraints) check(constraint);
    const std::vector<bool> isCircular = inCircles(constraints);
    for (std::size_t i = 0; i < constraints.size(); ++i)
        if (isCircular[i])
            throw Error('"' + constraints[i].joint.name + "\" follows \"" +
                        constraints[i].source.name + "\", which follows it: expected no circle");
    _constraints = std::move(constraints);
    _bones = nullptr;
}

void Constraints::apply(osgAnimation::Skeleton& skeleton) {
    if (!_bones || !_bones->fits(skeleton))
        _bones = std::make_shared<Bones>(skeleton, _constraints);
    _bones->apply();
}

void Constraints::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    traverse(node, nv);
    static thread_local osg::NodePath path; // keeps its memory
    if (osgAnimation::Skeleton* const skeleton = nv ? skeletonAbove(*nv, path) : nullptr)
        apply(*skeleton);
}

} // namespace osgSkin
