// SPDX-License-Identifier: MIT
//
// Morph targets of loaded characters: where each vertex is drawn, computed from the file's numbers.
#include "Command.h"
#include "DrawnSkin.h"
#include "ExpectContains.h"
#include "GlbFile.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "TextFile.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>

#include <osg/Matrixd>
#include <osg/Quat>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;
using osgSkin::LoadOptions;
using test::GltfColumn;

constexpr double kSize = 3.0;
constexpr double kExact = 1e-5 * kSize; ///< single precision

/// A column with the targets "wide", of the middle and the top, and "tall", of the top.
struct Face : GltfColumn {
    std::vector<double> wide, tall;
    static constexpr double kWideAtRest = 0.25;

    Face() : wide(places.size(), 0.0), tall(places.size(), 0.0) {
        for (std::size_t v = 8; v < places.size() / 3; ++v) {
            wide[3 * v] = 0.01 * double(v);
            wide[3 * v + 2] = -0.2;
            if (v >= 16) tall[3 * v + 1] = 0.05 * double(v - 15);
        }
        nlohmann::json& mesh = json["meshes"][0];
        mesh["primitives"][0]["targets"] = {{{"POSITION", accessor("VEC3", wide)}},
                                            {{"POSITION", accessor("VEC3", tall)}}};
        mesh["extras"]["targetNames"] = {"wide", "tall"};
        mesh["weights"] = {kWideAtRest, 0.0};
        bend();
        animate("talk", meshNode, "weights", {0.0, 1.0}, {0.0, 0.5, 1.0, 0.5});
    }

    osg::Vec3d morphed(std::size_t vertex, double wideWeight, double tallWeight) const {
        osg::Vec3d result;
        for (std::size_t k = 0; k < 3; ++k)
            result[int(k)] = places[3 * vertex + k] + wideWeight * wide[3 * vertex + k] +
                             tallWeight * tall[3 * vertex + k];
        return result;
    }
};

/// A vertex of the box of joint 0, 1 or 2, with joints 1 and 2 turned about x.
osg::Vec3d posed(const osg::Vec3d& rest, std::size_t joint, double degrees) {
    osg::Matrixd matrix = osg::Matrixd::translate(0.0, -double(joint), 0.0);
    const osg::Matrixd turned =
        osg::Matrixd::rotate(osg::DegreesToRadians(degrees), osg::Vec3d(1, 0, 0)) *
        osg::Matrixd::translate(0.0, 1.0, 0.0);
    for (std::size_t j = 0; j < joint; ++j) matrix = matrix * turned;
    return rest * matrix;
}

void expectDrawn(const Character& character, const Face& face, double wide, double tall,
                 double degrees) {
    std::size_t copies = 0;
    test::forEachCopy(character, [&](std::uint32_t v, const osg::Vec3d& drawn) {
        const osg::Vec3d expected = posed(face.morphed(v, wide, tall), v / 8, degrees);
        EXPECT_LT((drawn - expected).length(), kExact) << "vertex " << v;
        ++copies;
    });
    EXPECT_GE(copies, face.places.size() / 3);
}

const osgSkin::CharacterMotion& motionOf(const Character& character, const std::string& name) {
    for (const osgSkin::CharacterMotion& motion : character.motions)
        if (motion.name() == name) return motion;
    throw osgSkin::Error("no motion " + name);
}

} // namespace

/// On skins and on rigid parts, at rest and bent.
TEST(Morphs, ApplyBeforeSkinning) {
    Face face;
    face.json["animations"].erase(1);
    const std::string file = face.save("morphs.gltf");
    for (const bool isRigid : {false, true}) {
        LoadOptions options;
        options.rigid = isRigid ? std::vector<std::string>{"top"} : std::vector<std::string>{};
        Character character = loadCharacter(file, options);
        ASSERT_EQ(character.skin.rigids.size(), isRigid ? 1u : 0u);
        EXPECT_EQ(character.morphs(), (std::vector<std::string>{"wide", "tall"}));
        const osgSkin::CharacterMotion& bend = motionOf(character, "bend");
        character.poseAt(bend, 0.0);
        expectDrawn(character, face, Face::kWideAtRest, 0.0, 0.0);
        EXPECT_TRUE(character.setMorph("wide", 0.7f));
        EXPECT_TRUE(character.setMorph("tall", -0.3f));
        expectDrawn(character, face, 0.7, -0.3, 0.0);
        character.poseAt(bend, 0.5);
        expectDrawn(character, face, 0.7, -0.3, 60.0);
        EXPECT_FALSE(character.setMorph("smile", 1.0f));
        EXPECT_FALSE(character.setMorph("wide", std::nanf("")));
        expectDrawn(character, face, 0.7, -0.3, 60.0);
    }
}

