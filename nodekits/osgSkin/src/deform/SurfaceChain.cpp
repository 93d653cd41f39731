// SPDX-License-Identifier: MIT
#include "deform/SurfaceChain.h"

#include "model/SkinModelAccess.h"

#include <osgSkin/BendTwist>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace osgSkin {
namespace {

bool isMoved(const SkinModel& model, const JointTransform& turn) noexcept {
    const double small = SkinModelAccess::blocks(model).smallMove;
    return glm::dot(turn.translation, turn.translation) > small * small || turn.scale != 1.0;
}

glm::dvec3 scaledTo(const glm::dvec3& direction, double length) noexcept {
    const double is = glm::length(direction);
    return is > 0.0 ? direction * (length / is) : direction;
}

} // namespace

SurfaceChain::SurfaceChain(const SkinModel& model, std::size_t group, const Pose& pose) noexcept
    : _model(model), _group(group), _pose(pose), _frame(restFrame(model, model.groups()[group])) {
    const GradientBlocks& blocks = *SkinModelAccess::gradients(model);
    const SkinModel::Group& of = model.groups()[group];
    const GradientBlocks::Reach* reach = blocks.reach.data() + blocks.firstReach[group];
    std::size_t k = 0;
    for (std::uint32_t i = of.firstLink; i < of.firstLink + of.linkCount; ++i) {
        if (!model.links()[i].partial) continue;
        const JointTransform turn = pose.transform(model.links()[i].joint);
        _links[k] =
            linkTilt(reach[k], turn.split.bendAngle, turn.split.twistAngle, isMoved(model, turn));
        if (_links[k++].any()) _tilts = true;
    }
}

void SurfaceChain::apply(std::uint32_t row, const SkinModel::Ratio* ratios,
                         const glm::dvec3& position, glm::vec3& normal, const glm::dvec3& tilt,
                         glm::vec3* tangent) const noexcept {
    const GradientBlocks& blocks = *SkinModelAccess::gradients(_model);
    const SkinModel::Group& group = _model.groups()[_group];
    const GradientRow* gradients = blocks.blockOf(_model, _group, row);
    const auto gradient = [&]() { return blocks.unit * double((gradients++)->lane[row % kBlock]); };
    const SkinDirections rest =
        skinDirections(normal, _frame, blocks.acrossOf(_model, _group, row));
    glm::dvec3 x = position;
    glm::dvec3 u = rest.u - glm::dot(tilt, rest.u) * glm::dvec3(normal);
    glm::dvec3 v = rest.v - glm::dot(tilt, rest.v) * glm::dvec3(normal);
    std::size_t k = group.partialCount;
    for (std::uint32_t i = group.firstLink + group.linkCount; i-- > group.firstLink;) {
        const SkinModel::Link& link = _model.links()[i];
        const JointTransform turn = _pose.transform(link.joint);
        if (!link.partial) {
            x = turn.offset + turn.scale * (turn.rotation * x);
            u = turn.scale * (turn.rotation * u);
            v = turn.scale * (turn.rotation * v);
            continue;
        }
        const BoundJoint& joint = _model.joints()[link.joint];
        const double bend = double(ratios[--k].bend), twist = double(ratios[k].twist);
        const double bendU = gradient(), bendV = gradient();
        const double twistU = gradient(), twistV = gradient();
        const glm::dquat q = partialRotation(turn.split, joint.twistAxis, bend, twist);
        const glm::dvec3 from = q * (x - joint.centre);
        const glm::dvec3 twistAxis =
            glm::angleAxis(bend * turn.split.bendAngle, turn.split.bendAxis) * joint.twistAxis;
        glm::dvec3 byBend(0.0), byTwist(0.0);
        if (_links[k].bends) byBend = turn.split.bendAngle * glm::cross(turn.split.bendAxis, from);
        if (_links[k].twists) byTwist = turn.split.twistAngle * glm::cross(twistAxis, from);
        // A translation and a scale of the joint, where the motion has them, come in with the bend.
        const double factor = 1.0 + bend * (turn.scale - 1.0);
        byBend = factor * byBend;
        if (_links[k].moves) byBend += (turn.scale - 1.0) * from + turn.translation;
        u = factor * (q * u + byTwist * twistU) + byBend * bendU;
        v = factor * (q * v + byTwist * twistV) + byBend * bendV;
        x = joint.centre + bend * turn.translation + factor * from;
    }
    if (tangent) {
        const glm::dvec3 t(*tangent);
        *tangent = scaledTo(glm::dot(t, rest.u) * u + glm::dot(t, rest.v) * v, glm::length(t));
    }
    normal = scaledTo(glm::cross(u, v), 1.0);
}

void tiltNormal(const glm::dvec3& tilt, glm::vec3& normal, glm::vec3& tangent) noexcept {
    const glm::dvec3 n = scaledTo(glm::dvec3(normal) + tilt, 1.0);
    const glm::dvec3 t(tangent);
    normal = n;
    tangent = scaledTo(t - glm::dot(t, n) * n, glm::length(t));
}

} // namespace osgSkin
