// SPDX-License-Identifier: MIT
#include "Gait.h"

#include "ThrowLegs.h"
#include "ThrowTrunk.h"

#include <cmath>
#include <utility>

namespace mannequin {

// The angles are rounded from means over healthy adults and were smoothed and matched to this
// skeleton by eye:
//   D. A. Winter, *The Biomechanics and Motor Control of Human Gait*, 2nd ed. (1991);
//   J. Perry, *Gait Analysis: Normal and Pathological Function* (1992);
//   T. F. Novacheck, "The biomechanics of running", *Gait & Posture* 7 (1998) 77-95.

double Swing::at(double phase, int times) const {
    return mean + amplitude * std::cos(radians(360) * times * (phase - peak));
}

Gait walk() {
    Gait g;
    g.seconds = 66.0 / 60;
    g.stride = 1.4 * g.seconds;
    g.foot = {g.stride,
              0.61,
              0.203,
              0.056,
              Channel(0.014,
                      {{0.00, -21},
                       {0.08, 0},
                       {0.28, 0},
                       {0.40, 8},
                       {0.50, 30},
                       {0.56, 50},
                       {0.61, 66},
                       {0.655, 70},
                       {0.71, 54},
                       {0.78, 20},
                       {0.85, 0},
                       {0.93, -19},
                       {0.97, -23}},
                      1),
              {{0.70, 15, 67}, {0.79, 27.5, 54}, {0.94, 25, 10}}};
    g.hipsHeight = 0.9405;
    g.rise = {0, 0.0135, 0.268};
    g.surge = {0, 0.006, 0.10};
    g.sway = {0, 0.020, 0.31};
    g.turn = {0, -5, 0.98};
    g.list = {0, 3.5, 0.14};
    g.tilt = {3, 1, 0.08};
    g.counterTurn = {0, 5, 0.02};
    g.lean = {2.5, 0.8, 0.10};
    g.side = {0, 1.2, 0.16};
    g.nod = {-1, -0.6, 0.10};
    g.arm = {-5, 19, 0.53};
    g.elbow = {24, 10, 0.56};
    g.girdle = {0, 4, 0.53};
    g.spread = 9;
    g.inward = 0.30;
    g.fingers = 14;
    return g;
}

Gait run() {
    Gait g;
    g.seconds = 43.0 / 60;
    g.stride = 3.2 * g.seconds;
    g.foot = {g.stride,
              0.345,
              0.095,
              0.030,
              Channel(0.014,
                      {{0.00, -11},
                       {0.05, 0},
                       {0.14, 0},
                       {0.22, 14},
                       {0.29, 40},
                       {0.345, 62},
                       {0.43, 93},
                       {0.55, 104},
                       {0.68, 68},
                       {0.79, 18},
                       {0.91, -10},
                       {0.96, -14}},
                      1),
              {{0.46, -7, 64}, {0.58, 14, 94}, {0.72, 38, 84}, {0.84, 39, 48}, {0.94, 28, 15}}};
    g.hipsHeight = 0.922;
    g.rise = {0, 0.031, 0.42};
    g.surge = {0, 0.006, 0.40};
    g.sway = {0, 0.010, 0.18};
    g.turn = {0, -8, 0.96};
    g.list = {0, 5, 0.10};
    g.tilt = {9, 2, 0.33};
    g.counterTurn = {0, 9, 0.00};
    g.lean = {8, 1.5, 0.14};
    g.side = {0, 1.5, 0.12};
    g.nod = {-2, -1, 0.12};
    g.arm = {-15, 34, 0.48};
    g.elbow = {92, 9, 0.48};
    g.girdle = {0, 7, 0.48};
    g.spread = 14;
    g.inward = 0.38;
    g.fingers = 34;
    return g;
}

GaitMotion::GaitMotion(const Skeleton& skeleton, Gait gait)
    : skeleton_(skeleton), gait_(std::move(gait)),
      path_(skeleton, gait_.foot, [this](double phase) {
          const WorldPose world = worldPose(skeleton_, trunkAt(phase));
          return world.position[skeleton_.index("LeftUpLeg")];
      }) {}

Pose GaitMotion::trunkAt(double phase) const {
    const Gait& g = gait_;
    Pose pose;
    pose.local.assign(skeleton_.joints().size(), glm::dquat(1, 0, 0, 0));
    pose.root = {g.sway.at(phase), g.hipsHeight + g.rise.at(phase, 2), g.surge.at(phase, 2)};
    poseTrunk(skeleton_,
              {stance(g.turn.at(phase), -g.list.at(phase), g.tilt.at(phase, 2)),
               stance(g.counterTurn.at(phase), g.side.at(phase), g.lean.at(phase, 2)),
               turn(g.nod.at(phase, 2), {1, 0, 0})},
              pose);
    return pose;
}

Pose GaitMotion::poseAt(double time) const {
    const Gait& g = gait_;
    const double cycles = time / g.seconds;
    const double phase = cycles - std::floor(cycles);
    const double ahead = g.stride * cycles;
    Pose pose = trunkAt(phase);
    pose.root.z += ahead;
    for (const Side side : {Side::Left, Side::Right}) {
        const double own = side == Side::Left ? phase : phase + 0.5;
        const FootPlacement foot = path_.at(own);
        FootTarget target;
        target.ankle = foot.ankle + glm::dvec3(0, 0, ahead);
        target.ankle.x *= sign(side);
        target.rotation = turn(foot.pitch, {1, 0, 0});
        target.toeBend = foot.toeBend;
        poseLeg(skeleton_, side, target, pose);

        ArmAngles arm;
        arm.protraction = g.girdle.at(own);
        arm.elbow = g.elbow.at(own);
        arm.pronation = 15;
        arm.fingers = g.fingers;
        arm.thumb = g.fingers / 2;
        const double forward = radians(g.arm.at(own)), out = radians(g.spread);
        const double s = sign(side);
        poseArm(skeleton_, side, arm,
                {{s * std::sin(out), -std::cos(out) * std::cos(forward),
                  std::cos(out) * std::sin(forward)},
                 {-s * g.inward, 0.2, 1}},
                pose);
    }
    return pose;
}

} // namespace mannequin
