// SPDX-License-Identifier: MIT
#include "CylinderReport.h"

#include "Format.h"

namespace quality {
namespace {

std::vector<Bar> bars(const std::vector<CylinderPose>& poses) {
    return {{"least area in twists", leastTwistArea(poses), false, 0.99},
            {"volume error to bend 120", mostVolumeError(poses), true, 0.01}};
}

} // namespace

void printTable(const std::vector<CylinderPose>& poses, std::ostream& out) {
    out << format("%-20s%30s%30s%30s\n%20s", "cylinder", "strain RMS", "volume", "least area", "");
    for (int figure = 0; figure < 3; ++figure)
        for (const Method method : kMethods) out << format("%10s", nameOf(method));
    out << '\n';
    for (const CylinderPose& pose : poses) {
        out << format("  %-5s %-12.0f", pose.bend > 0.0 ? "bend" : "twist", pose.bend + pose.twist);
        for (const auto* figure : {&pose.strain, &pose.volume, &pose.leastArea})
            for (const Method method : kMethods) out << format("%10.3f", (*figure)[method]);
        out << '\n';
    }
    for (const Bar& bar : bars(poses)) out << lineOf(bar);
    out << '\n';
}

nlohmann::ordered_json toJson(const std::vector<CylinderPose>& poses) {
    nlohmann::ordered_json json = {{"poses", nlohmann::json::array()},
                                   {"bars", nlohmann::json::array()}};
    for (const CylinderPose& pose : poses)
        json["poses"].push_back(
            {{"bend", pose.bend},
             {"twist", pose.twist},
             {"edgeStrainRms", perMethod([&](Method m) { return pose.strain[m]; })},
             {"volume", perMethod([&](Method m) { return pose.volume[m]; })},
             {"leastArea", perMethod([&](Method m) { return pose.leastArea[m]; })}});
    for (const Bar& bar : bars(poses)) json["bars"].push_back(toJson(bar));
    return json;
}

} // namespace quality
