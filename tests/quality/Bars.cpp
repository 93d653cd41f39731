// SPDX-License-Identifier: MIT
#include "Bars.h"

#include <algorithm>

namespace quality {
namespace {

/// Our figure over a peer's.
double over(const Report& report, Method peer, double PoseFigures::*figure) {
    return report.motion[Method::Ours].*figure / report.motion[peer].*figure;
}

void addMotionBars(const Report& report, std::vector<Bar>& bars) {
    const auto linear = Method::Linear, dual = Method::DualQuaternion;
    bars.push_back({"edge strain RMS / DQS", over(report, dual, &PoseFigures::strain), true, 0.78});
    bars.push_back(
        {"edge strain RMS / LBS", over(report, linear, &PoseFigures::strain), true, 0.87});
    bars.push_back(
        {"99.9 % edge / DQS", over(report, dual, &PoseFigures::percentile999), true, 0.75});
    bars.push_back({"longest edge / DQS", over(report, dual, &PoseFigures::longest), true, 0.5});
    bars.push_back({"volume error - DQS's",
                    report.motion[Method::Ours].volumeError - report.motion[dual].volumeError, true,
                    0.007});
}

void addWristBars(const Report& report, std::vector<Bar>& bars) {
    constexpr double kStrain[] = {0.03, 0.07, 0.105};
    for (std::size_t i = 0; i < report.wrist.size(); ++i) {
        const WristTwist& twist = report.wrist[i];
        const std::string name = "wrist " + std::to_string(static_cast<int>(twist.degrees));
        bars.push_back({name + " strain", twist.strain[Method::Ours], true, kStrain[i]});
        bars.push_back({name + " least area", twist.leastArea[Method::Ours].ofMethod, false, 0.97});
    }
}

} // namespace

std::vector<Bar> bars(const Report& report) {
    std::vector<Bar> bars;
    addMotionBars(report, bars);
    for (const LimbRigidity& limb : report.rigidity) {
        bars.push_back({"rigidity own " + limb.limb, limb.own, false, 0.965});
        bars.push_back({"rigidity next " + limb.limb, limb.next, true, 0.01});
    }
    addWristBars(report, bars);
    if (report.continuity) {
        const Continuity& continuity = *report.continuity;
        bars.push_back({"continuity of bends", continuity.bend[Method::Ours].worst, true, 2.0});
        bars.push_back({"continuity of twists", continuity.twist[Method::Ours].worst, true, 2.0});
    }
    bars.push_back({"regions far from painted", report.binding.farRegions, true, 0.03});
    bars.push_back(
        {"influences, most", static_cast<double>(report.binding.mostInfluences), true, 4});
    bars.push_back({"influences, mean", report.binding.meanInfluences, true, 2.1});
    bars.push_back({"capping costs at most", report.capping.share, true, 0.02});
    // A second for 4,000 vertices, growing with their number.
    bars.push_back({"binding, seconds", report.binding.seconds, true,
                    std::max(1.0, 0.25e-3 * static_cast<double>(report.vertices))});
    return bars;
}

} // namespace quality