TEST(Morphs, ApplyToMergedRigidParts) {
    Face face;
    face.json["animations"].erase(1);
    const std::string file = face.save("merged.gltf");
    LoadOptions options;
    options.rigid = std::vector<std::string>{"top"};
    options.mergeRigid = true;
    Character character = loadCharacter(file, options);
    EXPECT_TRUE(character.setMorph("wide", 0.7f));
    EXPECT_TRUE(character.setMorph("tall", -0.3f));
    character.poseAt(motionOf(character, "bend"), 0.5);
    EXPECT_TRUE(character.skin.rigids.empty());
    expectDrawn(character, face, 0.7, -0.3, 60.0);
}

TEST(Morphs, ArePlayedByClips) {
    Face face;
    const test::Notices notices;
    LoadOptions options;
    options.rigid = std::vector<std::string>{"top"};
    Character character = loadCharacter(face.save("talk.gltf"), options);
    EXPECT_EQ(notices.lines(), 0u) << notices.text();
    ASSERT_EQ(character.motions.size(), 2u);
    character.poseAt(motionOf(character, "talk"), 0.4);
    expectDrawn(character, face, 0.4, 0.5, 0.0);
    character.poseAt(motionOf(character, "bend"), 0.5);
    expectDrawn(character, face, Face::kWideAtRest, 0.0, 60.0);
}

TEST(Morphs, AreListedInTheReport) {
    Face face;
    test::expectContains(loadCharacter(face.save("report.gltf")).bindReport.text(),
                         "2 morph targets: \"wide\", \"tall\"");
}

TEST(Morphs, AreReadThroughSkinFiles) {
    Face face;
    const std::string mesh = face.save("named.gltf");
    for (const char* bind : {"weights", "smooth"}) {
        const std::string file = test::saveText(
            std::string("named_") + bind + ".skin",
            R"({"osgskin": 1, "mesh": "named.gltf", "skeleton": "named.gltf", "bind": ")" +
                std::string(bind) + "\"}");
        Character character = loadCharacter(file);
        EXPECT_EQ(character.morphs(), (std::vector<std::string>{"wide", "tall"})) << bind;
        EXPECT_TRUE(character.setMorph("tall", 0.5f));
        expectDrawn(character, face, Face::kWideAtRest, 0.5, 0.0);
    }
}

/// The offsets are those from the frame, in which "wide" has the weight 0.75, and "tall" 0.5.
TEST(Morphs, AreWrittenToStillGlb) {
    Face face;
    const std::string folder = test::makeTestFolder();
    for (const char* rigid : {"none", "top"}) {
        const auto baked =
            test::runBake(face.save("still.gltf") + " --rigid " + rigid +
                              " --motion talk --frames 0 --morph wide=0.75 --out still.glb",
                          folder);
        ASSERT_EQ(baked.status, 0) << baked.err;
        const test::Glb glb(folder + "/still.glb");
        const nlohmann::json& mesh = glb.json["meshes"][0];
        EXPECT_EQ(mesh["extras"]["targetNames"], (nlohmann::json{"wide", "tall"}));
        EXPECT_EQ(mesh["weights"], (nlohmann::json{0.0, 0.0}));
        const nlohmann::json& targets = mesh["primitives"][0]["targets"];
        ASSERT_EQ(targets.size(), 2u);
        const auto farthest = [&](std::size_t target) {
            double result = 0.0;
            for (const glm::dvec3& v : glb.vectors(targets[target]["POSITION"]))
                result = std::max(result, glm::length(v));
            return result;
        };
        double wide = 0.0;
        for (std::size_t v = 0; v < face.places.size() / 3; ++v)
            wide = std::max(wide, std::hypot(face.wide[3 * v], face.wide[3 * v + 2]));
        const double tall = *std::max_element(face.tall.begin(), face.tall.end());
        EXPECT_NEAR(farthest(0), 0.25 * wide, kExact);
        EXPECT_NEAR(farthest(1), 0.5 * tall, kExact);
        std::string why;
        if (test::hasGlbValidator(why)) {
            EXPECT_EQ(test::glbComplaints(folder + "/still.glb"), "");
        }
    }
    const auto unknown =
        test::runBake(face.save("still.gltf") + " --morph wied=1 --out no.glb", folder);
    EXPECT_EQ(unknown.status, 2);
    test::expectContains(unknown.err, "did you mean \"wide\"?");
}
