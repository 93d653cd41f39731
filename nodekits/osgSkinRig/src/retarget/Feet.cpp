// SPDX-License-Identifier: MIT
#include "retarget/MotionSteps.h"

#include "names/BodyParts.h"
#include "retarget/PlantedFoot.h"
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

constexpr double kHalfWindow = 1 / 60.; // seconds; averages jitter out of the speed
constexpr double kShortest = 0.1;       // seconds

/// The height of the floor below one of the actor's feet.
/// \param positions of the foot, +y up, [frame]
double standingHeight(const std::vector<glm::dvec3>& positions) {
    std::vector<double> heights;
    heights.reserve(positions.size());
    for (const glm::dvec3& position : positions) heights.push_back(position.y);
    return floorBelow(heights);
}

/// Where a foot is planted, as FootSkate says.
/// \param positions of the actor's foot, +y up, [frame]
/// \param frameTime seconds between samples
/// \param floor the height that feet stand on
/// \param leg length of the actor's leg
std::vector<SampleRun> findFootContacts(const std::vector<glm::dvec3>& positions, double frameTime,
                                        double floor, double leg) {
    const std::size_t end = positions.size();
    const auto reach = static_cast<std::size_t>(
        std::clamp(std::round(kHalfWindow / frameTime), 1.0, static_cast<double>(end)));
    std::vector<SampleRun> runs = contactRuns(end, false, [&](std::size_t f) {
        const std::size_t before = f - std::min(f, reach);
        const std::size_t after = std::min(f + reach, end - 1);
        const double seconds = static_cast<double>(after - before) * frameTime;
        const double moved = glm::distance(positions[before], positions[after]) / leg;
        return kMotionContact.isPlanted((positions[f].y - floor) / leg,
                                        seconds > 0.0 ? moved / seconds : 0.0);
    });
    runs.erase(std::remove_if(runs.begin(), runs.end(),
                              [&](const SampleRun& run) {
                                  return static_cast<double>(run.count - 1) * frameTime <
                                         kShortest * (1.0 - 1e-9);
                              }),
               runs.end());
    return runs;
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

/// How far a foot slides on the floor in a contact.
double sliding(const std::vector<glm::dvec3>& positions, const SampleRun& contact) {
    return slideOf(contact.count, [&](std::size_t k) {
        const glm::dvec3& position = positions[contact.first + k];
        return glm::dvec3(position.x, 0.0, position.z);
    });
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
        for (const SampleRun& contact :
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
            record.frames += contact.count;
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
