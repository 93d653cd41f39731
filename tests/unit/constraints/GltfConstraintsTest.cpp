// SPDX-License-Identifier: MIT
#include "ConstrainedRig.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportConstraints>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/RotateBone>
#include <osgSkinRig/MakeSkeleton>

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using osgSkin::Character;
using osgSkin::Constraints;
using osgSkin::find;
using osgSkin::importConstraints;
using test::ConstrainedRig;
using List = std::vector<test::NodeConstraint>;

constexpr double kTolerance = 1e-5;

/// Constraints in the order in which they are to be evaluated.
const std::vector<std::pair<const char*, List>> kCases{
    {"roll", {{"twist", "hand", "roll", "Y", 0.5}}},
    {"roll_about_x", {{"twist", "lower", "roll", "X", 1.0}}},
    {"roll_about_z", {{"copy", "upper", "roll", "Z", 0.3}}},
    {"aim", {{"sleeve", "lower", "aim", "PositiveX", 1.0}}},
    {"aim_backwards", {{"sleeve", "hand", "aim", "NegativeY", 0.6}}},
    {"aim_along_z", {{"copy", "hand", "aim", "PositiveZ", 1.0}}},
    {"aim_of_a_child", {{"hand", "copy", "aim", "NegativeX", 0.8}}},
    {"rotation", {{"copy", "upper", "rotation", "", 1.0}}},
    {"part_of_a_rotation", {{"copy", "lower", "rotation", "", 0.25}}},
    {"no_weight", {{"copy", "lower", "rotation", "", 0.0}}},
    {"of_the_root", {{"copy", "root", "rotation", "", 0.7}, {"sleeve", "root", "roll", "Z", 1.0}}},
    {"all_at_once",
     {{"twist", "hand", "roll", "Y", 0.5},
      {"copy", "upper", "rotation", "", 1.0},
      {"sleeve", "lower", "aim", "PositiveX", 1.0}}},
    {"source_is_constrained",
     {{"twist", "hand", "roll", "Y", 0.5},
      {"copy", "twist", "rotation", "", 0.9},
      {"sleeve", "copy", "rotation", "", 0.8}}},
    {"source_comes_later",
     {{"copy", "hand", "rotation", "", 1.0},
      {"sleeve", "copy", "roll", "X", 1.0},
      {"twist", "sleeve", "rotation", "", 0.5}}},
    {"aim_at_what_a_constraint_moves",
     {{"lower", "upper", "rotation", "", 1.0}, {"sleeve", "hand", "aim", "PositiveY", 1.0}}},
    {"aim_below_a_constraint",
     {{"lower", "upper", "roll", "Y", 0.5}, {"twist", "copy", "aim", "PositiveZ", 0.5}}}};

/// How far bones are from the specification's pose in the clip's keys; updates the scene, or poses
/// it without one.
void expectClip(const ConstrainedRig& rig, Character& character, const List& list,
                const char* name) {
    ASSERT_EQ(character.motions.size(), 1u) << name;
    for (int key = 0; key < 3; ++key) {
        const auto expected = rig.expected(key, list);
        character.poseAt(character.motions[0], key);
        EXPECT_LT(rig.error(*character.skeleton, expected), kTolerance) << name << ", key " << key;
        if (key == 2) continue; // the clip's end is its begin
        test::updateAt(*character.root, key);
        EXPECT_LT(rig.error(*character.skeleton, expected), kTolerance) << name << ", at " << key;
    }
}

} // namespace

TEST(GltfConstraints, MatchTheSpecification) {
    for (const auto& [name, list] : kCases)
        for (const unsigned seed : {0u, 1u, 2u}) {
            ConstrainedRig rig(seed);
            const test::Notices notices;
            Character character = osgSkin::loadCharacter(rig.write("constraint.vrm", list));
            EXPECT_FALSE(notices.say("VRMC_node_constraint")) << notices.text();
            expectClip(rig, character, list, name);
            EXPECT_GT(rig.error(*character.skeleton, rig.expected(2, {})), 0.0) << name;
        }
}

