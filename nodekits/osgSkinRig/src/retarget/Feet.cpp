// SPDX-License-Identifier: MIT
#include "names/BodyParts.h"
#include "retarget/MotionSteps.h"
#include "retarget/RetargetTarget.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace osgSkin {
namespace {

/// Samples first to last, both included, in which a foot is planted.
struct FootContact {
    std::size_t first, last;
};

constexpr double kLow = 0.05;           // leg lengths
constexpr double kSlow = 0.3;           // leg lengths a second
constexpr double kHalfWindow = 1 / 60.; // seconds; averages jitter out of the speed
constexpr double kShortest = 0.1;       // seconds

/// The height of the floor below one of the actor's feet: the foot is lower in a twentieth of the
/// samples.
/// \param positions of the foot, +y up, [frame]
double standingHeight(const std::vector<glm::dvec3>& positions) {
    std::vector<double> heights;
    heights.reserve(positions.size());
    for (const glm::dvec3& position : positions) heights.push_back(position.y);
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), low, heights.end());
    return *low;
}

/// Where a foot is planted, as FootSkate says.
/// \param positions of the actor's foot, +y up, [frame]
/// \param frameTime seconds between samples
/// \param floor the height that feet stand on
/// \param leg length of the actor's leg
std::vector<FootContact> findFootContacts(const std::vector<glm::dvec3>& positions,
                                          double frameTime, double floor, double leg) {
    const std::size_t end = positions.size();
    const auto reach = static_cast<std::size_t>(
        std::clamp(std::round(kHalfWindow / frameTime), 1.0, static_cast<double>(end)));
    const auto isPlanted = [&](std::size_t f) {
        if (positions[f].y > floor + kLow * leg) return false;
        const std::size_t before = f - std::min(f, reach);
        const std::size_t after = std::min(f + reach, end - 1);
        const double seconds = static_cast<double>(after - before) * frameTime;
        return glm::distance(positions[before], positions[after]) <= kSlow * leg * seconds;
    };
    std::vector<FootContact> result;
    for (std::size_t f = 0; f < end; ++f) {
        if (!isPlanted(f)) continue;
        const std::size_t first = f;
        while (f + 1 < end && isPlanted(f + 1)) ++f;
        if (static_cast<double>(f - first) * frameTime >= kShortest * (1.0 - 1e-9))
            result.push_back({first, f});
    }
    return result;
}

} // namespace

FootRoll::FootRoll(const RetargetTarget& body, const std::vector<glm::dquat>& alignment)
    : _rig(body.rig), _flippedFrames(alignment.size(), 0) {
    for (const int ankle : body.rigParts.ankles) {
        const auto j = static_cast<std::size_t>(ankle);
        if (body.driver(ankle) < 0) continue;
        const auto bone = findBone(body, ankle);
        if (!bone) continue;
        const glm::dvec3 foot = alongSoles(body, ankle, *bone).motion;
        if (!(glm::length(foot) > 0.0)) continue;
        _feet.push_back({ankle, glm::conjugate(alignment[j]) * glm::normalize(foot)});
    }
}

void FootRoll::straighten(std::vector<glm::dquat>& world) {
    for (const Foot& foot : _feet) {
        const auto j = static_cast<std::size_t>(foot.joint);
        const glm::dquat& shin = world[static_cast<std::size_t>(_rig.joint(foot.joint).parent)];
        const double roll = twistAbout(foot.length, glm::conjugate(shin) * world[j]);
        const double beyond = std::abs(roll) - glm::half_pi<double>();
        if (!(beyond > 0.0)) continue;
        ++_flippedFrames[j];
        const glm::dquat back =
            glm::angleAxis(std::copysign(2.0 * beyond, -roll), world[j] * foot.length);
        rotate(foot.joint, back, world);
    }
}

void FootRoll::rotate(int joint, const glm::dquat& by, std::vector<glm::dquat>& world) const {
    glm::dquat& own = world[static_cast<std::size_t>(joint)];
    own = glm::normalize(by * own);
    for (const int child : _rig.children(joint)) rotate(child, by, world);
}

namespace {

/// Length of the leg along the bones, from the limb's first joint to `ankle`.
double legLength(const SkeletonTree& tree, const BodyParts& parts, int ankle) {
    double length = 0.0;
    for (int j = ankle; parts.isLimb[static_cast<std::size_t>(j)]; j = tree.joint(j).parent) {
        const int parent = tree.joint(j).parent;
        if (!parts.isLimb[static_cast<std::size_t>(parent)]) break;
        length += glm::distance(tree.centre(j), tree.centre(parent));
    }
    return length;
}

/// Largest distance along the floor from the position at the contact's start.
double sliding(const std::vector<glm::dvec3>& positions, const FootContact& contact) {
    double result = 0.0;
    for (std::size_t f = contact.first; f <= contact.last; ++f) {
        const glm::dvec3 moved = positions[f] - positions[contact.first];
        result = std::max(result, std::hypot(moved.x, moved.z));
    }
    return result;
}

} // namespace

MeasureFeet::MeasureFeet(const RetargetTarget& body) : _body(body) {
    for (const int ankle : body.rigParts.ankles) {
        const int driver = body.driver(ankle);
        if (driver < 0) continue;
        Foot foot{ankle,
                  driver,
                  legLength(body.rig, body.rigParts, ankle),
                  legLength(body.motion, body.motionParts, driver),
                  {glm::dvec3(0.0), glm::dvec3(0.0)},
                  {},
                  {}};
        if (!(foot.rigLeg > 0.0) || !(foot.motionLeg > 0.0)) continue;
        if (const auto ball = findBone(body, ankle)) foot.ball = *ball;
        _feet.push_back(foot);
    }
}

void MeasureFeet::add(const Posed& rig, const Posed& motion) {
    const auto end = [](const Posed& posed, int joint, const glm::dvec3& bone) {
        const auto j = static_cast<std::size_t>(joint);
        return posed.positions[j] + posed.world[j] * bone;
    };
    for (Foot& foot : _feet) {
        foot.rig.push_back(end(rig, foot.rigJoint, foot.ball.rig));
        foot.motion.push_back(end(motion, foot.motionJoint, foot.ball.motion));
    }
}

std::vector<FootSkate> MeasureFeet::finish(double frameTime, double scale) const {
    double floor = std::numeric_limits<double>::infinity();
    for (const Foot& foot : _feet) floor = std::min(floor, standingHeight(foot.motion));
    std::vector<FootSkate> result;
    for (const Foot& foot : _feet) {
        FootSkate record;
        record.rigJoint = _body.rig.joint(foot.rigJoint).name;
        record.motionJoint = _body.motion.joint(foot.motionJoint).name;
        record.leg = foot.rigLeg;
        for (const FootContact& contact :
             findFootContacts(foot.motion, frameTime, floor, foot.motionLeg)) {
            const double rig = sliding(foot.rig, contact);
            const double actor = scale * sliding(foot.motion, contact);
            if (record.contacts++ == 0 || rig > record.worst) {
                record.worst = rig;
                record.worstFrame = contact.first;
            }
            record.actorWorst = std::max(record.actorWorst, actor);
            record.mean += rig;
            record.actorMean += actor;
            record.frames += contact.last - contact.first + 1;
        }
        if (record.contacts > 0) {
            record.mean /= static_cast<double>(record.contacts);
            record.actorMean /= static_cast<double>(record.contacts);
        }
        result.push_back(record);
    }
    return result;
}

} // namespace osgSkin
