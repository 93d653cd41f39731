// SPDX-License-Identifier: MIT
#include "Report.h"

#include "Figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

namespace twist {
namespace {

constexpr TwistPose kPoses[] = {{0, 0},  {0, 90},  {0, 180}, {0, 270}, {0, 330},  {60, 0},
                                {90, 0}, {120, 0}, {150, 0}, {90, 90}, {60, 180}, {120, 120}};

std::string row(const TwistPose& pose, Method method, const Figures& figures) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "%5.0f %6.0f  %-16s  %7.3f  %7.3f  %7.3f  %7.3f  %7.3f  %7.3f\n", pose.bend,
                  pose.twist, nameOf(method), figures.volume, figures.leastArea, figures.jointArea,
                  figures.bulge, figures.strain.rms, figures.strain.largest);
    return line;
}

} // namespace

void printReport(std::ostream& out) {
    Comparison comparison;
    const FigureMaker maker(comparison.cylinder());
    out << "A capped cylinder of radius 1 and length 8 over two bones; against the rest pose.\n\n"
           " bend  twist  method             volume  minimum     area    bulge     edge  longest\n"
           "                                            area  at joint           strain     edge\n";
    double worst = 0.0;
    for (const TwistPose& pose : kPoses) {
        comparison.setPose(pose);
        out << '\n';
        for (const Method method : kMethods) {
            const Figures figures = maker.measure(comparison.positions(method), pose);
            out << row(pose, method, figures);
            if (method == Method::Linear)
                worst = std::max(worst, std::abs(figures.jointArea - linearBlendJointArea(pose)));
        }
    }
    char line[160];
    std::snprintf(line, sizeof line,
                  "\nLinear blending's area at the joint differs from its closed form\n"
                  "(twist: cos^2(angle / 2), bend: cos(angle / 2)) by at most %.1e.\n",
                  worst);
    out << line;
}

} // namespace twist
