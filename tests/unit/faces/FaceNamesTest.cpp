// SPDX-License-Identifier: MIT
#include <osgSkinRig/FaceNames>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace {

using osgSkin::FaceMatch;
using osgSkin::faceNames;
using osgSkin::FaceVocabulary;
using osgSkin::matchFace;
using Names = std::vector<std::string>;
using Weights = std::map<std::string, double>; ///< by the first name of a part

const Names& kArKit = faceNames(FaceVocabulary::ArKit);
const Names& kVisemes = faceNames(FaceVocabulary::Visemes);
const Names& kVrm = faceNames(FaceVocabulary::Vrm);

const Names kVrm0 = {"A",        "I",         "U",       "E",       "O",      "Blink",
                     "Joy",      "Angry",     "Sorrow",  "Fun",     "LookUp", "LookDown",
                     "LookLeft", "LookRight", "Blink_L", "Blink_R", "Neutral"};
/// Exported from MakeHuman: units of a face.
// clang-format off
const Names kMakeHuman = {
    "LeftBrowDown", "RightBrowDown", "LeftOuterBrowUp", "RightOuterBrowUp", "LeftInnerBrowUp",
    "RightInnerBrowUp", "NoseWrinkler", "LeftUpperLidOpen", "RightUpperLidOpen",
    "LeftUpperLidClosed", "RightUpperLidClosed", "LeftLowerLidUp", "RightLowerLidUp", "LeftEyeDown",
    "RightEyeDown", "LeftEyeUp", "RightEyeUp", "LeftEyeturnRight", "RightEyeturnRight",
    "LeftEyeturnLeft", "RightEyeturnLeft", "LeftCheekUp", "RightCheekUp", "CheeksPump", "ChinLeft",
    "ChinRight", "ChinForward", "lowerLipUp", "lowerLipDown", "lowerLipBackward", "lowerLipForward",
    "UpperLipUp", "UpperLipBackward", "UpperLipForward", "JawDrop", "LipsKiss", "MouthMoveLeft",
    "MouthMoveRight", "MouthLeftPullUp", "MouthRightPullUp", "MouthLeftPullSide",
    "MouthRightPullSide", "MouthLeftPullDown", "MouthRightPullDown", "TongueOut"};
// clang-format on
const Names kVroid = {
    "Fcl_ALL_Neutral",   "Fcl_ALL_Angry",     "Fcl_ALL_Fun",       "Fcl_ALL_Joy",
    "Fcl_ALL_Sorrow",    "Fcl_ALL_Surprised", "Fcl_BRW_Angry",     "Fcl_BRW_Fun",
    "Fcl_BRW_Joy",       "Fcl_BRW_Sorrow",    "Fcl_BRW_Surprised", "Fcl_EYE_Natural",
    "Fcl_EYE_Angry",     "Fcl_EYE_Close",     "Fcl_EYE_Close_R",   "Fcl_EYE_Close_L",
    "Fcl_EYE_Joy",       "Fcl_EYE_Joy_R",     "Fcl_EYE_Joy_L",     "Fcl_EYE_Surprised",
    "Fcl_EYE_Spread",    "Fcl_MTH_Close",     "Fcl_MTH_Up",        "Fcl_MTH_Angry",
    "Fcl_MTH_Small",     "Fcl_MTH_Fun",       "Fcl_MTH_Joy",       "Fcl_MTH_Sorrow",
    "Fcl_MTH_Surprised", "Fcl_MTH_A",         "Fcl_MTH_I",         "Fcl_MTH_U",
    "Fcl_MTH_E",         "Fcl_MTH_O"};

FaceMatch match(const std::string& name, const Names& morphs) {
    return matchFace({name}, morphs).at(0);
}

Weights weightsOf(const FaceMatch& match) {
    Weights result;
    for (const FaceMatch::Part& part : match.parts) {
        EXPECT_GT(part.weight, 0.0f) << match.name;
        EXPECT_LE(part.weight, 1.0f) << match.name;
        result[part.morphs.at(0)] = double(part.weight);
    }
    return result;
}

