// SPDX-License-Identifier: MIT
//
// Motions as other people's tools write them: actors who lie or crawl, clips whose nodes rest in a
// pose, ankles straight above the ball of the foot.
#include "ActorMotions.h"
#include "BvhWriter.h"
#include "ExpectError.h"
#include "Figure.h"
#include "GltfWriter.h"

#include <osgSkin/GlmTypes>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

/// A pose: rotations of joints relative to the T-pose, and the hips' height over that at rest.
struct Acted {
    std::map<std::string, glm::dquat> turns;
    glm::dvec3 hips{0.0, 1.0, 0.0};
};

glm::dquat aboutX(double degrees) {
    return turnDegrees(degrees, {1, 0, 0});
}

/// `phase` is 0 to 1, two steps.
Acted walk(double phase) {
    const double swing = std::sin(6.283185307 * phase);
    Acted acted{{{"LeftUpLeg", aboutX(-25 * swing)},
                 {"RightUpLeg", aboutX(25 * swing)},
                 {"LeftLeg", aboutX(15 + 15 * swing)},
                 {"RightLeg", aboutX(15 - 15 * swing)},
                 {"LeftArm", aboutX(20 * swing)},
                 {"RightArm", aboutX(-20 * swing)}}};
    acted.hips.z = 3.0 * phase;
    return acted;
}

/// On the back, with the head towards -z; an arm and a foot move a little.
Acted sleep(double phase) {
    const double sway = std::sin(6.283185307 * phase);
    Acted acted{{{"Hips", aboutX(-90)},
                 {"LeftArm", aboutX(5 * sway)},
                 {"Head", aboutX(3 * sway)},
                 {"RightFoot", aboutX(4 * sway)}}};
    acted.hips = {0.0, 0.12, 0.0};
    return acted;
}

/// On hands and knees, forwards.
Acted crawl(double phase) {
    const double swing = std::sin(6.283185307 * phase);
    Acted acted{{{"Hips", aboutX(80)},
                 {"LeftUpLeg", aboutX(-85 - 20 * swing)},
                 {"RightUpLeg", aboutX(-85 + 20 * swing)},
                 {"LeftLeg", aboutX(95)},
                 {"RightLeg", aboutX(95)},
                 {"LeftArm", turnDegrees(-80 + 15 * swing, {0, 1, 0})},
                 {"RightArm", turnDegrees(80 + 15 * swing, {0, 1, 0})}}};
    acted.hips = {0.0, 0.5, 1.5 * phase};
    return acted;
}

/// On the belly, feet first, as one is pulled.
Acted slide(double phase) {
    Acted acted = sleep(phase);
    acted.turns["Hips"] = aboutX(90);
    acted.hips.z = -2.0 * phase;
    return acted;
}

/// A fifth walks; then he lies where he stood, with the feet at the origin.
Acted lieDown(double phase) {
    if (phase < 0.2) {
        Acted acted = walk(5.0 * phase);
        acted.hips.z -= 3.0;
        return acted;
    }
    const double fallen = std::min(1.0, 10.0 * (phase - 0.2));
    Acted acted = sleep(phase);
    acted.turns["Hips"] = aboutX(-90 * fallen);
    const double angle = glm::radians(90.0 * fallen);
    acted.hips = {0.0, 0.12 + 0.88 * std::cos(angle), -std::sin(angle)};
    return acted;
}

/// The thrower's skeleton, with lengths in a unit.
RestSkeleton bodyIn(double unit) {
    RestSkeleton body = importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    for (RestJoint& joint : body.joints) {
        joint.centre *= unit;
        if (joint.tip) *joint.tip *= unit;
    }
    return body;
}

Motion enact(const RestSkeleton& body, Acted (*act)(double)) {
    Motion motion = standStill(body, 60);
    motion.frameTime = 1.0 / 30.0; // at which files are sampled
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const Acted acted = act(double(f) / double(motion.frames));
        for (const auto& [joint, turn] : acted.turns)
            motion.rotations[f * body.joints.size() + std::size_t(body.find(joint))] = turn;
        motion.rootPositions[f] = acted.hips * body.joints[0].centre.y;
    }
    return motion;
}

/// The pose in which the trunk leans forward over straight legs.
std::vector<glm::dquat> leaning(const RestSkeleton& body, double degrees) {
    std::vector<glm::dquat> result;
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
        const bool isTrunk = body.isInSubtree(int(j), body.find("LowerBack"));
        result.push_back(isTrunk ? aboutX(degrees) : kIdentity);
    }
    return result;
}

