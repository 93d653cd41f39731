// SPDX-License-Identifier: MIT
// Rigged glTF files of osgskinbake, posed by linear blending in double precision, without our
// importer, beside the skin's own vertices.
#include "Command.h"
#include "ExpectContains.h"
#include "GlbFile.h"
#include "GltfBuilder.h"
#include "GltfReference.h"
#include "ReferenceSkin.h"
#include "TextFile.h"

#include <osgSkin/Deform>
#include <osgSkinCharacter/LoadCharacter>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace {

using osgSkin::Character;
using test::GltfColumn;
using test::GltfReference;
using test::runBake;

const std::string kRiggedThrower = "'" OSGSKIN_DATA "/thrower.skin' ";

/// The radius of the limb at each vertex, from a file of --binding: that of the joint that it
/// follows most evenly in part, the median distance of half-bent skin from the twist's axis.
std::vector<double> limbRadii(const std::string& bindingFile, const std::vector<glm::dvec3>& rest) {
    const nlohmann::json binding = test::readJson(bindingFile);
    std::map<std::string, std::pair<glm::dvec3, glm::dvec3>> axes;
    const auto vector = [](const nlohmann::json& v) { return glm::dvec3(v[0], v[1], v[2]); };
    for (const nlohmann::json& joint : binding["joints"])
        axes[joint["name"]] = {vector(joint["centre"]), vector(joint["twistAxis"])};
    std::map<std::string, std::vector<double>> distances;
    std::vector<std::string> joints;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        joints.emplace_back();
        double most = -1.0;
        for (const nlohmann::json& ratio : binding["vertices"][v]["ratios"]) {
            const double bend = ratio[1], twist = ratio[2];
            const std::string name = ratio[0];
            const auto& [centre, axis] = axes[name];
            if (bend >= 0.25 && bend <= 0.75)
                distances[name].push_back(glm::length(glm::cross(rest[v] - centre, axis)));
            const double evenly = std::max(bend * (1.0 - bend), twist * (1.0 - twist));
            if (evenly > most) joints.back() = name;
            most = std::max(most, evenly);
        }
    }
    std::vector<double> medians, result;
    for (auto& [name, of] : distances) {
        std::sort(of.begin(), of.end());
        medians.push_back(of[of.size() / 2]);
    }
    std::sort(medians.begin(), medians.end());
    for (const std::string& joint : joints) {
        const auto found = distances.find(joint);
        result.push_back(found == distances.end() ? medians[medians.size() / 2]
                                                  : found->second[found->second.size() / 2]);
    }
    return result;
}

/// The mesh's vertices at the place of each vertex of a file at rest.
std::vector<std::vector<std::size_t>> sourcesOf(GltfReference& file,
                                                const std::vector<glm::dvec3>& rest) {
    std::vector<std::vector<std::size_t>> sources;
    for (const glm::dvec3& x : file.verticesAt(-1, 0.0)) {
        sources.emplace_back();
        for (std::size_t v = 0; v < rest.size(); ++v)
            if (glm::distance(rest[v], x) < 1e-6) sources.back().push_back(v);
        EXPECT_FALSE(sources.back().empty());
    }
    return sources;
}

/// The largest distance between a rigged file's vertices and those of OBJ frames.
struct RiggedComparison {
    double radii = 0.0; ///< in radii of the limb
    double units = 0.0;
    std::size_t poses = 0;
};