void expectWeights(const std::string& name, const Names& morphs, const Weights& expected) {
    const Weights found = weightsOf(match(name, morphs));
    EXPECT_EQ(found.size(), expected.size()) << name;
    for (const auto& [morph, weight] : found) {
        ASSERT_EQ(expected.count(morph), 1u) << name << " moves " << morph;
        EXPECT_NEAR(weight, expected.at(morph), 1e-3) << name << ", " << morph;
    }
}

std::string missing(const Names& names, const Names& morphs) {
    std::string result;
    for (const FaceMatch& match : matchFace(names, morphs))
        if (match.kind == FaceMatch::Kind::None) result += match.name + ' ';
    return result;
}

Names with(const std::string& before, const Names& names) {
    Names result;
    for (const std::string& name : names) result.push_back(before + name);
    return result;
}

} // namespace

TEST(FaceNames, HaveTheNumbersOfTheirSpecifications) {
    EXPECT_EQ(kArKit.size(), 52u);
    EXPECT_EQ(kVisemes.size(), 15u);
    EXPECT_EQ(kVrm.size(), 18u);
}

TEST(FaceNames, MatchThemselvesBehindAnyPrefix) {
    for (const Names* names : {&kArKit, &kVisemes, &kVrm, &kVrm0, &kMakeHuman, &kVroid})
        for (const char* prefix : {"", "blendShape1.", "Wolf3D_Head.", "Face.", "Head:"})
            for (const FaceMatch& match : matchFace(*names, with(prefix, *names))) {
                EXPECT_EQ(match.kind, FaceMatch::Kind::Own) << prefix << match.name;
                EXPECT_EQ(weightsOf(match), (Weights{{prefix + match.name, 1.0}}));
            }
}

TEST(FaceNames, MatchOtherSpellings) {
    const std::vector<std::pair<const char*, Names>> cases{
        {"eyeBlinkLeft",
         {"eyeBlink_L", "EyeBlinkLeft", "eye_blink_left", "EYEBLINKLEFT", "eyeblinkleft",
          "blendShape1.eyeBlink_L", "Face.eyeBlink.L", "leftEyeBlink", "head|Eye Blink L",
          "head_eyeBlinkLeft", "eyeBlinkLeft.001", "M_F00_000_00_eyeBlinkLeft"}},
        {"mouthRight", {"mouth_right", "MouthRight", "Mouth_R", "mouthright"}},
        {"jawOpen", {"jaw_open", "JawOpen", "Wolf3D_Head.jawOpen", "JAW_OPEN", "head_jaw_open"}},
        {"viseme_PP", {"PP", "pp", "v_pp", "vrc.v_pp", "Viseme_pp", "head.viseme_PP"}},
        {"aa", {"AA", "viseme_aa", "vrc.v_aa"}},
        {"Fcl_MTH_A", {"Face.M_F00_000_00_Fcl_MTH_A", "Face_Blendshape.Fcl_MTH_A"}},
        {"blinkLeft", {"Blink_L", "blink_l", "BlinkLeft"}},
        {"mySmirk", {"my_smirk", "Face.MySmirk"}}};
    for (const auto& [name, spellings] : cases)
        for (const std::string& spelling : spellings) {
            const FaceMatch found = match(name, {"other", spelling});
            EXPECT_EQ(found.kind, FaceMatch::Kind::Own) << name << ", " << spelling;
            EXPECT_EQ(weightsOf(found), (Weights{{spelling, 1.0}})) << name;
        }
}

TEST(FaceNames, DoNotMatchWordsThatOnlyEndAlike) {
    EXPECT_EQ(missing({"joy", "blink", "aa"}, {"Fcl_BRW_Joy", "noBlink", "Body_aa", "あa", "笑い"}),
              "joy blink aa ");
    EXPECT_EQ(match("mouthLeft", {"mouth"}).kind, FaceMatch::Kind::None);
    EXPECT_EQ(match("笑い", {"笑い"}).kind, FaceMatch::Kind::Own);
    EXPECT_EQ(match("unheardOf", kArKit).kind, FaceMatch::Kind::None);
}

TEST(FaceNames, PreferExactNamesAndExpressions) {
    const Names morphs = {"teeth.jawOpen", "JawOpen", "jawOpen", "happy.001", "happy"};
    EXPECT_EQ(match("jawOpen", morphs).parts.at(0).morphs,
              (Names{"jawOpen", "JawOpen", "teeth.jawOpen"}));
    EXPECT_EQ(match("joy", morphs).parts.at(0).morphs, (Names{"happy", "happy.001"}));
}

