// SPDX-License-Identifier: MIT
#include "GltfBuilder.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/BoneReader>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSprings>
#include <osgSkinMotion/SpringBones>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace {

using nlohmann::json;
using osgSkin::importSprings;
using osgSkin::SpringSettings;

constexpr double kTolerance = 1e-6;

void expectNear(const glm::dvec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::length(found - expected), kTolerance)
        << found.x << ' ' << found.y << ' ' << found.z;
}

/// "base" stands still, "middle" and "top" swing. "end" is a node without skin above "top".
struct HairColumn : test::GltfColumn {
    std::size_t end = 0;

    HairColumn() {
        end = node({{"name", "end"}, {"translation", {0, 1, 0.5}}});
        json["nodes"][2]["children"] = {end};
    }

    void addFirst() {
        json["extensions"]["VRM"]["secondaryAnimation"] = {
            {"boneGroups",
             {{{"stiffiness", 2.5},
               {"gravityPower", 0.5},
               {"gravityDir", {{"x", 0}, {"y", 0}, {"z", -1}}},
               {"dragForce", 0.3},
               {"center", 0},
               {"hitRadius", 0.05},
               {"bones", {1}},
               {"colliderGroups", {0}}}}},
            {"colliderGroups",
             {{{"node", 0},
               {"colliders",
                {{{"offset", {{"x", 0.1}, {"y", 0.2}, {"z", 0.3}}}, {"radius", 0.4}}}}}}}};
    }

    void addSecond() {
        json["extensions"]["VRMC_springBone"] = {
            {"specVersion", "1.0"},
            {"colliders",
             {{{"node", 0},
               {"shape", {{"sphere", {{"offset", {0.1, 0.2, 0.3}}, {"radius", 0.4}}}}}},
              {{"node", end},
               {"shape",
                {{"capsule", {{"offset", {0, 0, 0}}, {"radius", 0.1}, {"tail", {0, 0, 1}}}}}}}}},
            {"colliderGroups", {{{"colliders", {0}}}, {{"colliders", {1}}}}},
            {"springs",
             {{{"center", 0},
               {"colliderGroups", {1, 0}},
               {"joints",
                {{{"node", 1},
                  {"stiffness", 2.5},
                  {"gravityPower", 0.5},
                  {"gravityDir", {0, 0, 1}},
                  {"dragForce", 0.3},
                  {"hitRadius", 0.05}},
                 {{"node", 2}},
                 {{"node", end}}}}}}}};
    }
};

void expectNumbers(const SpringSettings::Joint& joint) {
    EXPECT_NEAR(joint.stiffness, 2.5, kTolerance);
    EXPECT_NEAR(joint.drag, 0.3, kTolerance);
    EXPECT_NEAR(joint.radius, 0.05, kTolerance);
    expectNear(joint.gravity, {0, 0, 0.5}); // VRM 0 has Unity's z
}

TEST(GltfSprings, ReadsVrm0) {
    HairColumn hair;
    hair.addFirst();
    const test::Notices notices;
    const SpringSettings springs = importSprings(hair.save("hair0.vrm"));
    EXPECT_EQ(notices.text(), "");
    ASSERT_EQ(springs.chains.size(), 1u);
    const SpringSettings::Chain& chain = springs.chains[0];
    EXPECT_EQ(chain.centre, "base");
    ASSERT_EQ(chain.joints.size(), 2u);
    EXPECT_EQ(chain.joints[0].name, "middle");
    expectNear(chain.joints[0].tip, {0, 2, 0});
    EXPECT_EQ(chain.joints[1].name, "top");
    expectNear(chain.joints[1].tip, {0, 3, 0.5});
    expectNumbers(chain.joints[0]);
    expectNumbers(chain.joints[1]);
    ASSERT_EQ(chain.colliders.size(), 1u);
    const SpringSettings::Collider& collider = springs.colliders.at(chain.colliders[0]);
    EXPECT_EQ(collider.joint, "base");
    expectNear(collider.start, {0.1, 0.2, -0.3});
    expectNear(collider.end, {0.1, 0.2, -0.3});
    EXPECT_NEAR(collider.radius, 0.4, kTolerance);
}

