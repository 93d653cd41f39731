// SPDX-License-Identifier: MIT
#include "ThrowBall.h"

#include "ThrowTiming.h"

namespace mannequin {
namespace {

constexpr double kGravity = 9.81;    // m/s^2
constexpr double kRestitution = 0.5; // fraction of the vertical speed kept in a bounce
constexpr double kGrip = 0.7;        // fraction of the horizontal speed kept in a bounce
constexpr double kBackspin = 2160;   // degrees per second; a pitcher's 30 turns would alias

struct Flight {
    glm::dvec3 position;
    glm::dvec3 velocity;

    void advance(double seconds) {
        const double fall = 0.5 * kGravity * seconds * seconds;
        position += seconds * velocity - glm::dvec3(0, fall, 0);
        velocity.y -= kGravity * seconds;
        if (position.y < kBallRadius && velocity.y < 0) {
            position.y = 2 * kBallRadius - position.y;
            velocity *= glm::dvec3(kGrip, -kRestitution, kGrip);
        }
    }
};

} // namespace

std::vector<BvhRow> ballRows(const Skeleton& skeleton, const ThrowMotion& motion) {
    const std::size_t hand = skeleton.index("RightHand");
    const double release = kRelease;
    Flight flight{motion.gripAt(release), motion.gripVelocityAt(release)};
    const glm::dquat held = worldPose(skeleton, motion.poseAt(release)).rotation[hand];

    std::vector<BvhRow> rows;
    EulerZyx last;
    for (int frame = 0; frame < kFrameCount; ++frame) {
        const double time = frameTime(frame);
        const WorldPose world = worldPose(skeleton, motion.poseAt(time));
        glm::dvec3 position = grip(skeleton, world);
        glm::dquat rotation = world.rotation[hand];
        if (frame > kReleaseFrame && frame + 1 < kFrameCount) {
            flight.advance(1.0 / kFrameRate);
            position = flight.position;
            // The throw goes towards +X, so backspin rotates about +Z.
            rotation = turn(kBackspin * (time - release), {0, 0, 1}) * held;
        }
        last = eulerNear(rotation, last);
        rows.push_back({position.x, position.y, position.z, last.z, last.y, last.x});
    }
    return rows;
}

} // namespace mannequin