TEST(FaceNames, AreSumsOfArKits) {
    expectWeights("aa", kArKit, {{"jawOpen", 0.7}});
    expectWeights("A", kArKit, {{"jawOpen", 0.7}});
    expectWeights("viseme_aa", kArKit, {{"jawOpen", 0.7}});
    expectWeights("viseme_U", kArKit, {{"jawOpen", 0.15}, {"mouthPucker", 0.8}});
    expectWeights("viseme_PP", kArKit,
                  {{"mouthPressLeft", 0.6},
                   {"mouthPressRight", 0.6},
                   {"mouthRollLower", 0.4},
                   {"mouthRollUpper", 0.4},
                   {"mouthClose", 0.3}});
    expectWeights("blink", kArKit, {{"eyeBlinkLeft", 1}, {"eyeBlinkRight", 1}});
    expectWeights("Fcl_EYE_Close_L", kArKit, {{"eyeBlinkLeft", 1}});
    expectWeights("mouthSmile", kArKit, {{"mouthSmileLeft", 1}, {"mouthSmileRight", 1}});
    expectWeights("eyesClosed", kArKit, {{"eyeBlinkLeft", 1}, {"eyeBlinkRight", 1}});
    expectWeights("JawDrop", kArKit, {{"jawOpen", 1}});
    expectWeights("surprised", kArKit,
                  {{"browInnerUp", 0.8},
                   {"browOuterUpLeft", 0.8},
                   {"browOuterUpRight", 0.8},
                   {"eyeWideLeft", 0.8},
                   {"eyeWideRight", 0.8},
                   {"jawOpen", 0.4}});
}

TEST(FaceNames, OfArKitDriveOtherVocabularies) {
    expectWeights("jawOpen", kVrm, {{"aa", 1}});
    expectWeights("jawOpen", kVisemes, {{"viseme_aa", 1}});
    expectWeights("jawOpen", kVroid, {{"Fcl_MTH_A", 1}});
    expectWeights("jawOpen", kMakeHuman, {{"JawDrop", 1}});
    expectWeights("eyeBlinkLeft", {"eyesClosed", "mouthSmile"}, {{"eyesClosed", 0.5}});
    expectWeights("mouthSmileRight", {"eyesClosed", "mouthSmile"}, {{"mouthSmile", 0.5}});
    expectWeights("browInnerUp", kMakeHuman, {{"LeftInnerBrowUp", 1}, {"RightInnerBrowUp", 1}});
    expectWeights("mouthUpperUpLeft", kMakeHuman, {{"UpperLipUp", 0.5}});
    // A face is not angry because its nose is.
    EXPECT_EQ(match("noseSneerLeft", kVrm).kind, FaceMatch::Kind::None);
    EXPECT_EQ(match("jawOpen", {"surprised"}).kind, FaceMatch::Kind::None);
}

/// All names of each vocabulary drive each other one, but for these.
TEST(FaceNames, OfEachVocabularyDriveEachOther) {
    const std::vector<const Names*> all{&kArKit, &kVisemes, &kVrm, &kVrm0, &kMakeHuman, &kVroid};
    for (const Names* from : {&kVisemes, &kVrm, &kVrm0, &kMakeHuman})
        EXPECT_EQ(missing(*from, kArKit), "");
    EXPECT_EQ(missing(kVroid, kArKit),
              "Fcl_BRW_Fun Fcl_BRW_Joy Fcl_EYE_Joy Fcl_EYE_Joy_R Fcl_EYE_Joy_L Fcl_MTH_Up ");
    EXPECT_EQ(missing(kVisemes, kVrm), "viseme_PP viseme_FF ");
    EXPECT_EQ(missing(kVisemes, kVrm0), "viseme_PP viseme_FF ");
    EXPECT_EQ(missing(kVisemes, kMakeHuman), "");
    EXPECT_EQ(missing(kVrm, kVrm0), "");
    EXPECT_EQ(missing(kVrm0, kVrm), "");
    const std::vector<FaceMatch> onVrm = matchFace(kArKit, kVrm);
    EXPECT_EQ(std::count_if(onVrm.begin(), onVrm.end(),
                            [](const FaceMatch& match) { return !match.parts.empty(); }),
              22);
    EXPECT_EQ(missing(kVrm0, kVroid), "LookUp LookDown LookLeft LookRight ");
    EXPECT_EQ(missing(kVrm, kMakeHuman), "");
    EXPECT_EQ(missing(kArKit, kMakeHuman),
              "mouthClose mouthDimpleLeft mouthDimpleRight mouthShrugUpper mouthPressLeft "
              "mouthPressRight ");
}

