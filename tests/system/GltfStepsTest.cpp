// SPDX-License-Identifier: MIT
// Clips with jumps: glTF's step interpolation, and keys with equal times.
#include "GltfBuilder.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportMotion>

#include <gtest/gtest.h>
#include <osgAnimation/BoneMapVisitor>

#include <cmath>
#include <string>
#include <vector>

namespace {

using osgSkin::Character;
using test::GltfColumn;

constexpr double kRate = 30.0;

/// Angle of a rotation about x, 0 to 180 degrees.
double degreesOf(double sine, double cosine) {
    return 2.0 * std::atan2(std::abs(sine), std::abs(cosine)) * 180.0 / std::acos(-1.0);
}

/// Rotation of the column's middle.
double turnAt(Character& character, double time) {
    character.poseAt(character.motions.at(0), time);
    osgAnimation::BoneMapVisitor bones;
    character.skeleton->accept(bones);
    const osg::Matrixd matrix = bones.getBoneMap().at("middle")->getMatrix();
    const osg::Quat turn = matrix.getRotate();
    return degreesOf(turn.x(), turn.w());
}

/// A pose for every frame of two seconds, each different from its neighbours.
std::vector<double> angles() {
    std::vector<double> result;
    for (int k = 0; k <= 60; ++k) result.push_back(k * 37 % 90);
    return result;
}

/// A file whose middle has angles(), with step interpolation; its times are floats, as all numbers
/// in glTF.
std::string saveSteps(const std::string& name, double first) {
    GltfColumn column;
    std::vector<double> times;
    for (std::size_t k = 0; k < angles().size(); ++k)
        times.push_back(double(float(first + double(k) / kRate)));
    column.animate("steps", column.joints[1], "rotation", times, GltfColumn::turns(angles()),
                   "STEP");
    return column.save(name);
}

} // namespace

TEST(GltfSteps, DoNotBlendBetweenKeys) {
    for (const double first : {0.0, 100.0}) {
        Character character = osgSkin::loadCharacter(saveSteps("steps.gltf", first));
        for (std::size_t k = 0; k < angles().size(); ++k)
            EXPECT_NEAR(turnAt(character, double(k) / kRate), angles()[k], 0.01)
                << first << " " << k;
        EXPECT_NEAR(character.motions.at(0).duration(), 2.0, 1e-5) << first;
    }
}

TEST(GltfSteps, SampledMotionsHaveTheKeyOfTheirTime) {
    const osgSkin::Motion motion = osgSkin::importMotion(saveSteps("step_motion.gltf", 0.0));
    ASSERT_EQ(motion.frames, angles().size());
    for (std::size_t k = 0; k < motion.frames; ++k) {
        const glm::dquat turn = motion.rotation(k, 1);
        EXPECT_NEAR(degreesOf(turn.x, turn.w), angles()[k], 0.01) << k;
    }
}

TEST(GltfSteps, KeysAtOneTimeAreAJump) {
    GltfColumn column;
    column.animate("jump", column.joints[1], "rotation", {0.0, 0.0, 0.5, 0.5, 0.5, 1.0, 1.0},
                   GltfColumn::turns({70, 10, 10, 80, 40, 40, 20}));
    Character character = osgSkin::loadCharacter(column.save("jump.gltf"));
    for (const double time : {0.0, 0.2, 0.4, 0.499})
        EXPECT_NEAR(turnAt(character, time), 10.0, 0.01) << time;
    for (const double time : {0.5, 0.6, 0.8, 0.999})
        EXPECT_NEAR(turnAt(character, time), 40.0, 0.01) << time;
}

/// As in osgAnimation.
TEST(GltfSteps, SetDurationStretchesClips) {
    GltfColumn column;
    column.bend();
    Character character = osgSkin::loadCharacter(column.save("slow.gltf"));
    osgAnimation::Animation& clip = *character.motions.at(0).animation;
    for (const double duration : {1.0, 4.0, 0.25}) {
        clip.setDuration(duration);
        EXPECT_NEAR(turnAt(character, 0.5 * duration), 60.0, 0.01) << duration;
        EXPECT_NEAR(turnAt(character, duration), 90.0, 0.01) << duration;
    }
}