TEST(GltfSprings, GivesLastBonesOfVrm0SevenCentimetres) {
    HairColumn hair;
    hair.json["nodes"][2].erase("children");
    hair.addFirst();
    const SpringSettings springs = importSprings(hair.save("hair_without_end.vrm"));
    expectNear(springs.chains.at(0).joints.at(1).tip, {0, 2.07, 0});
}

TEST(GltfSprings, ReadsVrm1) {
    HairColumn hair;
    hair.addSecond();
    const test::Notices notices;
    const SpringSettings springs = importSprings(hair.save("hair1.vrm"));
    EXPECT_EQ(notices.text(), "");
    ASSERT_EQ(springs.chains.size(), 1u);
    const SpringSettings::Chain& chain = springs.chains[0];
    EXPECT_EQ(chain.centre, "base");
    ASSERT_EQ(chain.joints.size(), 2u);
    EXPECT_EQ(chain.joints[0].name, "middle");
    expectNear(chain.joints[0].tip, {0, 2, 0});
    expectNumbers(chain.joints[0]);
    EXPECT_EQ(chain.joints[1].name, "top");
    expectNear(chain.joints[1].tip, {0, 3, 0.5});
    EXPECT_EQ(chain.joints[1].stiffness, 1.0); // the schema's own
    EXPECT_EQ(chain.joints[1].drag, 0.5);
    EXPECT_EQ(chain.joints[1].radius, 0.0);
    expectNear(chain.joints[1].gravity, {0, 0, 0});
    ASSERT_EQ(chain.colliders.size(), 2u);
    const SpringSettings::Collider& capsule = springs.colliders.at(chain.colliders[0]);
    EXPECT_EQ(capsule.joint, "top"); // the joint above a node that moves no skin
    expectNear(capsule.start, {0, 3, 0.5});
    expectNear(capsule.end, {0, 3, 1.5});
    const SpringSettings::Collider& sphere = springs.colliders.at(chain.colliders[1]);
    EXPECT_EQ(sphere.joint, "base");
    expectNear(sphere.start, {0.1, 0.2, 0.3});
    expectNear(sphere.end, sphere.start);
    EXPECT_NEAR(sphere.radius, 0.4, kTolerance);
}

TEST(GltfSprings, ReadsExtendedColliders) {
    HairColumn hair;
    hair.addSecond();
    json& colliders = hair.json["extensions"]["VRMC_springBone"]["colliders"];
    const auto extend = [](json& collider, const json& shape) {
        collider["shape"] = {{"sphere", {{"offset", {0, -10000, 0}}, {"radius", 0}}}};
        collider["extensions"]["VRMC_springBone_extended_collider"] = {{"specVersion", "1.0"},
                                                                       {"shape", shape}};
    };
    extend(colliders[0], {{"plane", {{"offset", {0, 0.5, 0}}, {"normal", {0, 0, 2}}}}});
    extend(colliders[1],
           {{"capsule",
             {{"offset", {0, 0, 0}}, {"radius", 0.1}, {"tail", {0, 0, 1}}, {"inside", true}}}});
    const test::Notices notices;
    const SpringSettings springs = importSprings(hair.save("extended.vrm"));
    EXPECT_EQ(notices.text(), "");
    const SpringSettings::Collider& capsule = springs.colliders.at(1);
    EXPECT_NEAR(capsule.radius, -0.1, kTolerance);
    expectNear(capsule.end - capsule.start, {0, 0, 1});
    const SpringSettings::Collider& plane = springs.colliders.at(0);
    EXPECT_EQ(plane.joint, "base");
    for (const glm::dvec3& on : {glm::dvec3(0, 0.5, 0), {0.5, 0, 0}, {-0.3, 1, 0}})
        EXPECT_NEAR(glm::length(on - plane.start), plane.radius, 1e-5);
    EXPECT_GT(glm::length(glm::dvec3(0, 0, 1) - plane.start), plane.radius + 0.9);
}

