// SPDX-License-Identifier: MIT
//
// The same body, read by the plug-in with names of several families: it must bend, keep its rigid
// parts and move alike.
//
// Motions on bodies with fitted skeletons: they play, and the skin holds together.
//
// Meshes bound to the same joints in different poses, such as clothes and a body.
//
// Third-party painted characters, all clips, compared with linear blending by glTF's own
// definition.
#include "BlendError.h"
#include "Command.h"
#include "DrawnSkin.h"
#include "FindNodes.h"
#include "GltfBuilder.h"
#include "RenamedBody.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportSkeleton>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace {

using osgSkin::RestSkeleton;

void writeJoint(std::ostream& out, const RestSkeleton& skeleton, int joint) {
    const osgSkin::RestJoint& rest = skeleton.joints[static_cast<std::size_t>(joint)];
    const auto offset = [&out](const glm::dvec3& o) {
        out << "{\nOFFSET " << o.x << " " << o.y << " " << o.z << "\n";
    };
    out << (rest.parent < 0 ? "ROOT " : "JOINT ") << rest.name << "\n";
    offset(rest.parent < 0
               ? rest.centre
               : rest.centre - skeleton.joints[static_cast<std::size_t>(rest.parent)].centre);
    out << "CHANNELS 3 Zrotation Yrotation Xrotation\n";
    for (const int child : skeleton.children(joint)) writeJoint(out, skeleton, child);
    if (skeleton.children(joint).empty()) {
        out << "End Site\n";
        offset(rest.tip ? *rest.tip - rest.centre : glm::dvec3(0, 0, 1e-3));
        out << "}\n";
    }
    out << "}\n";
}

/// A BVH file of one sample, the rest pose.
void writeBvh(const RestSkeleton& skeleton, const std::string& file) {
    std::ofstream out(file);
    out << std::setprecision(17) << "HIERARCHY\n";
    writeJoint(out, skeleton, 0);
    out << "MOTION\nFrames: 1\nFrame Time: 0.1\n";
    for (std::size_t i = 0; i < 3 * skeleton.joints.size(); ++i) out << "0 ";
    out << "\n";
}

/// The drawn geometry of a character at a time, in the world.
struct Drawn {
    explicit Drawn(osg::Node& scene) {
        for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(scene)) {
            const auto& vertices = static_cast<const osg::Vec3Array&>(
                *found.node->getDeformedGeometry()->getVertexArray());
            skin.insert(skin.end(), vertices.begin(), vertices.end());
        }
        for (const auto& found : test::findNodes<osgSkin::RigidPart>(scene))
            rigids[found.node->getParent(0)->getName()] = found.toWorld;
    }

    std::vector<osg::Vec3> skin;                ///< vertices of the skins, one after the other
    std::map<std::string, osg::Matrixd> rigids; ///< by the name of their bone
};

/// Reads the thrower on `skeleton` with its throw, at a time when its hands are rotated.
Drawn drawn(const RestSkeleton& skeleton, const std::string& extra) {
    const std::string folder = test::makeTestFolder();
    writeBvh(skeleton, folder + "/rig.bvh");
    std::ofstream(folder + "/body.skin")
        << R"({ "osgskin": 1, "mesh": ")" << OSGSKIN_DATA << R"(/thrower.obj", )"
        << R"("skeleton": "rig.bvh", "motions": [ { "file": ")" << OSGSKIN_DATA
        << R"(/throw.bvh" } ])" << extra << " }";
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(folder + "/body.skin");
    if (!scene) return Drawn(*osg::ref_ptr<osg::Node>(new osg::Node));
    for (const double time : {0.0, 1.1}) test::updateAt(*scene, time); // the first starts the clock
    return Drawn(*scene);
}

std::string asJson(const osgSkin::JointNames& names) {
    std::string result = R"(, "names": { ")" + names.name + R"(": {)", comma;
    for (const auto& [role, members] : names.roles) {
        result += comma + " \"" + role + "\": [";
        for (std::size_t i = 0; i < members.size(); ++i)
            result += (i > 0 ? ", \"" : " \"") + members[i] + "\"";
        result += " ]";
        comma = ",";
    }
    return result + " } }";
}

