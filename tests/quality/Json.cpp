// SPDX-License-Identifier: MIT
#include "Json.h"

#include "Bars.h"

namespace quality {
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
