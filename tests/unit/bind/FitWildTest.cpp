// SPDX-License-Identifier: GPL-3.0-or-later
//
// Skeletons fitted to figures that are not one closed skin: dressed, in pieces, with large heads.
#include "KnownBody.h"
#include "Shapes.h"
#include "WildBodies.h"

#include <osgSkin/Error>
#include <osgSkinBind/FitSkeleton>

#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>

using namespace osgSkin;

namespace {

struct WildFigure {
    const char* name;
    KnownBody (*make)(const KnownBody& body);
    bool zUp = false;
};

void PrintTo(const WildFigure& figure, std::ostream* out) {
    *out << figure.name;
}

KnownBody tPose(const KnownBody& body) {
    const auto turn = [](double degrees) {
        return glm::angleAxis(glm::radians(degrees), glm::dvec3(0, 0, 1));
    };
    return body.posed({{"LeftArm", turn(40.0)}, {"RightArm", turn(-40.0)}});
}

KnownBody standingOnZ(const KnownBody& body) {
    return body.mapped([](const glm::dvec3& p) { return 100.0 * glm::dvec3(p.x, -p.z, p.y); });
}

KnownBody facingBack(const KnownBody& body) {
    return body.mapped([](const glm::dvec3& p) { return glm::dvec3(-p.x, p.y, -p.z); });
}

const WildFigure kFigures[] = {
    {"clothed", wild::clothed},
    {"clothed_without_hidden_skin",
     [](const KnownBody& b) { return facingBack(wild::hollowClothed(b)); }},
    {"segmented_with_gaps_z_up_in_cm",
     [](const KnownBody& b) { return standingOnZ(wild::segmented(b, 0.04, true)); }, true},
    {"segmented_t_pose_flawed",
     [](const KnownBody& b) { return wild::flawed(wild::segmented(tPose(b), 0.0, true)); }},
    {"segmented_open", [](const KnownBody& b) { return wild::segmented(b, 0.0, false); }},
    {"mannequin", wild::mannequin},
    {"large_head_clothed",
     [](const KnownBody& b) { return wild::clothed(wild::cartoon(b, 2.0, 0.75)); }},
    {"very_thin_arms", [](const KnownBody& b) { return wild::thinArms(b, 0.25, 0.8); }},
};

class FitWild : public testing::TestWithParam<WildFigure> {};

} // namespace

TEST_P(FitWild, FindsTheJoints) {
    const KnownBody body = GetParam().make(KnownBody::thrower());
    FitOptions options;
    if (GetParam().zUp) options.up = {0, 0, 1};
    FitReport report;
    const RestSkeleton fitted = fitSkeleton(body.mesh, options, &report);
    const FitErrors errors = fitErrors(fitted, body, GetParam().zUp);
    std::printf("mean %.1f %%, worst %.1f %% (%s), %zu inside, %.2f s\n", 100.0 * errors.mean,
                100.0 * errors.worst, errors.worstJoint.c_str(), errors.inside, report.seconds);
    EXPECT_EQ(errors.joints, 31u);
    EXPECT_LT(errors.mean, 0.05) << report.text();
    EXPECT_LT(errors.worst, 0.12) << errors.worstJoint << "\n" << report.text();
}

INSTANTIATE_TEST_SUITE_P(Thrower, FitWild, testing::ValuesIn(kFigures),
                         [](const auto& figure) { return std::string(figure.param.name); });

TEST(FitWildError, NamesShellsAndLandmarks) {
    // Shells that are not a body: two boxes, one above the other.
    const SkinMesh box = shapes::cylinder();
    const SkinMesh two = shapes::joined(box, shapes::moved(box, {0.0, 8.5, 0.0}));
    try {
        fitSkeleton(two);
        FAIL();
    } catch (const Error& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find("union of 2 shells: one of"), std::string::npos) << said;
        EXPECT_NE(said.find("landmarks for LeftUpLeg"), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
}
