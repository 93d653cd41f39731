// SPDX-License-Identifier: MIT
// VRM 1 of osgskinbake --rigged: against three-vrm, Khronos' validator, and read again by osgSkin.
#include "Command.h"
#include "ExpectContains.h"
#include "GlbFile.h"
#include "GltfReference.h"
#include "VrmFigure.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/SpringBones>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using osgSkin::SpringSettings;
using test::GltfReference;
using test::runBake;
using test::VrmFigure;

/// With expressions, eyes that look, swinging forearms and colliders, and a clip of one second.
struct LivelyFigure : VrmFigure {
    LivelyFigure() {
        addExpressions();
        vrm()["lookAt"] = {{"type", "bone"}, {"offsetFromHeadBone", {0.0, 0.06, 0.02}}};
        const auto joint = [&](const char* bone) {
            return nlohmann::json{{"node", bones[bone]}, {"stiffness", 0.7},
                                  {"gravityPower", 0.4}, {"gravityDir", {0.6, -0.8, 0.0}},
                                  {"dragForce", 0.3},    {"hitRadius", 0.02}};
        };
        const nlohmann::json inside{
            {"sphere", {{"offset", {0, 0, 0.1}}, {"radius", 0.9}, {"inside", true}}}};
        nlohmann::json extended{
            {"node", bones["head"]},
            {"shape", {{"sphere", {{"offset", {0, -10000, 0}}, {"radius", 0}}}}}};
        extended["extensions"]["VRMC_springBone_extended_collider"] = {{"specVersion", "1.0"},
                                                                       {"shape", inside}};
        nlohmann::json& springs = json["extensions"]["VRMC_springBone"];
        springs["specVersion"] = "1.0";
        springs["colliders"] = {
            {{"node", bones["chest"]},
             {"shape", {{"sphere", {{"offset", {0, 0.1, 0}}, {"radius", 0.12}}}}}},
            {{"node", bones["hips"]},
             {"shape",
              {{"capsule", {{"offset", {-0.1, 0, 0}}, {"tail", {0.1, 0, 0}}, {"radius", 0.1}}}}}},
            extended};
        springs["colliderGroups"] = {{{"colliders", {0, 1}}}, {{"colliders", {2}}}};
        springs["springs"] = {
            {{"joints", {joint("leftLowerArm"), joint("leftHand")}},
             {"colliderGroups", {0}},
             {"center", bones["hips"]}},
            {{"joints", {joint("rightUpperArm"), joint("rightLowerArm"), joint("rightHand")}},
             {"colliderGroups", {0, 1}}}};
        springs["springs"][0]["joints"][0]["stiffness"] = 1.5;
        for (const char* name : {"VRMC_springBone", "VRMC_springBone_extended_collider"})
            json["extensionsUsed"].push_back(name);
        animate("wave", bones["leftUpperArm"], "rotation", {0, 1},
                {0, 0, 0, 1, 0, 0, std::sin(0.5), std::cos(0.5)});
        animate("wave", bones["spine"], "rotation", {0, 1},
                {0, 0, 0, 1, 0, std::sin(0.4), 0, std::cos(0.4)});
    }
};

/// The same numbers within 1e-5, and else equal.
void expectNear(const json& found, const json& expected, const std::string& where) {
    if (expected.is_number() && found.is_number()) {
        EXPECT_NEAR(found.get<double>(), expected.get<double>(), 1e-5) << where;
    } else if (expected.is_structured() && found.size() == expected.size() &&
               found.type() == expected.type()) {
        for (const auto& [key, value] : expected.items())
            if (expected.is_array())
                expectNear(found[std::stoul(key)], value, where + '/' + key);
            else
                expectNear(found.value(key, json()), value, where + '/' + key);
    } else {
        EXPECT_EQ(found, expected) << where;
    }
}

/// A file as three-vrm loads it, see load_vrm.mjs.
json loadByThree(const std::string& file, double seconds, const std::string& folder) {
    const auto loaded = test::runCommand("NODE_PATH='" OSGSKIN_NODE_MODULES
                                         "' node '" OSGSKIN_SOURCE "/tests/system/load_vrm.mjs' '" +
                                             file + "' " + std::to_string(seconds),
                                         folder);
    EXPECT_EQ(loaded.status, 0) << loaded.err;
    return json::parse(loaded.out, nullptr, false);
}

