// SPDX-License-Identifier: MIT
#include "ThrowReport.h"

#include "ThrowTiming.h"

#include <algorithm>
#include <cstdio>
#include <ostream>

namespace mannequin {
namespace {

void line(std::ostream& out, const char* what, double value, const char* published) {
    char text[160];
    std::snprintf(text, sizeof text, "  %-46s %8.1f   %s\n", what, value, published);
    out << text;
}

} // namespace

// Published values, rounded: [F] Fleisig et al. 1999 (college and professional pitchers),
// [D] Dillman et al. 1993, [E] Escamilla et al. 1998. See data/README.md.
void printReport(std::ostream& out, const std::vector<FrameMeasure>& frames, const Launch& launch) {
    const FrameMeasure& contact = frames[kContactFrame];
    const FrameMeasure& cocked = frames[kMaxExternalFrame];
    const FrameMeasure& release = frames[kReleaseFrame];
    const auto window = [&](double FrameMeasure::*angle) {
        double most = 0;
        for (int i = kContactFrame; i <= kReleaseFrame; ++i)
            most = std::max(most, frames[static_cast<std::size_t>(i)].*angle);
        return most;
    };
    const double stride = contact.leftAnkle.x - frames.front().rightAnkle.x;
    const Sequence s = kinematicSequence(frames);
    const auto afterContact = [](int frame) { return 1000 * frameTime(frame - kContactFrame); };

    out << "                                                   achieved   published\n";
    out << "lead-foot contact, frame " << kContactFrame << "\n";
    line(out, "stride, % of stature", 100 * stride / 1.80, "85 [F]; shorter on purpose");
    line(out, "shoulder abduction, deg", contact.abduction, "93 [D, F]");
    line(out, "shoulder horizontal adduction, deg", contact.horizontal, "-17 to -27 [E]");
    line(out, "shoulder external rotation, deg", contact.external, "55 to 67 [F, E]");
    line(out, "elbow flexion, deg", contact.elbow, "74 to 100 [F, E]");
    line(out, "lead knee flexion, deg", contact.leftKnee, "45 to 50 [F, E]");
    line(out, "pelvis, deg open (90 faces the target)", contact.pelvisYaw, "about 35");
    line(out, "upper trunk, deg open", contact.thoraxYaw, "about -15");
    out << "greatest external rotation, frame " << kMaxExternalFrame << "\n";
    line(out, "shoulder external rotation, deg", cocked.external, "173 to 178 [F, D]");
    line(out, "shoulder abduction, deg", cocked.abduction, "95 [D]");
    line(out, "shoulder horizontal adduction, deg", cocked.horizontal, "up to 14 to 20 [D, E]");
    line(out, "elbow flexion, greatest since contact, deg", window(&FrameMeasure::elbow),
         "98 to 105 [F]");
    out << "release, frame " << kReleaseFrame << "\n";
    line(out, "time since contact, ms", afterContact(kReleaseFrame), "145 [F]; slowed");
    line(out, "time since greatest external rotation, ms",
         1000 * frameTime(kReleaseFrame - kMaxExternalFrame), "30 to 50 [D]; slowed");
    line(out, "trunk tilt to the target, deg", release.tiltForward, "33 [F]");
    line(out, "trunk tilt to the glove side, deg", release.tiltSide, "23 [E]");
    line(out, "pelvis, deg open", release.pelvisYaw, "about 85");
    line(out, "upper trunk, deg open", release.thoraxYaw, "about 100 to 110");
    line(out, "shoulder abduction, deg", release.abduction, "91 to 96 [D, F]");
    line(out, "shoulder horizontal adduction, deg", release.horizontal, "5 to 10 [F]");
    line(out, "elbow flexion, deg", release.elbow, "23 [F]");
    line(out, "lead knee flexion, deg", release.leftKnee, "39 [F]");
    out << "fastest rotations, in their order\n";
    line(out, "pelvis, deg/s", s.pelvisSpeed, "620 to 670 [F]");
    line(out, "  ms after contact", afterContact(s.pelvis), "about 50");
    line(out, "upper trunk, deg/s", s.thoraxSpeed, "1190 to 1200 [F]");
    line(out, "  ms after contact", afterContact(s.thorax), "about 75");
    line(out, "elbow extension, deg/s", s.elbowSpeed, "2320 to 2380 [F]; slowed");
    line(out, "  ms after contact", afterContact(s.elbow), "about 135");
    line(out, "shoulder internal rotation, deg/s", s.shoulderSpeed, "6900 to 7430 [D, F]; slowed");
    line(out, "  ms after contact", afterContact(s.shoulder), "about 150");
    out << "the ball\n";
    line(out, "speed, m/s", launch.speed, "35 to 37 [F]; slowed");
    line(out, "direction, deg above the horizontal", launch.up, "");
    line(out, "direction, deg off the target towards +Z", launch.sideways, "");
}

} // namespace mannequin