std::vector<glm::dquat> unchanged(const RestSkeleton& body) {
    return std::vector<glm::dquat>(body.joints.size(), kIdentity);
}
std::vector<glm::dquat> leaningFar(const RestSkeleton& body) {
    return leaning(body, 58.0);
}
std::vector<glm::dquat> leaningBack(const RestSkeleton& body) {
    return leaning(body, -40.0);
}
std::vector<glm::dquat> lying(const RestSkeleton& body) {
    return std::vector<glm::dquat>(body.joints.size(), aboutX(-90));
}
std::vector<glm::dquat> foldedUp(const RestSkeleton& body) {
    return folded(body.joints.size());
}

/// Z up instead of Y, as a whole.
Motion zUp(Motion motion) {
    const glm::dquat turn = aboutX(90);
    for (RestJoint& joint : motion.skeleton.joints) {
        joint.centre = turn * joint.centre;
        if (joint.tip) joint.tip = turn * *joint.tip;
    }
    for (glm::dquat& q : motion.rotations) q = turn * q * glm::conjugate(turn);
    for (glm::dvec3& root : motion.rootPositions) root = turn * root;
    return motion;
}

/// Another body: broader, with longer legs.
RestSkeleton otherBody() {
    RestSkeleton body = bodyIn(1.0);
    for (RestJoint& joint : body.joints) {
        joint.centre *= glm::dvec3(1.3, 1.1, 1.0);
        if (joint.tip) *joint.tip *= glm::dvec3(1.3, 1.1, 1.0);
    }
    return body;
}

using Up = RetargetOptions::Up;

struct LyingCase {
    const char* name;
    Acted (*act)(double);
    std::vector<glm::dquat> (*zero)(const RestSkeleton&);
    bool isZUp = false;
    Up stated = Up::Unknown; ///< by the caller
    bool yIsUp = false;      ///< by the file
    double unit = 1.0;
};

const LyingCase kLying[] = {
    {"sleepsFromLeaning", sleep, leaningFar},
    {"sleepsFromLeaningBack", sleep, leaningBack},
    {"sleepsFromTPose", sleep, unchanged},
    {"sleepsFromLying", sleep, lying},
    {"sleepsFromFolded", sleep, foldedUp},
    {"slidesFromLeaning", slide, leaningFar},
    {"slidesFromFolded", slide, foldedUp},
    {"crawlsFromLeaning", crawl, leaningFar},
    {"crawlsFromLeaningBack", crawl, leaningBack},
    {"crawlsFromTPose", crawl, unchanged},
    {"liesDownFromLeaning", lieDown, leaningFar},
    {"liesDownFromTPose", lieDown, unchanged},
    {"liesDownFromFolded", lieDown, foldedUp},
    {"walksFromLeaning", walk, leaningFar},
    {"walksFromFolded", walk, foldedUp},
    {"inCentimetres", crawl, leaningFar, false, Up::Unknown, false, 100.0},
    {"inKilometres", sleep, leaningFar, false, Up::Unknown, false, 0.001},
    {"sleepsInZUp", sleep, leaningFar, true},
    {"crawlsInZUp", crawl, leaningFar, true},
    {"liesDownInZUp", lieDown, leaningFar, true},
    {"walksInZUp", walk, leaningFar, true},
    {"walksInZUpFromFolded", walk, foldedUp, true},
    {"walksInZUpFromTPose", walk, unchanged, true},
    {"saidToSleepFromFolded", sleep, foldedUp, false, Up::Y},
    {"saidToSleepFromLying", sleep, lying, false, Up::Y},
    {"saidToSleepInZUp", sleep, foldedUp, true, Up::Z},
    {"saidToCrawlInZUp", crawl, leaningFar, true, Up::Z},
    {"fileSaysSleepFromLying", sleep, lying, false, Up::Unknown, true},
    {"fileSaysSleepFromFolded", sleep, foldedUp, false, Up::Unknown, true},
    {"fileSaysCrawl", crawl, leaningFar, false, Up::Unknown, true},
    {"fileIsWrongAboutAWalk", walk, leaningFar, true, Up::Unknown, true},
};

class LyingActor : public testing::TestWithParam<LyingCase> {};

} // namespace