bool hasThreeVrm() {
    return test::runCommand("ls '" OSGSKIN_NODE_MODULES "/@pixiv/three-vrm'", ".").status == 0;
}

/// The largest distance from a point of `from` to the nearest of `to`.
double farthest(const json& from, const json& to) {
    double result = from.empty() ? INFINITY : 0.0;
    for (const json& a : from) {
        double nearest = INFINITY;
        for (const json& b : to)
            nearest = std::min(nearest, std::hypot(a[0].get<double>() - b[0].get<double>(),
                                                   a[1].get<double>() - b[1].get<double>(),
                                                   a[2].get<double>() - b[2].get<double>()));
        result = std::max(result, nearest);
    }
    return result;
}

/// Makes a rigged file of a figure, and returns what the program says.
std::string rig(VrmFigure& figure, const std::string& folder) {
    const auto baked = runBake("'" + figure.save("figure.vrm") + "' --rigged rigged.vrm", folder);
    EXPECT_EQ(baked.status, 0) << baked.err;
    return baked.err;
}

} // namespace

TEST(RiggedVrm, IsTheSameToThreeVrm) {
    if (!hasThreeVrm()) GTEST_SKIP() << "needs @pixiv/three-vrm in " OSGSKIN_NODE_MODULES;
    const std::string folder = test::makeTestFolder();
    LivelyFigure figure;
    test::expectContains(rig(figure, folder), "1 clips");
    for (const double seconds : {0.0, 0.5, 1.0}) {
        json expected = loadByThree(figure.save("figure.vrm"), seconds, folder);
        json found = loadByThree(folder + "/rigged.vrm", seconds, folder);
        const double most = 1e-3 * 1.8;
        EXPECT_LE(farthest(found["vertices"], expected["vertices"]), most);
        EXPECT_LE(farthest(expected["vertices"], found["vertices"]), most);
        found.erase("vertices");
        expected.erase("vertices");
        EXPECT_EQ(expected["springs"].size(), 3u);
        EXPECT_EQ(expected["expressions"].size(), 4u);
        expectNear(found, expected, "");
    }
}

TEST(RiggedVrm, PassesTheValidator) {
    std::string why;
    if (!test::hasGlbValidator(why)) GTEST_SKIP() << why;
    const std::string folder = test::makeTestFolder();
    LivelyFigure figure;
    rig(figure, folder);
    EXPECT_EQ(test::glbComplaints(folder + "/rigged.vrm"), "");
}

TEST(RiggedVrm, HasTheSameSpringsRolesAndExpressionsWhenReadAgain) {
    const std::string folder = test::makeTestFolder();
    LivelyFigure figure;
    EXPECT_EQ(rig(figure, folder).find("left out"), std::string::npos);
    const auto before = osgSkin::loadCharacter(figure.save("figure.vrm"));
    const auto after = osgSkin::loadCharacter(folder + "/rigged.vrm");
    for (const auto& [role, joints] : before.roles.joints) {
        const int joint = after.roles.joint(role);
        ASSERT_GE(joint, 0) << role;
        EXPECT_EQ(after.rest.joints[std::size_t(joint)].name,
                  before.rest.joints[std::size_t(joints.front())].name);
    }
    EXPECT_EQ(after.roles.family, osgSkin::kStatedByFile);
    const std::vector<std::string> morphs = after.morphs();
    for (const char* name : {"happy", "blink", "aa", "smirk", "smile"})
        EXPECT_EQ(std::count(morphs.begin(), morphs.end(), name), 1) << name;
    const SpringSettings &was = osgSkin::find<osgSkin::SpringBones>(*before.root)->getSettings(),
                         &is = osgSkin::find<osgSkin::SpringBones>(*after.root)->getSettings();
    ASSERT_EQ(is.chains.size(), was.chains.size());
    ASSERT_EQ(is.colliders.size(), was.colliders.size());
    for (std::size_t c = 0; c < was.colliders.size(); ++c) {
        EXPECT_EQ(is.colliders[c].joint, was.colliders[c].joint);
        EXPECT_LE(glm::distance(is.colliders[c].start, was.colliders[c].start), 1e-6);
        EXPECT_LE(glm::distance(is.colliders[c].end, was.colliders[c].end), 1e-6);
        EXPECT_NEAR(is.colliders[c].radius, was.colliders[c].radius, 1e-6);
    }
    for (std::size_t c = 0; c < was.chains.size(); ++c) {
        EXPECT_EQ(is.chains[c].colliders, was.chains[c].colliders);
        EXPECT_EQ(is.chains[c].centre, was.chains[c].centre);
        ASSERT_EQ(is.chains[c].joints.size(), was.chains[c].joints.size());
        for (std::size_t j = 0; j < was.chains[c].joints.size(); ++j) {
            const SpringSettings::Joint &to = is.chains[c].joints[j],
                                        &from = was.chains[c].joints[j];
            EXPECT_EQ(to.name, from.name);
            EXPECT_LE(glm::distance(to.tip, from.tip), 1e-6);
            EXPECT_LE(glm::distance(to.gravity, from.gravity), 1e-6);
            for (const double SpringSettings::Joint::*number :
                 {&SpringSettings::Joint::stiffness, &SpringSettings::Joint::drag,
                  &SpringSettings::Joint::radius})
                EXPECT_NEAR(to.*number, from.*number, 1e-6);
        }
    }
}

