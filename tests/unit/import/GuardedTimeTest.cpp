// SPDX-License-Identifier: MIT
// Files of less than a megabyte that took minutes, or gigabytes: their many elements were compared
// with all others, or copied for each.
#include "ExpectError.h"
#include "GltfBuilder.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/JointRoles>

#include <osg/Geometry>
#include <osg/Group>
#include <osgDB/Options>
#include <osgDB/WriteFile>

#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using nlohmann::json;
using test::GltfColumn;

/// Processor time of this program.
#ifdef __SANITIZE_ADDRESS__ // takes five times as long
constexpr double kMaxSeconds = 24.0;
#else
constexpr double kMaxSeconds = 8.0;
#endif

class GuardedTime : public testing::Test {
public:
    ~GuardedTime() override {
        EXPECT_LT(double(std::clock() - _begin) / CLOCKS_PER_SEC, kMaxSeconds);
    }

    /// Adds nodes below the root joint.
    static std::vector<std::size_t> addNodes(GltfColumn& column, std::size_t count,
                                             const json& node = json::object()) {
        std::vector<std::size_t> nodes;
        for (std::size_t n = 0; n < count; ++n) nodes.push_back(column.node(node));
        for (const std::size_t n : nodes) column.json["nodes"][0]["children"].push_back(n);
        return nodes;
    }

private:
    const std::clock_t _begin = std::clock();
};

} // namespace

TEST_F(GuardedTime, LongJointName) {
    std::string name;
    for (int k = 0; k < 1'000'000; ++k) name += "Aa";
    const std::string path = testing::TempDir() + "long.bvh";
    std::ofstream(path) << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nJOINT "
                        << name << "\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 0\nFrame Time: 1\n";
    const osgSkin::RestSkeleton skeleton = osgSkin::importSkeleton(path);
    EXPECT_EQ(skeleton.joints.at(1).name, name);
    EXPECT_EQ(osgSkin::recogniseJoints(skeleton).roles.at(1), "");
}

TEST_F(GuardedTime, JointNamesOfManyWords) {
    osgSkin::RestSkeleton skeleton;
    skeleton.add("Hips", -1, glm::dvec3(0.0));
    for (const std::string word : {"a_", "aA", "Left", "b1"})
        for (int j = 0; j < 2'000; ++j) {
            std::string name = std::to_string(j) + "_";
            while (name.size() < 900) name += word;
            skeleton.add(name, 0, glm::dvec3(0.0, j, 0.0));
        }
    for (int k = 0; k < 5; ++k) osgSkin::recogniseJoints(skeleton);
}

TEST_F(GuardedTime, ManyNamePrefixes) {
    osgSkin::RestSkeleton skeleton;
    skeleton.add("Hips", -1, glm::dvec3(0.0));
    for (int j = 0; j < 10'000; ++j) {
        std::string prefix;
        for (int rest = j / 4, k = 0; k < 4; ++k, rest /= 20) prefix += char('b' + rest % 20);
        const char* const words[] = {"Head", "LeftHand", "LeftFoot", "Neck"};
        skeleton.add("q" + prefix + "_" + words[j % 4], 0, glm::dvec3(0.0, j, 0.0));
    }
    for (int k = 0; k < 12; ++k) EXPECT_TRUE(osgSkin::recogniseJoints(skeleton).known());
}

