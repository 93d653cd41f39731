// SPDX-License-Identifier: MIT
// The choice of a file's clips, and their times.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using osgSkin::importMotion;
using osgSkin::Motion;
using test::GltfColumn;

constexpr double kDegree = 3.14159265358979 / 180.0;

/// The middle joint's rotation about x in a sample, in degrees.
double angleAt(const Motion& motion, std::size_t frame) {
    const int joint = motion.skeleton.find("middle");
    EXPECT_GE(joint, 0);
    const glm::dquat q = motion.rotation(frame, std::size_t(joint));
    return 2.0 * std::atan2(q.x, q.w) / kDegree;
}

Motion sampled(const std::vector<double>& times, const std::vector<double>& degrees,
               const std::string& file) {
    GltfColumn column;
    column.animate("walk", column.joints[1], "rotation", times, GltfColumn::turns(degrees));
    // A shorter track of another joint.
    column.animate("walk", column.joints[2], "rotation", {times.front(), times.back()},
                   GltfColumn::turns({0, 10}));
    return importMotion(column.save(file));
}

TEST(VrmAnimation, NamesJointsAfterHumanBones) {
    GltfColumn column;
    column.bend();
    column.json["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"] = {
        {"hips", {{"node", column.joints[0]}}}, {"leftUpperLeg", {{"node", column.joints[1]}}}};
    const Motion motion = importMotion(column.save("column.vrma"));
    EXPECT_EQ(motion.skeleton.joints[0].name, "hips");
    EXPECT_EQ(motion.skeleton.joints[1].name, "leftUpperLeg");
    EXPECT_EQ(motion.skeleton.joints[2].name, "top");
}

std::size_t nearestSample(const Motion& motion, double seconds) {
    return std::size_t(std::lround(seconds / motion.frameTime));
}

} // namespace

TEST(ClipSampling, SamplesSparseKeysAt30Hz) {
    const Motion motion = sampled({0.0, 1.0, 2.0}, {0, 50, 20}, "few_keys.gltf");
    EXPECT_EQ(motion.frames, 61u);
    EXPECT_NEAR(motion.frameTime, 1.0 / 30.0, 1e-6);
    for (std::size_t f = 0; f <= 60; ++f)
        EXPECT_NEAR(angleAt(motion, f), f < 30 ? 50.0 * double(f) / 30.0 : 50.0 - double(f - 30),
                    1e-3);
}

TEST(ClipSampling, PutsASampleOnEveryKey) {
    for (const double rate : {24.0, 25.0, 29.97, 60.0, 100.0}) {
        SCOPED_TRACE(rate);
        std::vector<double> times, degrees;
        for (int k = 0; k <= 20; ++k) {
            if (k % 7 == 3) continue; // exporters leave keys out
            times.push_back(k / rate);
            degrees.push_back(k % 2 == 0 ? 0.0 : 40.0);
        }
        const Motion motion = sampled(times, degrees, "rate.gltf");
        EXPECT_GE(1.0 / motion.frameTime, 29.9);
        for (std::size_t k = 0; k < times.size(); ++k) {
            const std::size_t sample = nearestSample(motion, times[k]);
            ASSERT_LT(sample, motion.frames);
            EXPECT_NEAR(double(sample) * motion.frameTime, times[k], 1e-4);
            EXPECT_NEAR(angleAt(motion, sample), degrees[k], 1e-3) << "key " << k;
        }
    }
}

TEST(ClipSampling, KeepsPosesOfUnevenKeys) {
    const std::vector<double> times{0.0, 0.0531, 0.371, 0.4013, 1.0077, 1.7};
    const std::vector<double> degrees{0, 45, -20, 30, 60, 0};
    const Motion motion = sampled(times, degrees, "uneven_keys.gltf");
    for (std::size_t k = 0; k < times.size(); ++k) {
        const std::size_t sample = nearestSample(motion, times[k]);
        EXPECT_NEAR(double(sample) * motion.frameTime, times[k], 0.5 / 120.0 + 1e-6);
        EXPECT_NEAR(angleAt(motion, sample), degrees[k], 1e-3) << "key " << k;
    }
}

TEST(ClipSampling, SingleKeyGivesSingleSample) {
    GltfColumn column;
    column.animate("pose", column.joints[1], "rotation", {0.5}, GltfColumn::turns({30}));
    const Motion motion = importMotion(column.save("one_key.gltf"));
    EXPECT_EQ(motion.frames, 1u);
    EXPECT_NEAR(angleAt(motion, 0), 30.0, 1e-3);
}

TEST(ClipChoice, FindsClipByNameOrNumber) {
    GltfColumn column;
    const char* const names[] = {"idle", "Armature|walk", "2", "Armature|run", "Other|run"};
    for (int n = 0; n < 5; ++n)
        column.animate(names[n], column.joints[1], "rotation", {0.0, 1.0},
                       GltfColumn::turns({10.0 * n, 10.0 * n}));
    const std::string file = column.save("clips.gltf");
    EXPECT_NEAR(angleAt(importMotion(file), 0), 0.0, 1e-3);
    EXPECT_EQ(importMotion(file).name, "clips");
    EXPECT_NEAR(angleAt(importMotion(file, 0, "Armature|walk"), 0), 10.0, 1e-3);
    EXPECT_NEAR(angleAt(importMotion(file, 0, "walk"), 0), 10.0, 1e-3);
    EXPECT_EQ(importMotion(file, 0, "walk").name, "Armature|walk");
    EXPECT_NEAR(angleAt(importMotion(file, 0, "1"), 0), 10.0, 1e-3);
    EXPECT_NEAR(angleAt(importMotion(file, 0, "3"), 0), 30.0, 1e-3);
    EXPECT_NEAR(angleAt(importMotion(file, 0, "2"), 0), 20.0, 1e-3); // a name takes precedence
    expectError([&] { importMotion(file, 0, "jump"); },
                R"(no clip "jump", expected one of 0 "idle", 1 "Armature|walk", 2 "2", 3)");
    expectError([&] { importMotion(file, 0, "run"); }, R"(several clips "run")");
    expectError([&] { importMotion(file, 0, "5"); }, R"(no clip "5")");
    expectError([&] { importMotion(file, 0, "-1"); }, R"(no clip "-1")");
    const std::string bvh = testData("bvh/two_joints.bvh");
    EXPECT_EQ(importMotion(bvh, 0, "0").frames, importMotion(bvh).frames);
    expectError([&] { importMotion(bvh, 0, "run"); }, R"(expected one of 0 "two_joints")");
}

TEST(ClipSampling, TakesBoneLengthsFromTracks) {
    GltfColumn column;
    column.json.erase("skins");
    column.json["nodes"][column.meshNode] = {{"name", "nothing"}};
    column.bend();
    column.animate("bend", column.joints[0], "rotation", {0.0, 1.0}, GltfColumn::turns({0, 5}));
    for (const std::size_t joint : {column.joints[1], column.joints[2]}) {
        column.json["nodes"][joint].erase("translation");
        column.animate("bend", joint, "translation", {0.0, 1.0}, {0, 1, 0, 0, 1, 0});
    }
    const Motion motion = importMotion(column.save("lengths_in_tracks.gltf"));
    const auto& joints = motion.skeleton.joints;
    ASSERT_EQ(joints.size(), 3u);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(joints[j].centre.y, double(j), 1e-6) << j;
}