class BodyNames : public testing::Test {
protected:
    void SetUp() override {
        body = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
        // VRM has no names for these.
        for (const char* joint : {"Neck1", "LHipJoint", "RHipJoint", "LeftFingerBase",
                                  "RightFingerBase", "LeftHandIndex1", "RightHandIndex1"})
            body = test::without(body, joint);
    }

    void expectAlike(const osgSkin::JointNames& family, const std::string& extra) {
        const auto names = test::namesIn(body, family);
        const Drawn expected = drawn(body, {}), found = drawn(test::renamed(body, names), extra);
        ASSERT_EQ(expected.rigids.size(), 1u); // the head: thumbs and toes move
        ASSERT_GT(expected.skin.size(), 1000u);
        // The joints' names decide the order of the legs in the product, and so of the vertices.
        ASSERT_EQ(found.skin.size(), expected.skin.size());
        std::size_t exact = 0;
        for (const osg::Vec3& v : found.skin) {
            float nearest = HUGE_VALF;
            for (const osg::Vec3& w : expected.skin) nearest = std::min(nearest, (v - w).length2());
            EXPECT_LT(std::sqrt(nearest), 2e-3f); // metres
            if (nearest == 0.0f) ++exact;
        }
        EXPECT_GT(exact, found.skin.size() * 95 / 100);
        EXPECT_EQ(found.rigids.size(), expected.rigids.size());
        for (const auto& [bone, matrix] : expected.rigids) {
            ASSERT_EQ(found.rigids.count(names.at(bone)), 1u) << bone << ": no rigid part";
            EXPECT_EQ(found.rigids.at(names.at(bone)), matrix) << bone;
        }
    }

    RestSkeleton body;
};

} // namespace

TEST_F(BodyNames, OfVrmDrawTheSame) {
    expectAlike(test::knownNames("VRM"), {});
}

TEST_F(BodyNames, OfTheFileDrawTheSame) {
    expectAlike(test::robotNames(), asJson(test::robotNames()));
}

namespace {

using osgSkin::Character;

struct Play {
    const char* name;
    const char* mesh;   ///< below OSGSKIN_SHARED_DATA; null: the thrower
    const char* motion; ///< below OSGSKIN_SHARED_DATA; null: the project's own throw
    std::size_t skipFrames;
};

void PrintTo(const Play& play, std::ostream* out) {
    *out << play.name;
}

std::string meshFile(const Play& play) {
    return play.mesh ? std::string(OSGSKIN_SHARED_DATA "/") + play.mesh
                     : OSGSKIN_DATA "/thrower.obj";
}

std::string motionFile(const Play& play) {
    return play.motion ? std::string(OSGSKIN_SHARED_DATA "/") + play.motion
                       : OSGSKIN_DATA "/throw.bvh";
}

/// The skin's current vertices, in the mesh's own order.
std::vector<glm::dvec3> posedSkin(const Character& character) {
    std::vector<glm::dvec3> result(character.body.mesh.positions.size());
    test::forEachCopy(character, [&](std::uint32_t vertex, const osg::Vec3d& p) {
        result[vertex] = {p.x(), p.y(), p.z()};
    });
    return result;
}

/// Each edge's length over its length at rest, ascending.
std::vector<double> stretches(const osgSkin::SkinMesh& mesh, const std::vector<glm::dvec3>& posed) {
    std::vector<double> result;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        for (std::size_t i = 0; i < size; ++i) {
            const std::uint32_t a = mesh.faceVertices[corner + i];
            const std::uint32_t b = mesh.faceVertices[corner + (i + 1) % size];
            const double rest = glm::distance(mesh.positions[a], mesh.positions[b]);
            if (rest > 0.0) result.push_back(glm::distance(posed[a], posed[b]) / rest);
        }
        corner += size;
    }
    std::sort(result.begin(), result.end());
    return result;
}

class FitPlay : public testing::TestWithParam<Play> {
protected:
    void SetUp() override {
        for (const std::string& file : {meshFile(GetParam()), motionFile(GetParam())})
            if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    }

