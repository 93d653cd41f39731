// SPDX-License-Identifier: MIT
//
// VRM files and animations, from file to vertex.
#include "DrawnSkin.h"
#include "Notices.h"
#include "VrmFigure.h"

#include <osgSkin/SetMorph>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <string>
#include <vector>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;
using test::VrmFigure;

/// How far a corner of the head has moved from rest, in the file's axes.
osg::Vec3d movedHead(const Character& character, const VrmFigure& figure) {
    const std::uint32_t corner = std::uint32_t(8 * figure.bones.at("head"));
    const osg::Vec3d rest(figure.places[3 * corner], figure.places[3 * corner + 1],
                          figure.places[3 * corner + 2]);
    osg::Vec3d result;
    test::forEachCopy(character, [&](std::uint32_t v, const osg::Vec3d& drawn) {
        if (v == corner) result = drawn - rest;
    });
    return result;
}

/// An animation of one second for the figure, of whatever the caller adds.
struct VrmAnimation : VrmFigure {
    VrmAnimation() {
        const nlohmann::json human = vrm()["humanoid"];
        json["extensions"] = {
            {"VRMC_vrm_animation", {{"specVersion", "1.0"}, {"humanoid", human}}}};
        json["extensionsUsed"] = {"VRMC_vrm_animation"};
        json["scenes"][0]["nodes"] = {bones["hips"]};
        animate("wave", bones["leftUpperArm"], "rotation", {0, 1},
                {0, 0, 0, 1, 0, 0, std::sin(0.5), std::cos(0.5)});
    }

    nlohmann::json& animation() { return json["extensions"]["VRMC_vrm_animation"]; }

    void animateExpression(const std::string& kind, const std::string& name, double last) {
        const std::size_t weight = node({{"name", name}});
        json["scenes"][0]["nodes"].push_back(weight);
        animation()["expressions"][kind][name] = {{"node", weight}};
        animate("wave", weight, "translation", {0, 1}, {0, 0, 0, last, 0, 0});
    }

    /// From straight ahead to the left and up, in degrees.
    void animateGaze(double left, double up) {
        const std::size_t eyes = node({{"name", "lookAt"}});
        json["scenes"][0]["nodes"].push_back(eyes);
        animation()["lookAt"] = {{"node", eyes}};
        const osg::Quat turn = osg::Quat(-osg::DegreesToRadians(up), osg::X_AXIS) *
                               osg::Quat(osg::DegreesToRadians(left), osg::Y_AXIS);
        animate("wave", eyes, "rotation", {0, 1},
                {0, 0, 0, 1, turn.x(), turn.y(), turn.z(), turn.w()});
    }
};

/// Loads the figure with an animation as its only motion.
Character animated(VrmFigure& figure, VrmAnimation& animation) {
    osgSkin::LoadOptions options;
    options.motion = animation.save("wave.vrma");
    return loadCharacter(figure.save("figure.vrm"), options);
}

} // namespace

TEST(Vrm, ExpressionsAreBinaryAndOverrideOthers) {
    VrmFigure figure;
    figure.addExpressions();
    Character character = loadCharacter(figure.save("figure.vrm"));
    const std::string saved = testing::TempDir() + "figure.osgb";
    ASSERT_TRUE(osgDB::writeNodeFile(*character.root, saved));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(saved);
    ASSERT_TRUE(read.valid());
    struct Case {
        std::vector<std::pair<const char*, float>> weights;
        osg::Vec3d moved; ///< in units of the targets
    };
    for (const Case& c : std::vector<Case>{{{{"happy", 0.3f}, {"blink", 1}}, {0, 1, 0}},
                                           {{{"happy", 0.6f}, {"blink", 1}}, {1, 0, 0}},
                                           {{{"blink", 0.4f}, {"aa", 0.6f}}, {0, 0.4, 0.6}},
                                           {{{"smirk", 0.5f}, {"aa", 0.6f}}, {0.25, 0, 0.3}},
                                           {{{"smirk", 1}, {"aa", 0.6f}}, {0.5, 0, 0}}}) {
        for (const char* name : {"happy", "blink", "aa", "smirk"}) {
            character.setMorph(name, 0.0f);
            osgSkin::setMorph(*read, name, 0.0f);
        }
        for (const auto& [name, weight] : c.weights) {
            EXPECT_TRUE(character.setMorph(name, weight));
            EXPECT_TRUE(osgSkin::setMorph(*read, name, weight));
            EXPECT_EQ(osgSkin::getMorph(*character.root, name), weight) << "stays as it was set";
        }
        const osg::Vec3d moved = movedHead(character, figure);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(moved[axis], 0.01 * (axis + 1) * c.moved[axis], 1e-6)
                << c.weights[0].first << ' ' << c.weights[0].second << ", axis " << axis;
        for (const osgSkin::DeformableSkin* skin : osgSkin::morphSkins(*read))
            for (const osgSkin::DeformableSkin* own : osgSkin::morphSkins(*character.root))
                if (own->shownMorphWeights().size() == skin->shownMorphWeights().size()) {
                    EXPECT_EQ(skin->shownMorphWeights(), own->shownMorphWeights()) << "when saved";
                }
    }
}