TEST(GltfConstraints, MatchWhereTheSkinIsBoundInAnotherPose) {
    for (const auto& [name, list] : kCases) {
        ConstrainedRig rig(5, true);
        Character character = osgSkin::loadCharacter(rig.write("bound.vrm", list));
        expectClip(rig, character, list, name);
    }
}

TEST(GltfConstraints, MatchBelowARotatedAndScaledNode) {
    for (const auto& [name, list] : kCases) {
        ConstrainedRig rig(3);
        rig.write("inside.vrm", list);
        const std::size_t above = rig.node({{"name", "Armature"},
                                            {"children", {0}},
                                            {"rotation", {0.6, 0.0, 0.0, 0.8}},
                                            {"scale", {2, 2, 2}}});
        rig.json["scenes"][0]["nodes"] = {above, above - 1};
        // The skin is bound where the nodes are.
        const glm::dquat turn(0.8, 0.6, 0.0, 0.0);
        Character character = osgSkin::loadCharacter(rig.save("inside.vrm"));
        const auto bones = osgSkin::bonesOf(*character.skeleton);
        for (int key = 0; key < 3; ++key) {
            character.poseAt(character.motions[0], key);
            const auto expected = rig.expected(key, list);
            for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
                const glm::dmat3 found =
                    glm::dmat3(osgSkin::toGlm(
                        osg::Matrixd(bones.at(rig.nodes[n].name)->getMatrixInSkeletonSpace()))) *
                    0.5;
                const glm::dmat3 wanted = glm::mat3_cast(turn * expected[n]);
                for (int c = 0; c < 3; ++c)
                    EXPECT_LT(glm::length(found[c] - wanted[c]), kTolerance)
                        << name << ", " << rig.nodes[n].name;
            }
        }
    }
}

/// A .skin file's skeleton has bones without the nodes' axes.
TEST(GltfConstraints, MatchOnBonesWithOtherAxes) {
    for (const auto& [name, list] : kCases) {
        ConstrainedRig rig(7);
        const std::string file = rig.write("axes.vrm", list);
        const osgSkin::RestSkeleton rest = osgSkin::importSkeleton(file);
        const auto skeleton = osgSkin::makeSkeleton(rest);
        const auto constraints = osgSkin::attach<Constraints>(*skeleton, importConstraints(file));
        const auto bones = osgSkin::bonesOf(*skeleton);
        const auto bind = rig.expected(0, {}), posed = rig.expected(1, {});
        for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
            const int parent = rig.nodes[n].parent;
            glm::dquat turn = posed[n] * glm::inverse(bind[n]);
            if (parent >= 0)
                turn = turn * glm::inverse(posed[std::size_t(parent)] *
                                           glm::inverse(bind[std::size_t(parent)]));
            osgSkin::rotateBone(*bones.at(rig.nodes[n].name), osgSkin::toOsg(turn));
        }
        constraints->apply(*skeleton);
        EXPECT_LT(rig.error(*skeleton, rig.expected(1, list)), kTolerance) << name;
    }
}

TEST(GltfConstraints, ComeWithTheMeshOfASkinFile) {
    ConstrainedRig rig(2);
    const std::string mesh = rig.write("named.vrm", {{"twist", "hand", "roll", "Y", 0.5}});
    const std::string file = testing::TempDir() + "constraints.skin";
    std::ofstream(file) << json{{"osgskin", 1}, {"mesh", mesh}, {"bind", "weights"}};
    Character character = osgSkin::loadCharacter(file);
    const Constraints* const found = find<Constraints>(*character.skeleton);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->get().size(), 1u);
    EXPECT_EQ(found->get()[0].joint.name, "twist");
    EXPECT_EQ(found->get()[0].source.name, "hand");
}

TEST(GltfConstraints, AreNoneInOtherFiles) {
    EXPECT_TRUE(importConstraints(ConstrainedRig(1).write("free.vrm", {})).empty());
    EXPECT_TRUE(importConstraints("missing.obj").empty());
    Character character = osgSkin::loadCharacter(ConstrainedRig(1).write("free.vrm", {}));
    EXPECT_FALSE(find<Constraints>(*character.skeleton));
}