TEST_P(LyingActor, StaysLying) {
    const LyingCase& c = GetParam();
    const Motion truth = enact(bodyIn(c.unit), c.act);
    Motion motion = rebasedFrom(truth, c.zero(truth.skeleton));
    if (c.isZUp) motion = zUp(motion);
    const std::string path = testing::TempDir() + "osgskin_lying_" + c.name + ".bvh";
    writeBvh(motion, path);
    motion = importMotion(path);
    motion.yIsUp = c.yIsUp;
    const RestSkeleton rig = otherBody();
    RetargetOptions options;
    options.up = c.stated;
    RetargetReport report;
    const Clip clip = retarget(motion, rig, options, &report);
    const Difference difference = compare(clip, rig, truth);
    EXPECT_LT(difference.limbs, 1.0) << report.text().substr(0, 400);
    EXPECT_LT(difference.heads, 10.0) << "the trunk is not aligned";
}

INSTANTIATE_TEST_SUITE_P(Cases, LyingActor, testing::ValuesIn(kLying),
                         [](const auto& tested) { return std::string(tested.param.name); });

/// Refused, as nothing shows how the body of the zero pose stands.
TEST(LyingActors, RejectsCrawlingWithoutPose) {
    const Motion truth = enact(bodyIn(1.0), crawl);
    const Motion motion = rebasedFrom(truth, foldedUp(truth.skeleton));
    expectError([&] { retarget(motion, otherBody()); }, "such as a T-pose");
}

TEST(LyingActors, AreReported) {
    const Motion truth = enact(bodyIn(1.0), sleep);
    RetargetReport report;
    retarget(rebasedFrom(truth, leaningFar(truth.skeleton)), otherBody(), {}, &report);
    EXPECT_TRUE(saysOf(report, "in which the actor lies")) << report.text().substr(0, 400);
}

namespace {

/// Every joint's y axis along its bone, as modellers have them; with a roll that differs from joint
/// to joint.
std::vector<glm::dquat> alongBones(const RestSkeleton& body) {
    std::vector<glm::dquat> result;
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
        glm::dvec3 bone(0.0, 1.0, 0.0);
        for (const int child : body.children(int(j)))
            bone = body.joints[std::size_t(child)].centre - body.joints[j].centre;
        if (!(glm::length(bone) > 1e-9)) bone = {0.0, 1.0, 0.0};
        result.push_back(shortestRotation({0, 1, 0}, bone) *
                         turnDegrees(10.0 * double(j), {0, 1, 0}));
    }
    return result;
}

/// The same joints on a figure of other proportions, in another unit.
Motion onOtherBody(Motion motion, double unit) {
    const RestSkeleton before = motion.skeleton;
    for (std::size_t j = 1; j < before.joints.size(); ++j) {
        RestJoint& joint = motion.skeleton.joints[j];
        const std::size_t p = std::size_t(joint.parent);
        const bool isLong = joint.name == "LeftLeg" || joint.name == "RightLeg" ||
                            joint.name == "LeftHand" || joint.name == "RightHand";
        joint.centre = motion.skeleton.joints[p].centre +
                       (isLong ? 1.15 : 0.95) * (before.joints[j].centre - before.joints[p].centre);
    }
    for (std::size_t j = 0; j < before.joints.size(); ++j) {
        RestJoint& joint = motion.skeleton.joints[j];
        if (joint.tip) joint.tip = joint.centre + (*before.joints[j].tip - before.joints[j].centre);
        joint.centre *= unit;
        if (joint.tip) *joint.tip *= unit;
    }
    for (glm::dvec3& root : motion.rootPositions) root *= unit;
    return motion;
}

std::vector<glm::dquat> posed(const RestSkeleton& body, const Acted& acted) {
    Motion motion = standStill(body, 1);
    for (const auto& [joint, turn] : acted.turns)
        motion.rotations[std::size_t(body.find(joint))] = turn;
    return place(motion, 0).turns;
}

Acted bow(double) {
    return {{{"LowerBack", aboutX(45)}, {"Spine1", aboutX(40)}, {"LeftArm", aboutX(80)}}};
}
Acted lookAround(double phase) {
    return {{{"Hips", turnDegrees(100 * phase, {0, 1, 0})}, {"RightForeArm", aboutX(-60)}}};
}
Acted idle(double) {
    return {{{"LeftArm", turnDegrees(-40, {0, 0, 1})},
             {"RightArm", turnDegrees(40, {0, 0, 1})},
             {"LeftForeArm", turnDegrees(-70, {0, 1, 0})},
             {"LowerBack", aboutX(20)},
             {"Hips", turnDegrees(50, {0, 1, 0})}}};
}