TEST(Vrm, AnimationsMoveExpressionsAndEyes) {
    VrmFigure figure;
    figure.addExpressions();
    VrmAnimation animation;
    animation.animateExpression("preset", "aa", 1.0);
    animation.animateExpression("custom", "smirk", 0.5);
    animation.animateExpression("custom", "wink2", 1.0);
    animation.animateGaze(45.0, 27.0);
    const test::Notices notices;
    Character character = animated(figure, animation);
    EXPECT_TRUE(notices.say("1 expressions move no morph target of the body, \"wink2\" among them"))
        << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    ASSERT_EQ(character.motions.size(), 1u);
    const osgSkin::CharacterMotion& motion = character.motions[0];
    ASSERT_EQ(motion.clip.frames, 31u);
    for (const std::size_t frame : {0, 15, 30}) {
        const double share = double(frame) / 30.0;
        for (const bool isSampled : {true, false}) {
            if (isSampled)
                character.pose(motion, frame);
            else
                character.poseAt(motion, share);
            const osg::Vec3d moved = movedHead(character, figure);
            EXPECT_NEAR(moved.x(), 0.0025 * share, 1e-6);
            EXPECT_NEAR(moved.y(), 0.0, 1e-6) << "the arm moves alone";
            EXPECT_NEAR(moved.z(), 0.03 * share * (1.0 - 0.5 * share), 1e-6)
                << "by smirk's override";
            EXPECT_NEAR(double(osgSkin::getMorph(*character.root, "aa")), share, 1e-5);
            EXPECT_NEAR(double(osgSkin::getMorph(*character.root, "smirk")), 0.5 * share, 1e-5);
            for (const char* eye : {"leftEye", "rightEye"}) {
                const osg::Vec3d ahead = osg::Matrixd::transform3x3(
                    osg::Z_AXIS, osg::Matrixd(character.bone(eye)->getMatrixInSkeletonSpace()));
                // A ninth of the gaze.
                EXPECT_NEAR(osg::RadiansToDegrees(std::atan2(ahead.x(), ahead.z())), 5.0 * share,
                            0.1);
                EXPECT_NEAR(osg::RadiansToDegrees(std::asin(ahead.y())), 3.0 * share, 0.1);
            }
        }
    }
}

TEST(Vrm, AnimationsOfAFaceAlonePlay) {
    VrmFigure figure;
    figure.addExpressions();
    VrmAnimation blinks, looks;
    blinks.json.erase("animations");
    blinks.animateExpression("preset", "blink", 1.0);
    looks.animateGaze(0.0, 20.0);
    osgSkin::LoadOptions options;
    options.motion = blinks.save("blinks.vrma");
    options.moreMotions = {looks.save("looks.vrma")};
    for (const char* eye : {"leftEye", "rightEye"})
        figure.vrm()["humanoid"]["humanBones"].erase(eye);
    const test::Notices notices;
    Character character = loadCharacter(figure.save("figure.vrm"), options);
    EXPECT_TRUE(
        notices.say("expressions move no morph target of the body, \"lookDown\" among them"))
        << notices.text();
    character.pose(character.motions.at(0), 30);
    EXPECT_NEAR(movedHead(character, figure).y(), 0.02, 1e-6);
    character.pose(character.motions.at(1), 0);
    EXPECT_EQ(osgSkin::getMorph(*character.root, "blink"), 0.0f) << "of the other motion";
}

TEST(Vrm, ExpressionsMayHaveNamesOfTheGaze) {
    VrmFigure figure;
    figure.addExpressions();
    VrmAnimation named, both;
    named.animateExpression("custom", "lookUp", 1.0);
    both.animateExpression("custom", "lookUp", 1.0);
    both.animateGaze(0.0, 27.0);
    const test::Notices notices;
    EXPECT_EQ(animated(figure, named).motions.size(), 1u);
    EXPECT_TRUE(notices.say("1 expressions move no morph target of the body, \"lookUp\""))
        << notices.text();
    Character character = animated(figure, both);
    character.pose(character.motions.at(0), 30);
    const osg::Vec3d ahead = osg::Matrixd::transform3x3(
        osg::Z_AXIS, osg::Matrixd(character.bone("leftEye")->getMatrixInSkeletonSpace()));
    EXPECT_NEAR(osg::RadiansToDegrees(std::asin(ahead.y())), 3.0, 0.1);
}
