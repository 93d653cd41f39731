// SPDX-License-Identifier: MIT
#include "PedestrianMotions.h"

#include "Standing.h"
#include "ThrowLegs.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <ostream>
#include <string>
#include <utility>

namespace mannequin {
namespace {

constexpr double kCarrying = 0.003; // metres; a part of the sole below this height carries

/// The ends of a sole in world space, both sides.
struct Soles {
    glm::dvec3 heel[2], tip[2];
};

Soles solesOf(const Skeleton& skeleton, const WorldPose& world) {
    const ShoeShape shoe(skeleton);
    Soles soles;
    for (const Side side : {Side::Left, Side::Right}) {
        const std::string prefix = side == Side::Left ? "Left" : "Right";
        const std::size_t ankle = skeleton.index(prefix + "Foot");
        const std::size_t ball = skeleton.index(prefix + "ToeBase");
        const glm::dvec3 mirror(sign(side), 1, 1);
        const int i = side == Side::Left ? 0 : 1;
        soles.heel[i] =
            world.position[ankle] + world.rotation[ankle] * ((shoe.heel - shoe.ankle) * mirror);
        soles.tip[i] =
            world.position[ball] + world.rotation[ball] * ((shoe.tip - shoe.ball) * mirror);
    }
    return soles;
}

/// How far a part of a foot that carries is from where it touched the floor.
class Planted {
public:
    double slide = 0; ///< the greatest so far, metres

    void add(const glm::dvec3& point, bool carries) {
        if (carries && !_carried) _from = point;
        if (carries) slide = std::max(slide, std::hypot(point.x - _from.x, point.z - _from.z));
        _carried = carries;
    }

private:
    bool _carried = false;
    glm::dvec3 _from{0};
};

/// What a motion's feet and knees do.
struct Measures {
    double lowest = 1, slide = 0, leastKnee = 180, mostKnee = 0; ///< metres, degrees
    int inTheAir = 0;                                            ///< samples
    int carried[2] = {0, 0};                                     ///< samples of each foot
};

Measures measure(const Skeleton& skeleton, const std::vector<BvhRow>& rows) {
    Measures m;
    Planted heels[2], tips[2];
    for (const BvhRow& row : rows) {
        const WorldPose world = worldPose(skeleton, poseOfRow(row));
        const Soles now = solesOf(skeleton, world);
        bool carries = false;
        for (int i = 0; i < 2; ++i) {
            m.lowest = std::min({m.lowest, now.heel[i].y, now.tip[i].y});
            if (std::min(now.heel[i].y, now.tip[i].y) < kCarrying) {
                carries = true;
                ++m.carried[i];
            }
            heels[i].add(now.heel[i], now.heel[i].y < kCarrying);
            tips[i].add(now.tip[i], now.tip[i].y < kCarrying);
            m.slide = std::max({m.slide, heels[i].slide, tips[i].slide});
        }
        m.inTheAir += !carries;
        for (const Side side : {Side::Left, Side::Right}) {
            const double knee = kneeFlexion(skeleton, side, world);
            m.leastKnee = std::min(m.leastKnee, knee);
            m.mostKnee = std::max(m.mostKnee, knee);
        }
    }
    return m;
}

/// Greatest change of a channel's step at the loop's seam, relative to the greatest at any other
/// sample.
double seam(const std::vector<BvhRow>& rows) {
    const std::size_t last = rows.size() - 1;
    double there = 0, elsewhere = 1e-3;
    for (std::size_t c = 3; c < rows[0].size(); ++c) { // angles
        const auto step = [&](std::size_t k) { return rows[k][c] - rows[k - 1][c]; };
        there = std::max(there, std::abs(step(1) - step(last)));
        for (std::size_t k = 2; k <= last; ++k)
            elsewhere = std::max(elsewhere, std::abs(step(k) - step(k - 1)));
    }
    return there / elsewhere;
}

} // namespace

std::vector<BvhRow> PedestrianMotion::rows() const {
    std::vector<Pose> poses;
    for (int frame = 0; frame <= frames; ++frame)
        poses.push_back(poseAt(static_cast<double>(frame) / frameRate));
    return bvhRows(poses);
}

std::vector<PedestrianMotion> pedestrianMotions(const Skeleton& skeleton) {
    std::vector<PedestrianMotion> motions;
    const auto add = [&](const char* name, int rate, double seconds, auto poseAt) {
        motions.push_back({name, rate, static_cast<int>(std::lround(seconds * rate)), 0, false,
                           [&skeleton, poseAt](double t) { return poseAt(skeleton, t); }});
    };
    const auto addGait = [&](const char* name, Gait gait, bool isRun) {
        const auto motion = std::make_shared<GaitMotion>(skeleton, std::move(gait));
        motions.push_back({name, 60, static_cast<int>(std::lround(motion->gait().seconds * 60)),
                           motion->gait().stride, isRun,
                           [motion](double t) { return motion->poseAt(t); }});
    };
    add("idle", 30, kIdleSeconds, idlePose);
    addGait("walk", walk(), false);
    addGait("run", run(), true);
    add("wave", 30, kWaveSeconds, wavePose);
    return motions;
}

bool checkMotion(std::ostream& out, const Skeleton& skeleton, const PedestrianMotion& motion,
                 const std::vector<BvhRow>& rows) {
    bool good = true;
    const auto within = [&](const char* what, double value, double least, double most) {
        const bool ok = value >= least && value <= most;
        char text[200];
        std::snprintf(text, sizeof text, "%-4s %-5s %-44s %9.4f in [%g, %g]\n", ok ? "ok" : "FAIL",
                      motion.name.c_str(), what, value, least, most);
        out << text;
        good = good && ok;
    };
    within("samples", static_cast<double>(rows.size()), motion.frames + 1, motion.frames + 1);
    if (rows.size() < 3) return false;
    double gap = std::abs(rows.back()[2] - rows[0][2] - motion.stride);
    for (std::size_t c = 0; c < rows[0].size(); ++c)
        if (c != 2) gap = std::max(gap, std::abs(rows.back()[c] - rows[0][c]));
    within("gap between the ends, m or degrees", gap, 0, 0.0005);
    within("change of speed at the seam, of the greatest", seam(rows), 0, 1.2);

    const bool moves = motion.stride > 0;
    const Measures m = measure(skeleton, rows);
    const int samples = motion.frames + 1;
    within("lowest point of the soles, m", m.lowest, -kCarrying, kCarrying);
    within("slide of feet that carry, m", m.slide, 0, moves ? 0.01 * motion.stride : 0.001);
    within("samples without a foot on the floor", m.inTheAir, motion.isRun ? 0.2 * samples : 0,
           motion.isRun ? 0.4 * samples : 0);
    for (const int carried : m.carried)
        within("samples of a foot on the floor", carried,
               samples * (motion.isRun ? 0.3
                          : moves      ? 0.58
                                       : 1),
               samples * (motion.isRun ? 0.4
                          : moves      ? 0.66
                                       : 1));
    within("least flexion of a knee, degrees", m.leastKnee, kMinKnee - 0.01, 25);
    within("greatest flexion of a knee, degrees", m.mostKnee,
           motion.isRun ? 85
           : moves      ? 58
                        : 8,
           motion.isRun ? 110
           : moves      ? 70
                        : 25);
    return good;
}

} // namespace mannequin
