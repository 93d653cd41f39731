// SPDX-License-Identifier: MIT
#include "Table.h"

#include "Bars.h"

namespace quality {
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

} // namespace quality