TEST(GltfSprings, AreNoneInOtherFiles) {
    EXPECT_TRUE(importSprings(HairColumn().save("bald.vrm")).chains.empty());
    EXPECT_TRUE(importSprings("missing.obj").chains.empty());
}

TEST(GltfSprings, LeavesOutWhatNamesNoNode) {
    for (const auto& [name, change] :
         std::initializer_list<std::pair<const char*, std::function<void(json&)>>>{
             {"joint", [](json& springs) { springs["springs"][0]["joints"][0]["node"] = 99; }},
             {"text", [](json& springs) { springs["springs"][0]["joints"][0]["node"] = "middle"; }},
             {"collider", [](json& springs) { springs["colliders"][0]["node"] = -1; }},
             {"shape", [](json& springs) { springs["colliders"][0].erase("shape"); }}}) {
        HairColumn hair;
        hair.addSecond();
        change(hair.json["extensions"]["VRMC_springBone"]);
        const test::Notices notices;
        const SpringSettings springs =
            importSprings(hair.save(std::string("bad_") + name + ".vrm"));
        EXPECT_TRUE(notices.say("1 joints or colliders of springs name no node, or have no shape; "
                                "ignored"))
            << name << ": " << notices.text();
        EXPECT_GE(springs.chains.at(0).joints.size(), 1u) << name;
    }
}

TEST(GltfSprings, RefusesGroupsBeyondTheFilesSize) {
    HairColumn hair;
    hair.addFirst();
    json& springs = hair.json["extensions"]["VRM"]["secondaryAnimation"];
    for (json* list : {&springs["boneGroups"][0]["colliderGroups"],
                       &springs["colliderGroups"][0]["colliders"]}) {
        const json first = (*list)[0];
        for (int i = 0; i < 500; ++i) list->push_back(first);
    }
    try {
        importSprings(hair.save("many_colliders.vrm"));
        FAIL();
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("maxSamples"), std::string::npos) << error.what();
    }
}

TEST(GltfSprings, SwingTheBonesOfTheFile) {
    for (const bool second : {false, true}) {
        HairColumn hair;
        second ? hair.addSecond() : hair.addFirst();
        json& from = hair.json["extensions"];
        (second ? from["VRMC_springBone"]["springs"]
                : from["VRM"]["secondaryAnimation"]["boneGroups"])[0]
            .erase("center");
        const std::string file = hair.save("swings.vrm");
        const osgSkin::ImportedRig rig = osgSkin::importRig(file);
        const osg::ref_ptr<osg::MatrixTransform> root = new osg::MatrixTransform;
        root->addChild(rig.skeleton);
        const osg::ref_ptr<osgSkin::SpringBones> springs =
            new osgSkin::SpringBones(importSprings(file), rig.toWorld);
        osgSkin::attach(*rig.skeleton, *springs);
        double least = 1.0, last = 0.0;
        for (int i = 0; i < 240; ++i) {
            root->setMatrix(osg::Matrixd::translate(std::min(i, 60) * 0.08, 0, 0));
            test::updateAt(*root, i / 60.0);
            const auto bones = osgSkin::bonesOf(*rig.skeleton);
            osg::Vec3d bone = bones.at("top")->getMatrixInSkeletonSpace().getTrans() -
                              bones.at("middle")->getMatrixInSkeletonSpace().getTrans();
            EXPECT_NEAR(bone.length(), 1.0, 1e-6);
            last = bone.x();
            least = std::min(least, last);
        }
        EXPECT_LT(least, -0.1) << second; // lags behind a move along x
        EXPECT_NEAR(last, 0.0, 0.02) << second;
    }
}

} // namespace