    static Character load() {
        const std::string file = test::makeTestFolder() + "/fitted.skin";
        std::ofstream(file) << R"({ "osgskin": 1, "mesh": ")" << meshFile(GetParam())
                            << R"(", "skeleton": { "fit": true }, "motions": [ { "file": ")"
                            << motionFile(GetParam()) << R"(", "skipFrames": )"
                            << GetParam().skipFrames << " } ] }";
        return osgSkin::loadCharacter(file);
    }
};

} // namespace

TEST_P(FitPlay, SkinHoldsTogether) {
    Character character = load();
    ASSERT_EQ(character.rest.joints.size(), 31u);
    EXPECT_EQ(character.fitReport.joints.size(), 31u);
    const osgSkin::CharacterMotion& motion = character.motions.front();
    for (const auto& entry : motion.report.entries)
        EXPECT_FALSE(entry.motionJoint.empty()) << entry.rigJoint;
    const std::size_t step = std::max<std::size_t>(1, motion.clip.frames / 24);
    for (std::size_t frame = 0; frame < motion.clip.frames; frame += step) {
        character.pose(motion, frame);
        const std::vector<double> edges = stretches(character.body.mesh, posedSkin(character));
        // Armpits stretch most if arms rest low and are raised. A tear would be far beyond.
        EXPECT_LT(edges.back(), 5.0) << "frame " << frame;
        EXPECT_LT(edges[edges.size() * 999 / 1000], 3.2) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, FitPlay,
    testing::Values(Play{"thrower_throws", nullptr, nullptr, 0},
                    Play{"human_throws", "human_blend/human_4282.obj", nullptr, 0},
                    Play{"human_pitches", "human_blend/human_4282.obj",
                         "cmu/mb/124_01_pitch_excerpt_120hz.bvh", 1},
                    Play{"human_walks", "human_blend/human_4282.obj", "cmu/mb/12_01_walk_pybvh.bvh",
                         1},
                    Play{"human_climbs", "human_blend/human_4282.obj", "cmu/mb/01_03.bvh", 1},
                    Play{"human_jumps", "human_blend/human_4282.obj", "cmu/mb/01_01.bvh", 1},
                    Play{"body_throws", "makehuman/body/body4k_neutral.obj", nullptr, 0}),
    [](const auto& play) { return std::string(play.param.name); });

TEST(FitPlayThrower, ThrowsAsItDoesWithItsOwnSkeleton) {
    const std::string file = test::makeTestFolder() + "/fitted.skin";
    std::ofstream(file) << R"({ "osgskin": 1, "mesh": ")" OSGSKIN_DATA
                           R"(/thrower.obj", "skeleton": { "fit": true },
                              "motions": [ { "file": ")" OSGSKIN_DATA R"(/throw.bvh" } ] })";
    Character fitted = osgSkin::loadCharacter(file);
    Character own = osgSkin::loadCharacter(OSGSKIN_DATA "/thrower.skin");
    for (std::size_t frame = 0; frame < 360; frame += 30) {
        fitted.pose(fitted.motions.front(), frame);
        own.pose(own.motions.front(), frame);
        const std::vector<glm::dvec3> a = posedSkin(fitted), b = posedSkin(own);
        double mean = 0.0;
        for (std::size_t v = 0; v < a.size(); ++v)
            mean += glm::distance(a[v], b[v]) / static_cast<double>(a.size());
        EXPECT_LT(mean, 0.04 * 1.8) << "frame " << frame;
    }
}

