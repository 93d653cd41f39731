// SPDX-License-Identifier: MIT
#include "Report.h"

#include <algorithm>

namespace quality {

namespace {

/// Our figure divided by a peer's.
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
    // One second for 4,000 vertices, in proportion to their number.
    bars.push_back({"binding, seconds", report.binding.seconds, true,
                    std::max(1.0, 0.25e-3 * static_cast<double>(report.vertices))});
    return bars;
}

namespace {

/// A row of the table: a name and a figure for each method.
template <typename Figure>
void printRow(std::ostream& out, const std::string& name, const char* pattern,
              const Figure& figure) {
    out << format("  %-28s", name.c_str());
    for (const Method method : kMethods)
        out << format("%12s", format(pattern, figure(method)).c_str());
    out << '\n';
}

} // namespace

void printTable(const Report& report, std::ostream& out) {
    out << format("%s: %zu vertices, %zu poses\n  %-28s", report.body.c_str(), report.vertices,
                  report.poses, "");
    for (const Method method : kMethods) out << format("%12s", nameOf(method));
    out << '\n';
    const auto motion = [&](const char* name, const char* pattern, double PoseFigures::*figure) {
        printRow(out, name, pattern, [&](Method m) { return report.motion[m].*figure; });
    };
    motion("edge strain RMS, mean", "%.4f", &PoseFigures::strain);
    motion("99.9 % edge, mean", "%.3f", &PoseFigures::percentile999);
    motion("longest edge", "%.2f", &PoseFigures::longest);
    printRow(out, "  in pose", "%s", [&](Method m) { return report.motion[m].longestIn.c_str(); });
    motion("volume error, mean", "%.4f", &PoseFigures::volumeError);
    printRow(out, "normal error, mean, degrees", "%.2f",
             [&](Method m) { return report.motion[m].normals.mean; });
    printRow(out, "  95 %", "%.2f",
             [&](Method m) { return report.motion[m].normals.percentile95; });
    motion("bulge of limbs, mean", "%.3f", &PoseFigures::bulge);
    motion("self-intersections, mean", "%.1f", &PoseFigures::intersections);
    for (const WristTwist& twist : report.wrist) {
        const std::string name = format("wrist %.0f: ", twist.degrees);
        printRow(out, name + "strain RMS", "%.4f", [&](Method m) { return twist.strain[m]; });
        printRow(out, name + "least area", "%.3f",
                 [&](Method m) { return twist.leastArea[m].ofMethod; });
        printRow(out, "  of the coarse mesh", "%.3f",
                 [&](Method m) { return twist.leastArea[m].ofMesh; });
    }
    if (report.continuity)
        for (const bool bend : {true, false}) {
            const auto& sweeps = bend ? report.continuity->bend : report.continuity->twist;
            printRow(out, bend ? "worst step, bends" : "worst step, twists", "%.3f",
                     [&](Method m) { return sweeps[m].worst; });
            printRow(out, "  of joint", "%.9s", [&](Method m) { return sweeps[m].joint.c_str(); });
        }
    out << format("  %-28s%10s%10s%10s%10s%8s\n", "rigidity", "painted", "next", "ours", "next",
                  "skin");
    for (const LimbRigidity& limb : report.rigidity)
        out << format("  %-28s%10.4f%10.4f%10.4f%10.4f%8zu\n", limb.limb.c_str(), limb.paintedOwn,
                      limb.paintedNext, limb.own, limb.next, limb.vertices);
    out << format("  vertices with more than 4 partial joints: %.1f %%\n",
                  100.0 * report.binding.cappedShare);
    if (!report.capping.figure.empty())
        out << format("  rounding the fifth and further ones costs most of: %s\n",
                      report.capping.figure.c_str());
    std::size_t passed = 0;
    const std::vector<Bar> all = bars(report);
    for (const Bar& bar : all) {
        if (bar.passed()) ++passed;
        out << lineOf(bar);
    }
    out << format("  %zu of %zu bars hold\n\n", passed, all.size());
}

namespace {

using Json = nlohmann::ordered_json;

Json posesJson(const std::vector<PoseFigure>& poses) {
    Json json = Json::array();
    for (const PoseFigure& pose : poses)
        json.push_back({{"pose", pose.name},
                        {"edgeStrainRms", pose.strain.rms},
                        {"edge999", pose.strain.percentile999},
                        {"longestEdge", pose.strain.largest},
                        {"volumeError", pose.volumeError},
                        {"normalErrorMean", pose.normals.mean},
                        {"normalError95", pose.normals.percentile95},
                        {"limbBulge", pose.bulge},
                        {"selfIntersections", pose.intersections}});
    return json;
}

Json motionJson(const PerMethod<PoseFigures>& motion) {
    return perMethod([&](Method m) {
        return Json{{"edgeStrainRms", motion[m].strain},
                    {"edge999", motion[m].percentile999},
                    {"longestEdge", motion[m].longest},
                    {"longestEdgeIn", motion[m].longestIn},
                    {"volumeError", motion[m].volumeError},
                    {"normalErrorMean", motion[m].normals.mean},
                    {"normalError95", motion[m].normals.percentile95},
                    {"limbBulge", motion[m].bulge},
                    {"selfIntersections", motion[m].intersections},
                    {"poses", posesJson(motion[m].poses)}};
    });
}

Json rigidityJson(const std::vector<LimbRigidity>& limbs) {
    Json json = Json::object();
    for (const LimbRigidity& limb : limbs)
        json[limb.limb] = {{"own", limb.own},
                           {"next", limb.next},
                           {"paintedOwn", limb.paintedOwn},
                           {"paintedNext", limb.paintedNext},
                           {"vertices", limb.vertices}};
    return json;
}

Json wristJson(const std::vector<WristTwist>& twists) {
    Json json = Json::array();
    for (const WristTwist& twist : twists)
        json.push_back(
            {{"degrees", twist.degrees},
             {"strainRms", perMethod([&](Method m) { return twist.strain[m]; })},
             {"leastArea", perMethod([&](Method m) { return twist.leastArea[m].ofMethod; })},
             {"leastAreaOfMesh", perMethod([&](Method m) { return twist.leastArea[m].ofMesh; })}});
    return json;
}

Json sweepJson(const PerMethod<Sweep>& sweep) {
    return perMethod([&](Method m) {
        return Json{{"worst", sweep[m].worst}, {"joint", sweep[m].joint}};
    });
}

Json barsJson(const Report& report) {
    Json json = Json::array();
    for (const Bar& bar : bars(report)) json.push_back(toJson(bar));
    return json;
}

} // namespace

nlohmann::ordered_json toJson(const Report& report) {
    Json json = {{"body", report.body},
                 {"vertices", report.vertices},
                 {"poses", report.poses},
                 {"motion", motionJson(report.motion)},
                 {"rigidity", rigidityJson(report.rigidity)},
                 {"wristTwist", wristJson(report.wrist)}};
    if (report.continuity)
        json["continuity"] = {{"bend", sweepJson(report.continuity->bend)},
                              {"twist", sweepJson(report.continuity->twist)}};
    json["binding"] = {{"farRegions", report.binding.farRegions},
                       {"meanInfluences", report.binding.meanInfluences},
                       {"mostInfluences", report.binding.mostInfluences},
                       {"cappedShare", report.binding.cappedShare},
                       {"cappingCost", report.capping.share},
                       {"cappingCostOf", report.capping.figure},
                       {"seconds", report.binding.seconds}};
    json["bars"] = barsJson(report);
    return json;
}

} // namespace quality
