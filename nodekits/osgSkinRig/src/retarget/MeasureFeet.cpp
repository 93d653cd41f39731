// SPDX-License-Identifier: MIT
#include "retarget/MeasureFeet.h"

#include "retarget/BodyParts.h"
#include "retarget/FootContacts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// From the limb's first joint to `ankle`, along the bones.
double legLength(const SkeletonTree& tree, const BodyParts& parts, int ankle) {
    double length = 0.0;
    for (int j = ankle; parts.isLimb[static_cast<std::size_t>(j)]; j = tree.joint(j).parent) {
        const int parent = tree.joint(j).parent;
        if (!parts.isLimb[static_cast<std::size_t>(parent)]) break;
        length += glm::distance(tree.centre(j), tree.centre(parent));
    }
    return length;
}

/// How far `places` get, along the floor, from where they are at the stance's begin.
double sliding(const std::vector<glm::dvec3>& places, const FootContact& stance) {
    double result = 0.0;
    for (std::size_t f = stance.first; f <= stance.last; ++f) {
        const glm::dvec3 way = places[f] - places[stance.first];
        result = std::max(result, std::hypot(way.x, way.z));
    }
    return result;
}

} // namespace

MeasureFeet::MeasureFeet(const SkeletonTree& rig, const SkeletonTree& motion,
                         const std::vector<int>& motionJoint)
    : _rig(rig), _motion(motion) {
    const BodyParts parts = findBodyParts(rig), motionParts = findBodyParts(motion);
    const auto driver = [&](int j) { return motionJoint[static_cast<std::size_t>(j)]; };
    for (const int ankle : parts.ankles) {
        if (driver(ankle) < 0) continue;
        Foot foot{ankle,
                  driver(ankle),
                  legLength(rig, parts, ankle),
                  legLength(motion, motionParts, driver(ankle)),
                  {glm::dvec3(0.0), glm::dvec3(0.0)},
                  {},
                  {}};
        if (!(foot.rigLeg > 0.0) || !(foot.motionLeg > 0.0)) continue;
        if (const auto ball = findBone(rig, motion, motionJoint, ankle)) foot.ball = *ball;
        _feet.push_back(foot);
    }
}

void MeasureFeet::add(const Posed& rig, const Posed& motion) {
    const auto end = [](const Posed& posed, int joint, const glm::dvec3& bone) {
        const auto j = static_cast<std::size_t>(joint);
        return posed.places[j] + posed.world[j] * bone;
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
        record.rigJoint = _rig.joint(foot.rigJoint).name;
        record.motionJoint = _motion.joint(foot.motionJoint).name;
        record.leg = foot.rigLeg;
        for (const FootContact& stance :
             findStances(foot.motion, frameTime, floor, foot.motionLeg)) {
            const double rig = sliding(foot.rig, stance);
            const double actor = scale * sliding(foot.motion, stance);
            if (record.stances++ == 0 || rig > record.worst) {
                record.worst = rig;
                record.worstFrame = stance.first;
            }
            record.actorWorst = std::max(record.actorWorst, actor);
            record.mean += rig;
            record.actorMean += actor;
            record.frames += stance.last - stance.first + 1;
        }
        if (record.stances > 0) {
            record.mean /= static_cast<double>(record.stances);
            record.actorMean /= static_cast<double>(record.stances);
        }
        result.push_back(record);
    }
    return result;
}

} // namespace osgSkin