/// \param radii of each vertex, or empty
RiggedComparison compareRigged(const std::string& rigged, const std::string& clip,
                               const std::string& folder, double rate,
                               const std::vector<double>& radii) {
    GltfReference reference(rigged);
    int animation = -1;
    const nlohmann::json& animations = reference.json["animations"];
    for (std::size_t a = 0; a < animations.size(); ++a)
        if (animations[a]["name"] == clip) animation = int(a);
    EXPECT_GE(animation, 0) << clip;
    const auto rest = test::readObjVertices(folder + "/rest.obj");
    const auto sources = sourcesOf(reference, rest);
    RiggedComparison result;
    for (int frame = 0; frame < 1000; ++frame) {
        const std::string file = folder + "/frame_" + std::to_string(frame) + ".obj";
        if (!std::filesystem::exists(file)) continue;
        const auto expected = test::readObjVertices(file);
        const auto found = reference.verticesAt(animation, frame / rate);
        EXPECT_EQ(found.size(), sources.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            double error = INFINITY, radius = 1.0;
            for (const std::size_t v : sources[i])
                if (glm::distance(found[i], expected[v]) < error) {
                    error = glm::distance(found[i], expected[v]);
                    if (!radii.empty()) radius = radii[v];
                }
            result.units = std::max(result.units, error);
            result.radii = std::max(result.radii, error / radius);
        }
        ++result.poses;
    }
    return result;
}

/// Each weight of a vertex belongs to another joint, as glTF demands.
void expectJointsOnce(const GltfReference& rigged) {
    const nlohmann::json& attributes = rigged.json["meshes"][0]["primitives"][0]["attributes"];
    std::set<std::pair<std::size_t, double>> seen; // vertex, joint
    for (int set = 0; attributes.contains("JOINTS_" + std::to_string(set)); ++set) {
        const auto joints = rigged.accessor(attributes["JOINTS_" + std::to_string(set)]);
        const auto weights = rigged.accessor(attributes["WEIGHTS_" + std::to_string(set)]);
        for (std::size_t i = 0; i < joints.size(); ++i)
            if (weights[i] > 0.0) {
                EXPECT_TRUE(seen.emplace(i / 4, joints[i]).second) << "vertex " << i / 4;
            }
    }
}

/// A character, and a clip of it.
struct RiggedCase {
    const char* name;
    std::string character;
    std::string clip, frames;
    double rate; ///< frames a second
};

void PrintTo(const RiggedCase& c, std::ostream* out) {
    *out << c.name;
}

class RiggedCharacter : public testing::TestWithParam<RiggedCase> {
protected:
    void SetUp() override {
        const std::string& file = GetParam().character;
        if (!std::filesystem::exists(file))
            GTEST_SKIP() << "needs " << file << ", which is missing";
        folder = test::makeTestFolder();
        bake(" --motion " + GetParam().clip + " --frames " + GetParam().frames +
             " --out frame_%d.obj --rest rest.obj --binding binding.json");
        radii = limbRadii(folder + "/binding.json", test::readObjVertices(folder + "/rest.obj"));
    }
    void bake(const std::string& arguments) const {
        const auto baked = runBake("'" + GetParam().character + "' --quiet" + arguments, folder);
        ASSERT_EQ(baked.status, 0) << baked.err;
    }
    /// The error of a rigged file written with `arguments`.
    double error(const std::string& arguments) const {
        bake(" --rigged rigged.glb" + arguments);
        const RiggedComparison found =
            compareRigged(folder + "/rigged.glb", GetParam().clip, folder, GetParam().rate, radii);
        EXPECT_EQ(found.poses, 37u);
        expectJointsOnce(GltfReference(folder + "/rigged.glb"));
        std::cout << GetParam().name << arguments << ": " << found.radii << " r\n";
        return found.radii;
    }
    std::string folder;
    std::vector<double> radii;
};

} // namespace

TEST_P(RiggedCharacter, FollowsTheSkinInAllClips) {
    EXPECT_LE(error(""), 0.015);
    std::string why;
    if (test::hasGlbValidator(why)) {
        EXPECT_EQ(test::glbComplaints(folder + "/rigged.glb"), "");
    }
}

TEST_P(RiggedCharacter, IsFarOffWithoutHelpers) {
    EXPECT_GT(error(" --helpers 0 --motion " + GetParam().clip), 0.1);
}