TEST_F(GuardedTime, DuplicateNodeNames) {
    GltfColumn column;
    addNodes(column, 20'000, {{"name", "twin"}});
    EXPECT_EQ(osgSkin::importRig(column.save("twins.gltf")).rest.joints.size(), 3u);
}

TEST_F(GuardedTime, DuplicateClipNames) {
    GltfColumn column;
    column.bend();
    column.json["animations"] = json::array_t(8'000, column.json["animations"][0]);
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("clips.gltf"));
    ASSERT_EQ(rig.animations.size(), 8'000u);
    EXPECT_EQ(rig.animations[0]->getName(), "bend");
    EXPECT_EQ(rig.animations[1]->getName(), "bend 2");
    EXPECT_EQ(rig.animations.back()->getName(), "bend 8000");
}

TEST_F(GuardedTime, EmptyClips) {
    GltfColumn column;
    column.bend();
    json::array_t clips(100'000, {{"channels", json::array()}, {"samplers", json::array()}});
    clips.resize(108'000, column.json["animations"][0]);
    column.json["animations"] = std::move(clips);
    EXPECT_EQ(osgSkin::importRig(column.save("empty.gltf")).animations.size(), 8'000u);
}

TEST_F(GuardedTime, ManyMeshesAndNodes) {
    GltfColumn column;
    addNodes(column, 12'000);
    json& primitives = column.json["meshes"][0]["primitives"];
    json plain = primitives[0];
    plain.erase("indices");
    plain["attributes"] = {{"POSITION", column.accessor("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})}};
    column.json["meshes"].push_back({{"primitives", json::array_t(8'000, plain)}});
    column.json["nodes"][addNodes(column, 1).front()]["mesh"] = 1;
    EXPECT_EQ(osgSkin::importRig(column.save("meshes.gltf")).body.mesh.positions.size(),
              24u + 3u * 8'000u);
}

/// Bones without weights, deep below others and beside as many with weights.
TEST_F(GuardedTime, ManyUnweightedBones) {
    GltfColumn column;
    const std::size_t deep = 900, bones = 4'000;
    std::size_t above = column.node(json::object());
    column.json["nodes"][0]["children"].push_back(above);
    for (std::size_t d = 0; d < deep; ++d) {
        const std::size_t below = column.node(json::object());
        column.json["nodes"][above]["children"] = {below};
        above = below;
    }
    std::vector<double> places, corners, weights, indices;
    json& joints = column.json["skins"][0]["joints"];
    column.json["skins"][0].erase("inverseBindMatrices");
    for (std::size_t b = 0; b < 2 * bones; ++b) {
        joints.push_back(column.node(json::object()));
        column.json["nodes"][above]["children"].push_back(joints.back());
        if (b >= bones) continue;
        places.insert(places.end(), {double(b % 7), double(b) / 500.0, double(b % 5)});
        corners.insert(corners.end(), {double(3 + b), 0, 0, 0});
        weights.insert(weights.end(), {1, 0, 0, 0});
        if (b < 2) continue;
        for (const std::size_t corner : {b - 2, b - 1, b}) indices.push_back(double(corner));
    }
    json& primitive = column.json["meshes"][0]["primitives"][0];
    primitive["indices"] = column.accessor("SCALAR", indices, 5123);
    primitive["attributes"] = {{"POSITION", column.accessor("VEC3", places)},
                               {"JOINTS_0", column.accessor("VEC4", corners, 5123)},
                               {"WEIGHTS_0", column.accessor("VEC4", weights)}};
    EXPECT_EQ(osgSkin::importRig(column.save("bones.gltf")).body.weights.size(), 3 + 2 * bones);
}

TEST_F(GuardedTime, DropsUnusedMorphWeights) {
    GltfColumn column;
    column.json["meshes"][0]["weights"] = json::array_t(100'000, 0.0);
    column.json["skins"].push_back(column.json["skins"][0]);
    for (int copy = 0; copy < 2000; ++copy)
        column.json["scenes"][0]["nodes"].push_back(column.node({{"mesh", 0}, {"skin", 1}}));
    EXPECT_EQ(osgSkin::importRig(column.save("weights.gltf")).body.mesh.positions.size(),
              24u * 2001u);
}

TEST_F(GuardedTime, LimitsCopiedMorphTargets) {
    GltfColumn column;
    column.json["meshes"][0]["primitives"][0]["targets"] = json::array_t(10'000, json::object());
    column.json["skins"].push_back(column.json["skins"][0]);
    for (int copy = 0; copy < 500; ++copy)
        column.json["scenes"][0]["nodes"].push_back(column.node({{"mesh", 0}, {"skin", 1}}));
    const std::string path = column.save("targets.gltf");
    expectError([&] { osgSkin::importRig(path); }, "nodes, bones, materials and channels");
}

TEST_F(GuardedTime, LimitsMorphOffsets) {
    GltfColumn column;
    std::vector<double> places(9000, 1.0);
    json& primitive = column.json["meshes"][0]["primitives"][0];
    const std::size_t shared = column.accessor("VEC3", places);
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = double(i % 7);
    primitive["attributes"] = {{"POSITION", column.accessor("VEC3", places)}};
    primitive.erase("indices");
    primitive["targets"] = json::array_t(1000, {{"POSITION", shared}});
    for (json& node : column.json["nodes"]) node.erase("skin");
    const std::string path = column.save("offsets.gltf");
    expectError([&] { osgSkin::importMesh(path); },
                "meshes[0].primitives[0]: expected fewer vertices, corners and keys");
}

TEST_F(GuardedTime, LimitsUnusedBindMatrices) {
    GltfColumn column;
    json accessor = {{"componentType", 5126}, {"type", "MAT4"}, {"count", 900'000}};
    column.json["accessors"].push_back(accessor);
    column.json["skins"].push_back(
        {{"joints", {0}}, {"inverseBindMatrices", column.json["accessors"].size() - 1}});
    const std::string path = column.save("matrices.gltf");
    expectError([&] { osgSkin::importRig(path); },
                "skins[1].inverseBindMatrices: expected fewer vertices, corners and keys");
}

/// Each would be drawn separately.
TEST_F(GuardedTime, LimitsAccessorsWithoutBufferView) {
    GltfColumn column;
    const std::size_t many = 450'000;
    json& attributes = column.json["meshes"][0]["primitives"][1]["attributes"];
    column.json["meshes"][0]["primitives"][1]["mode"] = 0;
    for (const auto& [name, type] : std::initializer_list<std::pair<const char*, const char*>>{
             {"POSITION", "VEC3"}, {"COLOR_0", "VEC4"}, {"TEXCOORD_0", "VEC2"}}) {
        attributes[name] = column.json["accessors"].size();
        column.json["accessors"].push_back(
            {{"componentType", 5126}, {"type", type}, {"count", many}});
    }
    const std::string file = column.save("zeros.gltf");
    expectError([&] { osgSkin::importMesh(file); }, "(option maxSamples)");
    const osg::ref_ptr<osgDB::Options> more = new osgDB::Options("maxSamples=9000000");
    EXPECT_EQ(osgSkin::importMesh(file, more).mesh.positions.size(), 24u); // no face refers to
                                                                           // others
}

TEST_F(GuardedTime, LimitsMaterialsByFileSize) {
    const std::string folder = testing::TempDir();
    std::ofstream looks(folder + "many.mtl"), mesh(folder + "many.obj");
    mesh << "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int m = 0; m < 2000; ++m) {
        looks << "newmtl m" << m << "\n";
        mesh << "usemtl m" << m << "\nf 1 2 3\n";
    }
    looks.close();
    mesh.close();
    expectError([&] { osgSkin::importMesh(folder + "many.obj"); },
                "many.obj: 2000 materials, expected at most 10");
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("maxSamples=1000000");
    EXPECT_EQ(osgSkin::importMesh(folder + "many.obj", options).parts.size(), 2000u);
}

/// Groups that instance each other twice.
TEST_F(GuardedTime, MergesInstancesIntoOnePart) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    for (const float place : {0.0f, 1.0f, 2.0f}) places->push_back({place, place * place, 0.0f});
    geometry->setVertexArray(places);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    osg::ref_ptr<osg::Node> scene = geometry;
    for (int level = 0; level < 12; ++level) {
        const osg::ref_ptr<osg::Group> above = new osg::Group;
        above->addChild(scene);
        above->addChild(scene);
        scene = above;
    }
    const std::string path = testing::TempDir() + "often.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, path));
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    EXPECT_EQ(mesh.parts.size(), 1u);
    EXPECT_EQ(mesh.mesh.faceSizes.size(), 4096u);
}