TEST(FaceNames, DoNotSwapSides) {
    const std::vector<const Names*> all{&kArKit, &kVrm, &kVrm0, &kMakeHuman, &kVroid};
    const auto isLeft = [](const std::string& name) {
        return name.find("Left") != std::string::npos || name.rfind("_L") == name.size() - 2;
    };
    const auto isRight = [](const std::string& name) {
        return name.find("Right") != std::string::npos || name.rfind("_R") == name.size() - 2;
    };
    std::size_t checked = 0;
    for (const Names* from : all)
        for (const Names* to : all)
            for (const FaceMatch& match : matchFace(*from, *to)) {
                if (isLeft(match.name) == isRight(match.name)) continue;
                if (match.name.find("ook") != std::string::npos) continue; // see below
                for (const auto& [morph, weight] : weightsOf(match)) {
                    // A name of both sides, such as "LeftEyeturnRight", says nothing.
                    if (isLeft(morph) == isRight(morph)) continue;
                    EXPECT_EQ(isLeft(match.name), isLeft(morph)) << match.name << ", " << morph;
                    ++checked;
                }
            }
    EXPECT_GT(checked, 100u);
    expectWeights("lookLeft", kArKit, {{"eyeLookOutLeft", 1}, {"eyeLookInRight", 1}});
    expectWeights("lookRight", kArKit, {{"eyeLookInLeft", 1}, {"eyeLookOutRight", 1}});
    expectWeights("eyeLookOutLeft", kVrm, {{"lookLeft", 0.5}});
    expectWeights("eyeLookInLeft", kMakeHuman, {{"LeftEyeturnRight", 1}});
    expectWeights("eyeLookOutRight", kMakeHuman, {{"RightEyeturnRight", 1}});
    expectWeights("lookLeft", kMakeHuman, {{"LeftEyeturnLeft", 1}, {"RightEyeturnLeft", 1}});
}

/// Ready Player Me's faces have ARKit's, visemes and names for both sides: nothing moves twice.
TEST(FaceNames, OfFacesWithSeveralVocabulariesMoveOnce) {
    Names morphs = {"mouthOpen", "mouthSmile", "eyesClosed", "eyesLookUp", "eyesLookDown"};
    morphs.insert(morphs.end(), kVisemes.begin(), kVisemes.end());
    morphs.insert(morphs.end(), kArKit.begin(), kArKit.end());
    for (const FaceMatch& match : matchFace(kArKit, morphs))
        EXPECT_EQ(weightsOf(match), (Weights{{match.name, 1.0}}));
    const Weights happy = weightsOf(match("happy", morphs));
    const auto of = [&](const char* name) { return happy.count(name) ? happy.at(name) : 0.0; };
    EXPECT_NEAR(of("mouthSmile") + of("mouthSmileLeft"), 0.8, 1e-3);
    EXPECT_NEAR(of("mouthSmile") + of("mouthSmileRight"), 0.8, 1e-3);
    EXPECT_EQ(match("aa", morphs).parts.at(0).morphs, Names{"viseme_aa"});
}

TEST(FaceNames, OfFacesAtRestMoveNothing) {
    for (const char* name : {"viseme_sil", "sil", "neutral", "Neutral", "Fcl_ALL_Neutral"}) {
        const FaceMatch found = match(name, kArKit);
        EXPECT_EQ(found.kind, FaceMatch::Kind::Rest) << name;
        EXPECT_TRUE(found.parts.empty());
    }
    EXPECT_EQ(match("sil", kVisemes).kind, FaceMatch::Kind::Own);
}