TEST(RiggedVrm, TranslatesVrm0AndClaimsNoOtherLicence) {
    const std::string folder = test::makeTestFolder();
    VrmFigure figure;
    json bones = json::array();
    for (const auto& [name, node] : figure.bones) bones.push_back({{"bone", name}, {"node", node}});
    figure.json["extensionsUsed"] = {"VRM"};
    figure.json["extensions"] = {
        {"VRM",
         {{"meta",
           {{"title", "figure"},
            {"author", "a test"},
            {"allowedUserName", "Everyone"},
            {"commercialUssageName", "Disallow"},
            {"licenseName", "CC_BY"}}},
          {"humanoid", {{"humanBones", bones}}},
          {"materialProperties", {{{"shader", "VRM/MToon"}}}},
          {"blendShapeMaster",
           {{"blendShapeGroups",
             {{{"presetName", "joy"},
               {"name", "Joy"},
               {"isBinary", true},
               {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 100}}}}},
              {{"presetName", "unknown"},
               {"name", "smirk"},
               {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 50}}}}}}}}}}}};
    const std::string translated = rig(figure, folder);
    test::expectContains(translated, "left out: toon shading (MToon)");
    test::expectContains(translated,
                         "VRM 0 is written as VRM 1: its permissions, the licence \"CC_BY\" as "
                         "https://creativecommons.org/licenses/by/4.0/, and the names");
    const json vrm = GltfReference(folder + "/rigged.vrm").json["extensions"]["VRMC_vrm"];
    EXPECT_EQ(vrm["meta"]["authors"], json({"a test"}));
    EXPECT_EQ(vrm["meta"]["avatarPermission"], "everyone");
    EXPECT_EQ(vrm["meta"]["commercialUsage"], "personalNonProfit");
    EXPECT_EQ(vrm["meta"].count("allowRedistribution"), 0u);
    EXPECT_EQ(vrm["expressions"]["preset"]["happy"]["isBinary"], true);
    EXPECT_EQ(vrm["expressions"]["custom"]["smirk"]["morphTargetBinds"].size(), 1u);
    EXPECT_EQ(vrm["humanoid"]["humanBones"].size(), figure.bones.size());

    figure.json["extensions"]["VRM"]["meta"]["licenseName"] = "Redistribution_Prohibited";
    const std::string said = rig(figure, folder);
    test::expectContains(said, "not written as VRM, as the file lacks a licence's address");
    test::expectContains(said, "left out: which joint is which part of the body, which morph");
    test::expectContains(said, "toon shading (MToon)");
    EXPECT_EQ(GltfReference(folder + "/rigged.vrm").json.count("extensions"), 0u);
}

TEST(RiggedVrm, SaysWhichJointsAreMissing) {
    const std::string folder = test::makeTestFolder();
    test::GltfColumn column;
    column.json["extensions"]["VRMC_vrm"] = {{"meta", VrmFigure().vrm()["meta"]}};
    column.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]["hips"]["node"] = 0;
    const auto baked = runBake("'" + column.save("column.vrm") + "' --rigged rigged.vrm", folder);
    test::expectContains(baked.err, "column.vrm: not written as VRM, as the file lacks ");
    test::expectContains(baked.err, ", head, leftUpperLeg, leftLowerLeg, leftFoot, rightUpperLeg");
    EXPECT_EQ(baked.err.find("licence"), std::string::npos) << baked.err;
}