TEST_P(RiggedCharacter, IsNearerWithMoreHelpersAndWeights) {
    const std::string clip = " --motion " + GetParam().clip;
    EXPECT_LE(error(" --helpers 16" + clip), 0.006);
    EXPECT_LE(error(" --helpers 16 --weights 8" + clip), 0.006);
    const nlohmann::json json = GltfReference(folder + "/rigged.glb").json;
    EXPECT_EQ(json["meshes"][0]["primitives"][0]["attributes"].count("WEIGHTS_1"), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Characters, RiggedCharacter,
    testing::Values(RiggedCase{"Thrower", OSGSKIN_DATA "/thrower.skin", "throw", "0:324:9", 120.0},
                    RiggedCase{"Knight", OSGSKIN_SHARED_DATA "/characters/Knight.glb",
                               "2H_Melee_Attack_Spin", "0:72:2", 30.0}),
    [](const auto& c) { return std::string(c.param.name); });

namespace {

/// A column with a morph target whose weight is not 0 at rest.
struct MorphedColumn : GltfColumn {
    MorphedColumn() {
        std::vector<double> wide(places.size(), 0.0);
        for (std::size_t v = 8; v < places.size() / 3; ++v) wide[3 * v] = 0.01 * double(v);
        nlohmann::json& mesh = json["meshes"][0];
        mesh["primitives"][0]["targets"] = {{{"POSITION", accessor("VEC3", wide)}}};
        mesh["extras"]["targetNames"] = {"wide"};
        mesh["weights"] = {0.25};
        bend();
        animate("bend", meshNode, "weights", {0.0, 1.0}, {-0.5, 1.0});
    }
};

} // namespace

TEST(RiggedGlb, KeepsMorphTargets) {
    const std::string folder = test::makeTestFolder();
    const std::string file = "'" + MorphedColumn().save("face.gltf") + "' ";
    const auto baked =
        runBake(file + "--quiet --rest rest.obj --out frame_%d.obj --rigged face.glb", folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    const nlohmann::json json = GltfReference(folder + "/face.glb").json;
    EXPECT_EQ(json["meshes"][0]["extras"]["targetNames"], nlohmann::json({"wide"}));
    EXPECT_EQ(json["meshes"][0]["weights"], nlohmann::json({0.25}));
    const RiggedComparison found = compareRigged(folder + "/face.glb", "bend", folder, 30.0, {});
    EXPECT_EQ(found.poses, 31u);
    EXPECT_LE(found.units, 1e-5);
}

TEST(RiggedGlb, HasJointsAndNoHelpersWithoutClips) {
    const std::string folder = test::makeTestFolder();
    const std::string file = "'" + GltfColumn().save("still.gltf") + "' ";
    const auto baked = runBake(file + "--rigged still.glb", folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    test::expectContains(baked.err, "still.glb: 3 joints, 0 helper joints, 0 clips");
    test::expectContains(baked.err, "a limb's radius off where joints bend and twist through");
    const nlohmann::json json = GltfReference(folder + "/still.glb").json;
    EXPECT_EQ(json.count("animations"), 0u);
    ASSERT_EQ(json["skins"][0]["joints"].size(), 3u);
    EXPECT_EQ(json["nodes"][2]["name"], "top");
    EXPECT_NEAR(json["nodes"][2]["translation"][1], 1.0, 1e-9);
}

namespace {

/// The skin's own vertices where the file's joints are, without helpers.
std::vector<glm::dvec3> skinAt(const Character& character, const std::vector<glm::dmat4>& joints,
                               const std::vector<glm::dmat4>& atRest) {
    std::vector<glm::dmat4> skinning;
    for (std::size_t j = 0; j < character.binding.joints.size(); ++j) {
        // Files of metres, Y up, facing +Z: rest space.
        const glm::dvec3 moved = glm::dvec3(atRest[j][3]) - character.binding.joints[j].centre;
        EXPECT_LE(glm::length(moved), 1e-5);
        skinning.push_back(joints[j] * glm::inverse(atRest[j]));
    }
    return osgSkin::deform(character.binding, character.body.mesh.positions, skinning);
}

} // namespace

TEST(RiggedGlb, FollowsTheSkinInTheRangesOfJointsWithoutClips) {
    const std::string folder = test::makeTestFolder(), skin = folder + "/still.skin";
    std::ofstream(skin) << nlohmann::json({{"osgskin", 1},
                                           {"mesh", OSGSKIN_DATA "/thrower.obj"},
                                           {"skeleton", OSGSKIN_DATA "/thrower.bvh"}});
    const auto baked =
        runBake("still.skin --rigged still.glb --rest rest.obj --binding binding.json", folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    test::expectContains(baked.err, "\"joint ranges\" alone moves helper joints");
    const Character character = osgSkin::loadCharacter(skin);
    const auto rest = test::readObjVertices(folder + "/rest.obj");
    const std::vector<double> radii = limbRadii(folder + "/binding.json", rest);
    GltfReference file(folder + "/still.glb");
    ASSERT_EQ(file.json["animations"].size(), 1u);
    const auto atRest = file.nodesAt(-1, 0.0);
    const auto sources = sourcesOf(file, rest);
    double worst = 0.0;
    const auto times = file.accessor(file.json["animations"][0]["samplers"][0]["input"]);
    EXPECT_GT(times.size(), 200u);
    for (const double time : times) {
        const auto own = skinAt(character, file.nodesAt(0, time), atRest);
        const auto blended = file.verticesAt(0, time);
        for (std::size_t i = 0; i < blended.size(); ++i) {
            double error = INFINITY;
            for (const std::size_t v : sources[i])
                error = std::min(error, glm::distance(blended[i], own[v]) / radii[v]);
            worst = std::max(worst, error);
        }
    }
    std::cout << worst << " r\n";
    EXPECT_LE(worst, 0.05);
}

TEST(RiggedGlb, TellsWhatIsLeftOut) {
    const std::string folder = test::makeTestFolder();
    GltfColumn column;
    const auto errors = [&] {
        return runBake("'" + column.save("hair.vrm") + "' --rigged hair.glb", folder).err;
    };
    EXPECT_EQ(errors().find("left out"), std::string::npos) << errors();
    column.json["extensions"]["VRMC_springBone"]["springs"] = {
        {{"joints", {{{"node", 1}}, {{"node", 2}}}}}};
    EXPECT_EQ(errors().find("left out"), std::string::npos) << errors();
    test::expectContains(
        runBake("'" + column.save("hair.vrm") + "' --rigged hair.osgb", folder).err,
        "hair.vrm: left out: spring bones\n");
    column.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]["hips"]["node"] = 0;
    test::expectContains(errors(), "left out: which joint is which part of the body\n");
    const nlohmann::json roll = {{"rotation", {{"source", 1}, {"weight", 1.0}}}};
    column.json["nodes"][2]["extensions"]["VRMC_node_constraint"]["constraint"] = roll;
    test::expectContains(errors(), "left out: constraints, which joint");
}

TEST(RiggedGlb, IsInMetresWithYUp) {
    const std::string folder = test::makeTestFolder();
    const auto baked =
        runBake(kRiggedThrower + "--quiet --unit 0.1 --rest rest.obj --rigged small.glb "
                                 "--frames 0 --helpers 1 --shapes none",
                folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    GltfReference reference(folder + "/small.glb");
    double high = 0.0, expected = 0.0;
    for (const glm::dvec3& x : reference.verticesAt(-1, 0.0)) high = std::max(high, x.y);
    for (const glm::dvec3& x : test::readObjVertices(folder + "/rest.obj"))
        expected = std::max(expected, 0.1 * x.y);
    EXPECT_NEAR(high, expected, 1e-6);
}

TEST(RiggedGlb, ExitsWithTwoOnUsageErrors) {
    const std::string folder = test::makeTestFolder();
    for (const char* arguments : {"--rigged a.gltf", "--rigged a.glb --weights 5",
                                  "--rigged a.glb --helpers -1", "--rest r.obj --helpers 4",
                                  "--rigged a.glb --out a.glb", "--rigged a.glb --motion none"}) {
        const auto result = runBake(kRiggedThrower + arguments, folder);
        EXPECT_EQ(result.status, 2) << arguments;
        EXPECT_FALSE(result.err.empty()) << arguments;
        EXPECT_FALSE(std::filesystem::exists(folder + "/a.glb")) << arguments;
    }
}