struct PosedCase {
    const char* name;
    Acted (*act)(double);
    Acted (*rest)(double); ///< the pose in which the clip's nodes rest, at half the time
    double unit;
};

const PosedCase kPosed[] = {
    {"bent", bow, bow, 1.0},          {"bentWalk", walk, bow, 100.0},
    {"idleRest", walk, idle, 0.01},   {"lying", sleep, sleep, 1.0},
    {"crawling", crawl, crawl, 1.0},  {"lyingWalk", walk, sleep, 1.0},
    {"turned", lookAround, bow, 1.0}, {"crawlFromWalk", crawl, walk, 1.0},
};

class PosedClip : public testing::TestWithParam<PosedCase> {
protected:
    const PosedCase& c = GetParam();
    const std::string stem = testing::TempDir() + "osgskin_posed_" + c.name;
    const Motion acted = enact(bodyIn(1.0), c.act);
    const RestSkeleton& body = acted.skeleton;

    RestSkeleton character() const {
        writeGltf(standStill(body, 1), alongBones(body), unchanged(body), stem + "_body.gltf");
        return importSkeleton(stem + "_body.gltf");
    }
    /// Without a body, its nodes at rest in a pose.
    Motion clipOf(const Motion& motion, const std::string& file) const {
        writeGltf(motion, alongBones(body), posed(body, c.rest(0.5)), stem + file);
        return importMotion(stem + file);
    }
};

} // namespace

