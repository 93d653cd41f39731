// SPDX-License-Identifier: MIT
// A mesh and its bone with one name, in formats that refer to bones by name.
#include "Paths.h"

#include <osgSkinImport/ImportRig>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osgAnimation/Bone>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace {

/// Our tube exported as FBX, with its mesh called `name` and first among the root's children.
std::string exportedTube(const std::string& name) {
    Assimp::Importer importer;
    importer.ReadFile(testData("rig/tube.gltf"), 0);
    aiScene* scene = importer.GetOrphanedScene();
    EXPECT_NE(scene, nullptr);
    aiNode& root = *scene->mRootNode;
    for (unsigned c = 0; c < root.mNumChildren; ++c)
        if (root.mChildren[c]->mNumMeshes > 0) {
            root.mChildren[c]->mName = "tube of skin";
            std::swap(root.mChildren[0], root.mChildren[c]);
        }
    std::string path = testing::TempDir() + "tube_" + name + ".fbx";
    Assimp::Exporter exporter;
    EXPECT_EQ(exporter.Export(scene, "fbxa", path), AI_SUCCESS) << exporter.GetErrorString();
    delete scene;
    // FBX identifies its models by numbers; Assimp by their names.
    std::ifstream in(path);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string given = "\"Model::tube of skin\"";
    const std::size_t at = text.find(given);
    EXPECT_NE(at, std::string::npos);
    if (at != std::string::npos) text.replace(at, given.size(), "\"Model::" + name + "\"");
    std::ofstream(path) << text;
    return path;
}

std::map<std::string, double> weightsOfBones(const osgSkin::ImportedRig& rig) {
    std::map<std::string, double> sums;
    for (const osgSkin::BoneWeights& bone : rig.body.weights)
        for (const auto& entry : bone.entries) sums[bone.bone] += entry.weight;
    return sums;
}

void expectSame(const osgSkin::ImportedRig& found, const osgSkin::ImportedRig& expected) {
    ASSERT_EQ(found.rest.joints.size(), expected.rest.joints.size());
    for (std::size_t j = 0; j < expected.rest.joints.size(); ++j) {
        EXPECT_EQ(found.rest.joints[j].name, expected.rest.joints[j].name);
        EXPECT_EQ(found.rest.joints[j].parent, expected.rest.joints[j].parent);
        EXPECT_LT(glm::distance(found.rest.joints[j].centre, expected.rest.joints[j].centre),
                  1e-4 * (1.0 + expected.body.mesh.size()));
    }
    EXPECT_EQ(weightsOfBones(found), weightsOfBones(expected));
    ASSERT_EQ(found.animations.size(), expected.animations.size());
    for (std::size_t a = 0; a < expected.animations.size(); ++a) {
        const auto& theirs = expected.animations[a]->getChannels();
        const auto& ours = found.animations[a]->getChannels();
        ASSERT_EQ(ours.size(), theirs.size());
        for (std::size_t c = 0; c < theirs.size(); ++c) {
            EXPECT_EQ(ours[c]->getTargetName(), theirs[c]->getTargetName());
            EXPECT_EQ(ours[c]->getEndTime(), theirs[c]->getEndTime());
        }
    }
}

/// An X file: its mesh's frame has the name of one of its bones.
std::string xFile(const std::string& mesh) {
    const std::string unit = "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,";
    std::string path = testing::TempDir() + "twin_" + mesh + ".x";
    std::ofstream(path) << "xof 0303txt 0032\nFrame Root {\n FrameTransformMatrix { " << unit
                        << "0.0,0.0,0.0,1.0;; }\n"
                        << " Frame " << mesh << " {\n  FrameTransformMatrix { " << unit
                        << "0.0,0.0,0.0,1.0;; }\n"
                        << "  Mesh {\n   4; 0;0;0;, 1;0;0;, 1;4;0;, 0;4;0;;\n   1; 4;0,1,2,3;;\n"
                        << "   XSkinMeshHeader { 1; 1; 2; }\n"
                        << "   SkinWeights { \"Hips\"; 2; 0,1; 1.0,1.0; " << unit
                        << "0.0,0.0,0.0,1.0;; }\n"
                        << "   SkinWeights { \"Torso\"; 2; 2,3; 1.0,1.0; " << unit
                        << "0.0,-2.0,0.0,1.0;; }\n  }\n }\n"
                        << " Frame Hips {\n  FrameTransformMatrix { " << unit
                        << "0.0,0.0,0.0,1.0;; }\n"
                        << "  Frame Torso {\n   FrameTransformMatrix { " << unit
                        << "0.0,2.0,0.0,1.0;; }\n  }\n }\n}\n";
    return path;
}

} // namespace

TEST(SharedNames, Fbx) {
    const osgSkin::ImportedRig plain = osgSkin::importRig(exportedTube("skin"));
    const osgSkin::ImportedRig twin = osgSkin::importRig(exportedTube("arm"));
    expectSame(twin, plain);
}

TEST(SharedNames, DirectX) {
    const osgSkin::ImportedRig plain = osgSkin::importRig(xFile("Body"));
    ASSERT_EQ(plain.rest.joints.size(), 2u);
    EXPECT_NEAR(plain.rest.joints[1].centre.y, 2.0, 1e-6);
    expectSame(osgSkin::importRig(xFile("Torso")), plain);
}
