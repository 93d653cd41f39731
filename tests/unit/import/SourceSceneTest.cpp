// SPDX-License-Identifier: MIT
// The document that files are read into: our glTF reader compared with Assimp's on the same file,
// and one reading for everything that is made from it.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Paths.h"
#include "assimp/AssimpScene.h"
#include "gltf/ReadGltf.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinImport/ShareScenes>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace {

using osgSkin::SourceBone;
using osgSkin::SourceKey;
using osgSkin::SourceMesh;
using osgSkin::SourceNode;
using osgSkin::SourceScene;
using osgSkin::SourceTrack;
using test::GltfColumn;

constexpr double kTolerance = 1e-6; ///< of numbers of about 1

template <typename Vector>
void expectSame(const std::vector<Vector>& a, const std::vector<Vector>& b,
                const std::string& what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_LE(glm::distance(a[i], b[i]), kTolerance * std::max(1.0f, glm::length(a[i])))
            << what << " " << i;
}

void expectSame(const glm::dmat4& a, const glm::dmat4& b, const std::string& what) {
    for (int column = 0; column < 4; ++column)
        EXPECT_LE(glm::distance(a[column], b[column]), 10.0 * kTolerance) << what;
}

template <typename Value>
void expectSame(const std::vector<SourceKey<Value>>& a, const std::vector<SourceKey<Value>>& b,
                const std::string& what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_DOUBLE_EQ(a[k].time, b[k].time) << what;
        EXPECT_LE(glm::length(a[k].value - b[k].value), kTolerance) << what << " key " << k;
    }
}

void expectSame(const SourceMesh& a, const SourceMesh& b) {
    expectSame(a.positions, b.positions, "positions");
    expectSame(a.normals, b.normals, "normals");
    expectSame(a.texCoords, b.texCoords, "texture coordinates");
    EXPECT_EQ(a.faceSizes, b.faceSizes);
    EXPECT_EQ(a.corners, b.corners);
    ASSERT_EQ(a.bones.size(), b.bones.size());
    for (std::size_t j = 0; j < a.bones.size(); ++j) {
        EXPECT_EQ(a.bones[j].name, b.bones[j].name);
        expectSame(a.bones[j].offset, b.bones[j].offset, a.bones[j].name);
        std::map<std::uint32_t, float> weights;
        for (const SourceBone::Weight& entry : a.bones[j].weights)
            weights[entry.vertex] += entry.weight;
        for (const SourceBone::Weight& entry : b.bones[j].weights)
            weights[entry.vertex] -= entry.weight;
        for (const auto& [vertex, rest] : weights) EXPECT_NEAR(rest, 0.0f, kTolerance) << vertex;
    }
}

void expectSame(const osgSkin::SourceAnimation& a, const osgSkin::SourceAnimation& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_DOUBLE_EQ(a.ticksPerSecond, b.ticksPerSecond);
    std::map<std::string, const SourceTrack*> others;
    for (const SourceTrack& track : b.tracks) others[track.node] = &track;
    ASSERT_EQ(a.tracks.size(), others.size());
    for (const SourceTrack& track : a.tracks) {
        ASSERT_EQ(others.count(track.node), 1u) << track.node;
        const SourceTrack& other = *others[track.node];
        expectSame(track.positions, other.positions, track.node + " positions");
        expectSame(track.rotations, other.rotations, track.node + " rotations");
        expectSame(track.scales, other.scales, track.node + " scales");
    }
}

void expectSame(const SourceScene& a, const SourceScene& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t n = 0; n < a.nodes.size(); ++n) {
        const SourceNode &node = a.nodes[n], &other = b.nodes[n];
        if (n > 0) { // the common root of several roots has another name
            EXPECT_EQ(node.name, other.name);
        }
        EXPECT_EQ(node.parent, other.parent);
        EXPECT_EQ(node.children, other.children);
        EXPECT_EQ(node.meshes, other.meshes) << node.name;
        expectSame(node.matrix, other.matrix, node.name);
    }
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t m = 0; m < a.meshes.size(); ++m) expectSame(*a.meshes[m], *b.meshes[m]);
    ASSERT_EQ(a.animations.size(), b.animations.size());
    for (std::size_t c = 0; c < a.animations.size(); ++c)
        expectSame(*a.animations[c], *b.animations[c]);
}

} // namespace

TEST(SourceScene, GltfMatchesAssimp) {
    if (!isAssimp52()) GTEST_SKIP() << "needs Assimp 5.2, which keeps the order of vertices";
    const std::string models = "/usr/share/assimp/models/glTF2/";
    for (const std::string& file :
         {testData("rig/tube.gltf"), testData("rig/posed.gltf"), testData("rig/unskinned.gltf"),
          models + "simple_skin/simple_skin.gltf",
          models + "BoxTextured-glTF-Binary/BoxTextured.glb",
          models + "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_04.gltf",
          models + "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf",
          models + "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_12.gltf"}) {
        if (!std::filesystem::exists(file)) continue; // assimp-testmodels is not installed
        SCOPED_TRACE(file);
        const osgSkin::ReadLimits limits;
        expectSame(osgSkin::readGltf(file, limits), osgSkin::readAssimpScene(file, limits));
    }
}

TEST(SourceScene, ReadsSharedFilesOnce) {
    GltfColumn column;
    column.bend();
    const std::string file = column.save("read_once.gltf");
    const osg::ref_ptr<osgDB::Options> first = osgSkin::shareScenes(nullptr);
    EXPECT_EQ(osgSkin::importMesh(file, first).mesh.positions.size(), 24u);
    std::filesystem::remove(file);
    EXPECT_EQ(osgSkin::importSkeleton(file, first).joints.size(), 3u);
    EXPECT_GT(osgSkin::importMotion(file, 0, "bend", first).frames, 1u);
    const osg::ref_ptr<osgDB::Options> same = osgSkin::shareScenes(first);
    EXPECT_EQ(osgSkin::importRig(file, same).animations.size(), 1u);
    expectError([&] { osgSkin::importMesh(file, osgSkin::shareScenes(nullptr)); }, file);
    expectError([&] { osgSkin::importMesh(file); }, file);
}

TEST(SourceScene, ImportMotionKeepsSharedScene) {
    GltfColumn column; // in which only the clip gives the upper joint's position
    column.animate("grow", column.joints[2], "translation", {0, 1}, {0, 3, 0, 0, 3, 0});
    column.json["nodes"][column.joints[2]].erase("translation");
    const std::string file = column.save("offsets.gltf");
    const osg::ref_ptr<osgDB::Options> shared = osgSkin::shareScenes(nullptr);
    const osgSkin::RestSkeleton before = osgSkin::importSkeleton(file, shared);
    osgSkin::importMotion(file, 0, {}, shared);
    const osgSkin::RestSkeleton after = osgSkin::importSkeleton(file, shared);
    ASSERT_EQ(before.joints.size(), after.joints.size());
    for (std::size_t j = 0; j < before.joints.size(); ++j)
        EXPECT_EQ(before.joints[j].centre, after.joints[j].centre) << before.joints[j].name;
}

TEST(SourceScene, TextureCoordinateSetsMayHaveGaps) {
    GltfColumn column;
    const std::vector<double> halves(48, 0.5);
    column.attributes()["TEXCOORD_1"] = column.accessor("VEC2", halves);
    column.attributes()["TEXCOORD_3"] = column.accessor("VEC2", halves);
    EXPECT_EQ(osgSkin::importMesh(column.save("gaps.gltf")).mesh.positions.size(), 24u);
}
