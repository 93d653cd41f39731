// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include "model/JointBoxes.h"
#include "model/SkinBlocks.h"
#include "pose/CorrectiveWeights.h"
#include "pose/PoseKernel.h"

#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace osgSkin {
namespace {

/// A joint of JointBoxes in a pose.
struct PosedJoint {
    glm::dmat3 turn;    ///< of its skinning matrix G: rotation and scale
    glm::dvec3 offset;  ///< the same: translation
    double totalScale;  ///< of G
    double scale;       ///< relative to the parent, as the following
    double bend, twist; ///< absolute angles
    double travel;      ///< length of the translation; 0 for the root, which all vertices follow
};

void poseJoints(const JointBoxes& boxes, const Pose& pose, PosedJoint* posed) {
    for (std::size_t i = 0; i < boxes.joints.size(); ++i) {
        const JointBoxes::Joint& joint = boxes.joints[i];
        const PoseAccess::Split own = PoseAccess::split(pose, joint.joint);
        const glm::dmat3 turn = own.scale * glm::mat3_cast(own.rotation);
        PosedJoint& to = posed[i];
        to.scale = own.scale;
        to.bend = own.bendAngle;
        to.twist = std::abs(own.twistAngle);
        if (joint.parent < 0) {
            to.turn = turn;
            to.offset = own.offset;
            to.totalScale = own.scale;
            to.travel = 0.0;
            continue;
        }
        const PosedJoint& parent = posed[joint.parent];
        const glm::dvec3 centre = PoseAccess::rest(pose, joint.joint).centre;
        to.turn = parent.turn * turn;
        to.offset = parent.turn * own.offset + parent.offset;
        to.totalScale = parent.totalScale * own.scale;
        to.travel = glm::length(own.offset + turn * centre - centre);
    }
}

/// How far the correctives of each joint move vertices, at most.
class CorrectiveReach {
public:
    CorrectiveReach(const JointBoxes& boxes, const SkinModel& model, const Pose& pose) {
        if (boxes.reaches.empty()) return;
        CorrectiveWeights weights(model, pose);
        const double* reach = boxes.modeReach.data();
        for (std::uint32_t j = 0; j < SkinModelAccess::correctives(model)->joints.size(); ++j) {
            const CorrectiveWeights::Weights* const now = weights.of(j);
            _lengths[j] = 0.0;
            for (std::size_t k = 0; now && k < weights.modesOf(j); ++k)
                _lengths[j] += std::abs(double(now->positions[k])) * reach[k];
            reach += CorrectiveJoint::kMaxModes;
        }
    }
    double operator[](std::uint32_t joint) const { return _lengths[joint]; }

private:
    std::array<double, Correctives::kMaxJoints> _lengths;
};

/// The largest |G_m^-1 G_A x - x| of points about a centre.
double movedBy(const PosedJoint& a, const PosedJoint& m, const glm::dvec3& centre, double radius) {
    // The largest factor of a difference of two scaled rotations, by the angle between them: its
    // square is a^2 + m^2 - 2 a m cos, and the trace of the rotation between them is 1 + 2 cos.
    double trace = 0.0; // times both scales
    for (int i = 0; i < 3; ++i) trace += glm::dot(a.turn[i], m.turn[i]);
    const double square = a.totalScale * a.totalScale + m.totalScale * m.totalScale +
                          a.totalScale * m.totalScale - trace;
    const glm::dvec3 moved = (a.turn - m.turn) * centre + a.offset - m.offset;
    return (glm::length(moved) + radius * std::sqrt(std::max(square, 0.0))) / m.totalScale;
}

constexpr double kRounding = 2e-6; ///< of a coordinate: several roundings

/// How far the vertices of a box can be from where its joint moves them (JointBoxes).
class Enlargement {
public:
    Enlargement(const JointBoxes& boxes, const PosedJoint* posed, const CorrectiveReach& corrected)
        : _boxes(boxes), _posed(posed), _corrected(corrected) {}

    double of(const JointBoxes::Box& box, std::size_t joint) const {
        double sum = 0.0, growth = 1.0; // growth: by outer joints' scales, beyond the box's own
        const JointBoxes::Term* term = _boxes.terms.data() + box.firstTerm;
        for (const auto* const end = term + box.termCount; term != end; ++term) {
            const PosedJoint& k = _posed[term->joint];
            const PosedJoint& m = _posed[term->from];
            double bend = term->bendReach, twist = term->twistReach;
            if (term->from != joint) {
                const double moved =
                    movedBy(_posed[joint], m, _boxes.joints[joint].frame * box.centre,
                            glm::length(box.half));
                bend += term->bend * moved;
                twist += term->twist * moved;
            }
            double length = k.bend * bend + k.twist * twist;
            double grown = 1.0;
            if (k.scale != 1.0 || k.travel != 0.0) {
                // m's scale includes the joint's own where it is followed fully.
                const double unit = term->isFull ? 1.0 / k.scale : 1.0;
                length += unit * (std::abs(k.scale - 1.0) * bend + k.travel * term->bend);
                grown += term->bend * std::max(0.0, (term->isFull ? unit : k.scale) - 1.0);
            }
            sum += growth * m.totalScale * length;
            growth *= grown;
        }
        double atRest = _boxes.rounding;
        for (std::uint32_t i = box.firstReach; i < box.firstReach + box.reachCount; ++i)
            atRest += _boxes.reaches[i].share * _corrected[_boxes.reaches[i].joint];
        return sum + growth * _posed[joint].totalScale * atRest;
    }

private:
    const JointBoxes& _boxes;
    const PosedJoint* _posed;
    const CorrectiveReach& _corrected;
};

} // namespace

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    const JointBoxes* const boxes = SkinModelAccess::jointBoxes(model);
    if (!boxes) return {glm::vec3(1.0f), glm::vec3(-1.0f)};
    std::array<PosedJoint, 128> few;
    std::vector<PosedJoint> many(boxes->joints.size() > few.size() ? boxes->joints.size() : 0);
    PosedJoint* const posed = many.empty() ? few.data() : many.data();
    poseJoints(*boxes, pose, posed);
    const CorrectiveReach corrected(*boxes, model, pose);
    const Enlargement enlargement(*boxes, posed, corrected);
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (std::size_t j = 0; j < boxes->joints.size(); ++j) {
        const JointBoxes::Joint& joint = boxes->joints[j];
        if (joint.boxCount == 0) continue;
        const glm::dmat3 turn = posed[j].turn * joint.frame;
        const glm::dmat3 sizes(glm::abs(turn[0]), glm::abs(turn[1]), glm::abs(turn[2]));
        for (std::uint32_t i = joint.firstBox; i < joint.firstBox + joint.boxCount; ++i) {
            const JointBoxes::Box& box = boxes->boxes[i];
            const glm::dvec3 centre = turn * box.centre + posed[j].offset;
            const glm::dvec3 half =
                sizes * box.half + enlargement.of(box, j) + kRounding * glm::abs(centre);
            low = glm::min(low, centre - half);
            high = glm::max(high, centre + half);
        }
    }
    // Poses are in this range.
    const glm::dvec3 most(kLargestCoordinate);
    return {glm::vec3(glm::max(low, -most)), glm::vec3(glm::min(high, most))};
}

} // namespace osgSkin
