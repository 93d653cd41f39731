// SPDX-License-Identifier: MIT
#include "deform/KernelChain.h"

#include "model/SkinModelAccess.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

void write(const glm::dmat3& turn, const glm::dvec3& move, KernelMap& map) noexcept {
    float rounded[4][3]; // columns; all at once, which takes a few instructions
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            rounded[column][row] = Splat::rounded(turn[column][row]);
        rounded[3][row] = Splat::rounded(move[row]);
    }
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) map.turn[row][column].set(rounded[column][row]);
        map.move[row].set(rounded[3][row]);
    }
}

/// An angle, or 0 where it is a rounding error: its powers would be denormal numbers.
double flushTiny(double angle) noexcept {
    return std::abs(angle) < 1e-9 ? 0.0 : angle;
}

} // namespace

std::size_t KernelChain::sharedLinks(const SkinModel::Group& group) const noexcept {
    if (!_last) return 0;
    const SkinModel::Link* a = _model.links().data() + _last->firstLink;
    const SkinModel::Link* b = _model.links().data() + group.firstLink;
    const std::size_t most = std::min<std::size_t>({_last->linkCount, group.linkCount, kKept});
    std::size_t shared = 0;
    while (shared < most && a[shared].joint == b[shared].joint &&
           a[shared].partial == b[shared].partial)
        ++shared;
    return shared;
}

KernelChain::KernelChain(const SkinModel& model, const Pose& pose) noexcept
    : _model(model), _pose(pose) {
    State& none = _states.front();
    none.own = {glm::dmat3(1.0), glm::dvec3(0.0), 1.0};
    none.map = &none.own;
    none.partialCount = 0;
}

void KernelChain::workOut(std::uint32_t index, Joint& joint) const noexcept {
    const JointTransform turn = _pose.transform(index);
    const BoundJoint& rest = _model.joints()[index];
    joint.full = {glm::mat3_cast(turn.rotation), turn.offset, turn.scale};
    const glm::dvec3& v = turn.split.bendAxis;
    joint.frame = glm::dmat3(v, glm::cross(rest.twistAxis, v), rest.twistAxis);
    joint.intoFrame = {glm::transpose(joint.frame), -(rest.centre * joint.frame), 1.0};
    joint.bend = flushTiny(turn.split.bendAngle);
    joint.twist = flushTiny(turn.split.twistAngle);
    const SkinBlocks& blocks = SkinModelAccess::blocks(_model);
    const glm::dmat3& fixed = blocks.jointFrames[index];
    joint.azimuthCosine = glm::dot(v, fixed[0]);
    joint.azimuthSine = glm::dot(v, fixed[1]);
    const glm::dvec3 move = turn.translation * joint.frame; // transposed: into the frame
    for (int axis = 0; axis < 3; ++axis) joint.move[axis] = move[axis];
    joint.growth = turn.scale - 1.0;
    joint.adjusted =
        glm::dot(move, move) > blocks.smallMove * blocks.smallMove || turn.scale != 1.0;
}

const KernelChain::Joint& KernelChain::joint(std::uint32_t index) noexcept {
    if (index >= kMostJoints) {
        workOut(index, _joints[kMostJoints]);
        return _joints[kMostJoints];
    }
    if (!_known[index]) {
        workOut(index, _joints[index]);
        _known.set(index);
    }
    return _joints[index];
}

void KernelChain::append(const SkinModel::Link& link, const State& before, State& state) noexcept {
    const Joint& turn = joint(link.joint);
    const Map& map = *before.map;
    state.partialCount = before.partialCount;
    if (!link.partial) {
        state.own = {map.turn * turn.full.turn, map.move + map.scale * (map.turn * turn.full.move),
                     map.scale * turn.full.scale};
        state.map = &state.own;
        return;
    }
    KernelLink& out = _links[state.partialCount++];
    out.bend = turn.bend;
    out.twist = turn.twist;
    out.adjusted = turn.adjusted || map.scale != 1.0;
    if (out.adjusted) {
        for (int axis = 0; axis < 3; ++axis) out.move[axis] = turn.move[axis];
        out.growth = turn.growth;
        out.outScale = map.scale;
    }
    write(map.turn * turn.frame,
          map.scale * (map.turn * _model.joints()[link.joint].centre) + map.move, out.out);
    state.map = &turn.intoFrame;
    if (link.joint < kMostJoints) return;
    state.own = turn.intoFrame; // which is another joint's next
    state.map = &state.own;
}

void KernelChain::prepare(const SkinModel::Group& group, KernelCall& call) noexcept {
    const std::size_t shared = sharedLinks(group);
    const State* behind = &_states[shared];
    for (std::size_t i = shared; i < group.linkCount; ++i) {
        State& next = _states[std::min(i, kKept) + 1];
        append(_model.links()[group.firstLink + i], *behind, next);
        behind = &next;
    }
    _last = &group;

    call.linkCount = group.partialCount;
    call.links = _links.data();
    call.lead = nullptr;
    if (!isInJointFrame(_model, group)) {
        const Map& map = *behind->map;
        write(map.turn, map.move, _lead);
        call.leadScaled = map.scale != 1.0;
        if (call.leadScaled) call.leadScale = map.scale;
        call.lead = &_lead;
        return;
    }
    const Joint& innermost = joint(_model.links()[group.firstLink + group.linkCount - 1].joint);
    call.azimuthCosine = innermost.azimuthCosine;
    call.azimuthSine = innermost.azimuthSine;
}

} // namespace osgSkin