namespace {

using test::GltfColumn;

/// A column, and beside it another one on the same joints that was bound with its middle rotated.
std::string saveTwo(const std::string& name, double degrees) {
    GltfColumn column;
    column.bend();
    std::vector<double> places = column.places, matrices;
    for (std::size_t i = 0; i < places.size(); i += 3) places[i] += 2.0;
    glm::dmat4 joint(1.0);
    for (int j = 0; j < 3; ++j) {
        if (j > 0) joint = glm::translate(joint, {0.0, 1.0, 0.0});
        if (j == 1) joint = glm::rotate(joint, glm::radians(degrees), {1.0, 0.0, 0.0});
        const glm::dmat4 inverse = glm::inverse(joint);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) matrices.push_back(inverse[c][r]);
    }
    nlohmann::json mesh = column.json["meshes"][0];
    mesh["primitives"][0]["attributes"]["POSITION"] = column.accessor("VEC3", places);
    column.json["meshes"].push_back(mesh);
    column.json["skins"].push_back(
        {{"joints", column.joints}, {"inverseBindMatrices", column.accessor("MAT4", matrices)}});
    const std::size_t second = column.node({{"name", "second"}, {"mesh", 1}, {"skin", 1}});
    column.json["scenes"][0]["nodes"].push_back(second);
    return column.save(name);
}

} // namespace

TEST(PerVertexBindPose, MeshesStandAsTheirOwnSkinsSay) {
    for (const double degrees : {0.0, 50.0, -120.0}) {
        const test::BlendError error = test::blendError(saveTwo("apart.gltf", degrees));
        EXPECT_EQ(error.clips, 1u) << degrees;
        EXPECT_LT(error.whole, 1e-5) << degrees;
    }
}

TEST(PerVertexBindPose, MatricesThatAreNoneMoveNothing) {
    GltfColumn column;
    std::vector<double> matrices(48, 0.0);
    for (std::size_t k = 0; k < 32; ++k) // of the first two
        matrices[k] = k % 16 % 5 == 0 ? 1.0 : k == 29 ? -1.0 : 0.0;
    column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
    const osgSkin::Character character = osgSkin::loadCharacter(column.save("none.gltf"));
    ASSERT_EQ(3 * character.body.mesh.positions.size(), column.places.size());
    for (std::size_t i = 0; i < column.places.size(); ++i)
        EXPECT_NEAR(character.body.mesh.positions[i / 3][int(i % 3)], column.places[i], 1e-6) << i;
}

namespace {

struct Painted {
    const char* file;
    std::size_t clips;
};

class LinearBlend : public testing::TestWithParam<Painted> {};

} // namespace

TEST_P(LinearBlend, IsFollowedInEveryClip) {
    const std::string file = std::string(OSGSKIN_SHARED_DATA "/characters/") + GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file << ", which is missing";
    const test::BlendError error = test::blendError(file);
    EXPECT_EQ(error.clips, GetParam().clips);
    EXPECT_LT(error.whole, 1e-3) << error.clip;
    EXPECT_LT(error.mixed, 0.02);
    RecordProperty("whole", std::to_string(error.whole));
    RecordProperty("mixed", std::to_string(error.mixed));
    std::cout << "weights of 0 and 1: " << error.whole << ", others: " << error.mixed
              << " of the size\n";
}

TEST_P(LinearBlend, ClipsAreFoundByName) {
    const std::string file = std::string(OSGSKIN_SHARED_DATA "/characters/") + GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file << ", which is missing";
    const osgSkin::Character all = osgSkin::loadCharacter(file);
    ASSERT_EQ(all.motions.size(), GetParam().clips);
    // If there are many: every seventh, and the last.
    const std::size_t step = all.motions.size() > 20 ? 7 : 1;
    for (std::size_t m = all.motions.size(); m > 0; m = m > step ? m - step : 0) {
        const osgSkin::CharacterMotion& motion = all.motions[m - 1];
        osgSkin::LoadOptions options;
        options.motion = motion.name();
        const osgSkin::Character one = osgSkin::loadCharacter(file, options);
        EXPECT_EQ(one.motions.front().name(), motion.name());
        EXPECT_TRUE(one.manager->isPlaying(motion.name()));
    }
    osgSkin::LoadOptions options;
    options.motion = "no such clip";
    try {
        osgSkin::loadCharacter(file, options);
        ADD_FAILURE() << "an unknown clip was taken";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find('"' + all.motions.back().name() + '"'),
                  std::string::npos)
            << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Characters, LinearBlend,
                         testing::Values(Painted{"robot.glb", 14}, Painted{"Knight.glb", 76}),
                         [](const auto& tested) {
                             const std::string file = tested.param.file;
                             return file.substr(0, file.find('.'));
                         });
