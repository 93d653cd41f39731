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
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) map.turn[row][column] = turn[column][row];
        map.move[row] = move[row];
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
    : _model(model), _pose(pose) {}

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

void KernelChain::append(const SkinModel::Link& link, State& state) noexcept {
    const Joint& turn = joint(link.joint);
    if (!link.partial) {
        state.map.move += state.map.scale * (state.map.turn * turn.full.move);
        state.map.turn = state.map.turn * turn.full.turn;
        state.map.scale *= turn.full.scale;
        return;
    }
    KernelLink& out = _links[state.partialCount++];
    out.bend = turn.bend;
    out.twist = turn.twist;
    out.adjusted = turn.adjusted || state.map.scale != 1.0;
    if (out.adjusted) {
        for (int axis = 0; axis < 3; ++axis) out.move[axis] = turn.move[axis];
        out.growth = turn.growth;
        out.outScale = state.map.scale;
    }
    write(state.map.turn * turn.frame,
          state.map.scale * (state.map.turn * _model.joints()[link.joint].centre) + state.map.move,
          out.out);
    state.map = turn.intoFrame;
}

void KernelChain::prepare(const SkinModel::Group& group, KernelCall& call) noexcept {
    const std::size_t shared = sharedLinks(group);
    State state = _states[shared];
    for (std::size_t i = shared; i < group.linkCount; ++i) {
        append(_model.links()[group.firstLink + i], state);
        if (i + 1 <= kKept) _states[i + 1] = state;
    }
    _last = &group;

    call.linkCount = group.partialCount;
    call.links = _links.data();
    call.lead = nullptr;
    if (!isInJointFrame(_model, group)) {
        write(state.map.turn, state.map.move, _lead);
        call.leadScaled = state.map.scale != 1.0;
        if (call.leadScaled) call.leadScale = state.map.scale;
        call.lead = &_lead;
        return;
    }
    const Joint& innermost = joint(_model.links()[group.firstLink + group.linkCount - 1].joint);
    call.azimuthCosine = innermost.azimuthCosine;
    call.azimuthSine = innermost.azimuthSine;
}

} // namespace osgSkin