/// A clip for a figure of other proportions moves the joints as one for the character itself.
TEST_P(PosedClip, MovesBodyWithSameJoints) {
    const RestSkeleton rig = character();
    RetargetReport report;
    const Clip clip = retarget(clipOf(onOtherBody(acted, c.unit), "_other.gltf"), rig, {}, &report);
    EXPECT_TRUE(saysOf(report, "local rotations are copied")) << report.text().substr(0, 300);
    const Clip expected = retarget(clipOf(acted, "_own.gltf"), rig);
    const Clip inMetres = retarget(clipOf(onOtherBody(acted, 1.0), "_metres.gltf"), rig);
    ASSERT_EQ(clip.frames, expected.frames);
    for (std::size_t f = 0; f < clip.frames; ++f) {
        for (std::size_t j = 0; j < clip.joints; ++j)
            ASSERT_LT(angleBetween(clip.rotations[f * clip.joints + j],
                                   expected.rotations[f * clip.joints + j]),
                      0.01)
                << body.joints[j].name << ", frame " << f;
        EXPECT_LT(glm::distance(clip.rootPositions[f], inMetres.rootPositions[f]),
                  1e-3 * (1.0 + glm::length(expected.rootPositions[f])));
        EXPECT_LT(glm::distance(expected.rootPositions[f], acted.rootPositions[f]), 1e-5)
            << "a clip of the character itself keeps its heights";
    }
    EXPECT_LT(compare(clip, rig, acted).limbs, 0.01) << "and as the actor";
    EXPECT_LT(compare(clip, rig, acted).heads, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Cases, PosedClip, testing::ValuesIn(kPosed),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(PosedClips, PrefixMayDiffer) {
    const std::string stem = testing::TempDir() + "osgskin_prefix";
    const Motion acted = enact(bodyIn(1.0), bow);
    const RestSkeleton& body = acted.skeleton;
    Motion other = onOtherBody(acted, 1.0), still = standStill(body, 1);
    for (RestJoint& joint : other.skeleton.joints) joint.name = "mixamorig1:" + joint.name;
    for (RestJoint& joint : still.skeleton.joints) joint.name = "mixamorig" + joint.name;
    writeGltf(still, alongBones(body), unchanged(body), stem + "_body.gltf");
    writeGltf(other, alongBones(body), posed(body, bow(0.5)), stem + ".gltf");
    RestSkeleton rig = importSkeleton(stem + "_body.gltf");
    RetargetReport report;
    const Clip clip = retarget(importMotion(stem + ".gltf"), rig, {}, &report);
    EXPECT_TRUE(saysOf(report, "local rotations are copied")) << report.text().substr(0, 300);
    for (RestJoint& joint : rig.joints) joint.name = joint.name.substr(9);
    EXPECT_LT(compare(clip, rig, acted).heads, 0.01);
}

/// Joints of the same names with other axes have other local rotations.
TEST(PosedClips, AreNotCopiedToOtherAxes) {
    const std::string stem = testing::TempDir() + "osgskin_other_axes";
    const Motion acted = enact(bodyIn(1.0), walk);
    const RestSkeleton& body = acted.skeleton;
    writeGltf(standStill(body, 1), alongBones(body), unchanged(body), stem + "_body.gltf");
    writeGltf(acted, folded(body.joints.size(), 3), posed(body, bow(0.5)), stem + ".gltf");
    const RestSkeleton rig = importSkeleton(stem + "_body.gltf");
    RetargetReport report;
    const Clip clip = retarget(importMotion(stem + ".gltf"), rig, {}, &report);
    EXPECT_FALSE(saysOf(report, "copied"));
    EXPECT_LT(compare(clip, rig, acted).limbs, 1.0);
}

namespace {

/// Another build of foot: the thrower's, except for the joints of one side and the other alike.
RestSkeleton withFeet(const glm::dvec3& ball, const std::optional<glm::dvec3>& tip) {
    RestSkeleton body = bodyIn(1.0);
    for (const std::string side : {"Left", "Right"}) {
        const glm::dvec3 out(side == "Left" ? 1.0 : -1.0, 1.0, 1.0);
        RestJoint& toes = body.joints[std::size_t(body.find(side + "ToeBase"))];
        toes.centre = body.joints[std::size_t(body.find(side + "Foot"))].centre + out * ball;
        toes.tip.reset();
        if (tip) toes.tip = toes.centre + out * *tip;
    }
    return body;
}

/// The largest angle between a foot and where the actor's is, both relative to rest; on top of the
/// angle between the toes at rest.
double worstFoot(const RestSkeleton& rig, const RestSkeleton& actor, double toesOut) {
    const Motion motion = enact(actor, walk);
    const Clip clip = retarget(motion, rig);
    double worst = 0.0;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed ours = place(clip, rig, f), theirs = place(motion, f);
        for (const std::string side : {"Left", "Right"}) {
            const auto foot = std::size_t(rig.find(side + "Foot"));
            const glm::dquat out = turnDegrees(side == "Left" ? toesOut : -toesOut, {0, 1, 0});
            worst = std::max(worst, angleBetween(ours.turns[foot], theirs.turns[foot] * out));
        }
    }
    return worst;
}

} // namespace

TEST(Soles, FlatFeetStayFlat) {
    const RestSkeleton usual = withFeet({0.0, -0.056, 0.147}, glm::dvec3(0.0, -0.007, 0.08));
    const RestSkeleton above = withFeet({0.0, -0.06, 0.0}, glm::dvec3(0.0, 0.0, 0.2));
    const RestSkeleton nearly = withFeet({0.0, -0.06, 0.02}, glm::dvec3(0.0, 0.0, 0.2));
    const RestSkeleton toeless = withFeet({0.0, -0.06, 0.0}, std::nullopt);
    const glm::dvec3 toes = turnDegrees(15.0, {0, 1, 0}) * glm::dvec3(0.0, 0.0, 0.2);
    const RestSkeleton outwards = withFeet({0.0, -0.06, 0.0}, toes);
    EXPECT_LT(worstFoot(usual, above, 0.0), 0.01);
    EXPECT_LT(worstFoot(above, usual, 0.0), 0.01);
    EXPECT_LT(worstFoot(usual, nearly, 0.0), 0.01);
    EXPECT_LT(worstFoot(usual, toeless, 0.0), 0.01);
    EXPECT_LT(worstFoot(toeless, above, 0.0), 0.01);
    EXPECT_LT(worstFoot(usual, outwards, 15.0), 0.01) << "toes point where the actor's do";
}

/// The feet of a body that hangs at rest are no soles.
TEST(Soles, HangingFeetAreAligned) {
    const RestSkeleton usual = withFeet({0.0, -0.056, 0.147}, glm::dvec3(0.0, -0.007, 0.08));
    const RestSkeleton hanging = withFeet({0.0, -0.19, 0.03}, glm::dvec3(0.0, -0.08, 0.0));
    EXPECT_GT(worstFoot(usual, hanging, 0.0), 45.0);
}
