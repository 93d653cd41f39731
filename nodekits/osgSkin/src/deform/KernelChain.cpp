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

void KernelChain::append(const SkinModel::Link& link, State& state) noexcept {
    const JointTransform turn = _pose.transform(link.joint);
    if (!link.partial) {
        state.map.move += state.map.scale * (state.map.turn * turn.offset);
        state.map.turn = state.map.turn * glm::mat3_cast(turn.rotation);
        state.map.scale *= turn.scale;
        return;
    }
    const BoundJoint& joint = _model.joints()[link.joint];
    const glm::dvec3& v = turn.split.bendAxis;
    const glm::dmat3 frame(v, glm::cross(joint.twistAxis, v), joint.twistAxis);
    KernelLink& out = _links[state.partialCount++];
    out.bend = flushTiny(turn.split.bendAngle);
    out.twist = flushTiny(turn.split.twistAngle);
    const glm::dvec3 move = turn.translation * frame; // transposed: into the frame
    const double smallMove = SkinModelAccess::blocks(_model).smallMove;
    out.adjusted =
        glm::dot(move, move) > smallMove * smallMove || turn.scale != 1.0 || state.map.scale != 1.0;
    if (out.adjusted) {
        for (int axis = 0; axis < 3; ++axis) out.move[axis] = move[axis];
        out.growth = turn.scale - 1.0;
        out.outScale = state.map.scale;
    }
    write(state.map.turn * frame,
          state.map.scale * (state.map.turn * joint.centre) + state.map.move, out.out);
    state.map = {glm::transpose(frame), -(joint.centre * frame), 1.0};
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
    const std::uint32_t joint = _model.links()[group.firstLink + group.linkCount - 1].joint;
    const glm::dvec3 v = _pose.transform(joint).split.bendAxis;
    const glm::dmat3& frame = SkinModelAccess::blocks(_model).jointFrames[joint];
    call.azimuthCosine = glm::dot(v, frame[0]);
    call.azimuthSine = glm::dot(v, frame[1]);
}

} // namespace osgSkin