TEST(GltfConstraints, IgnoresCirclesWithANotice) {
    const List circle = {{"twist", "copy", "roll", "Y", 1.0},
                         {"copy", "sleeve", "rotation", "", 1.0},
                         {"sleeve", "twist", "aim", "PositiveX", 1.0},
                         {"hand", "copy", "rotation", "", 0.5}};
    ConstrainedRig rig(1);
    const std::string file = rig.write("circle.vrm", circle);
    const test::Notices notices;
    Character character = osgSkin::loadCharacter(file);
    EXPECT_TRUE(notices.say("3 nodes follow each other in a circle (VRMC_node_constraint), "
                            "\"twist\" among them; ignored"))
        << notices.text();
    expectClip(rig, character, {circle[3]}, "circle");
    ConstrainedRig self(1);
    const test::Notices more;
    EXPECT_TRUE(
        importConstraints(self.write("self.vrm", {{"copy", "copy", "rotation", "", 1.0}})).empty());
    EXPECT_TRUE(more.say("1 nodes follow each other in a circle (VRMC_node_constraint), \"copy\""))
        << more.text();
}

TEST(GltfConstraints, IgnoresWhatIsNotStated) {
    const json source = {{"source", 3}};
    const auto with = [&](const char* member, const json& value) {
        json result = {{"source", 3}, {"rollAxis", "Y"}};
        result[member] = value;
        return json{{"roll", result}};
    };
    for (const json& constraint :
         {json::object(), json{{"roll", source}}, json{{"aim", source}}, json{{"position", source}},
          with("rollAxis", "W"), with("rollAxis", 1), with("source", 99), with("source", -1),
          with("source", "hand"), with("weight", 1.5), with("weight", -0.5)}) {
        ConstrainedRig rig(1);
        rig.write("odd.vrm", {{"copy", "hand", "rotation", "", 1.0}});
        rig.json["nodes"][4]["extensions"]["VRMC_node_constraint"] = {{"specVersion", "1.0"},
                                                                      {"constraint", constraint}};
        const test::Notices notices;
        EXPECT_EQ(importConstraints(rig.save("odd.vrm")).size(), 1u) << constraint;
        EXPECT_TRUE(notices.say("1 constraints (VRMC_node_constraint) lack a source, an axis or a "
                                "weight of 0 to 1; ignored"))
            << constraint << ": " << notices.text();
    }
}

/// All nodes of a long chain follow one: a frame would look at 400,000 nodes.
TEST(GltfConstraints, RefusesMoreThanTheFilesSizeAllows) {
    ConstrainedRig rig(1);
    rig.write("long.vrm", {});
    std::size_t above = rig.indexOf("copy");
    for (int i = 0; i < 900; ++i) {
        json member = {{"name", "link" + std::to_string(i)}};
        member["extensions"]["VRMC_node_constraint"]["constraint"]["rotation"]["source"] = 1;
        rig.json["nodes"][above]["children"].push_back(rig.json["nodes"].size());
        above = rig.node(member);
    }
    try {
        importConstraints(rig.save("long.vrm"));
        FAIL();
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("maxSamples"), std::string::npos) << error.what();
    }
}

TEST(GltfConstraints, RotateRigidParts) {
    ConstrainedRig rig(1);
    const List list = {{"copy", "upper", "rotation", "", 1.0}};
    rig.rigid = "copy";
    rig.write("hat.vrm", list);
    json hat = rig.json["meshes"][0];
    hat["primitives"][0]["attributes"].erase("WEIGHTS_0");
    hat["primitives"][0]["attributes"].erase("JOINTS_0");
    rig.json["nodes"][rig.indexOf("copy")]["mesh"] = 1;
    rig.json["meshes"].push_back(hat);
    Character character = osgSkin::loadCharacter(rig.save("hat.vrm"));
    ASSERT_TRUE(character.bone("copy"));
    character.poseAt(character.motions[0], 1.0);
    const glm::dmat3 found(
        osgSkin::toGlm(osg::Matrixd(character.bone("copy")->getMatrixInSkeletonSpace())));
    const glm::dmat3 wanted = glm::mat3_cast(rig.expected(1, list)[6]);
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(found[c] - wanted[c]), kTolerance);
}
