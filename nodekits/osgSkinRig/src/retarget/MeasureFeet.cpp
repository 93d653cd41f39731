// SPDX-License-Identifier: MIT
#include "retarget/MeasureFeet.h"

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

/// How far `positions` get, along the floor, from where they are when the contact begins.
double sliding(const std::vector<glm::dvec3>& positions, const FootContact& contact) {
    double result = 0.0;
    for (std::size_t f = contact.first; f <= contact.last; ++f) {
        const glm::dvec3 moved = positions[f] - positions[contact.first];
        result = std::max(result, std::hypot(moved.x, moved.z));
    }
    return result;
}

} // namespace

MeasureFeet::MeasureFeet(const DrivenRig& body) : _body(body) {
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
