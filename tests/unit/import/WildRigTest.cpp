// SPDX-License-Identifier: MIT
//
// Rigs that are legal and unusual: FBX files with connections of properties, Collada skins and
// morphs of each other, glTF joints outside the scene, Half-Life's bones.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Paths.h"
#include "RiggedModels.h"
#include "TextFile.h"

#include <osgSkinImport/ImportRig>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace {

using osgSkin::ImportedRig;
using osgSkin::importRig;

void expectStrip(const ImportedRig& rig) {
    EXPECT_EQ(rig.body.mesh.positions.size(), 4u);
    ASSERT_EQ(rig.rest.joints.size(), 2u);
    EXPECT_EQ(rig.rest.joints[1].name, "high");
    EXPECT_NEAR(rig.rest.joints[1].centre.y, 2.0, 1e-6);
    ASSERT_EQ(rig.body.weights.size(), 2u);
    EXPECT_EQ(rig.body.weights[0].entries.size() + rig.body.weights[1].entries.size(), 4u);
}

/// A file of a triangle with a bone, a morph controller, and a skin, for which the sources and the
/// controller in the scene are filled in.
std::string collada(const std::string& morphOf, const std::string& skinOf,
                    const std::string& shown) {
    std::string text = test::fileText(testData("rig/controllers.dae"));
    for (const auto& [word, id] :
         {std::pair("MORPH_SOURCE", morphOf), {"SKIN_SOURCE", skinOf}, {"SHOWN", shown}})
        text.replace(text.find(word), std::string(word).size(), id);
    return test::saveText("controllers.dae", text);
}

} // namespace

/// In the driven files, a constraint's weight drives a bone.
TEST(WildRig, FbxPropertyConnections) {
    for (const char* name : {"strip_binary", "strip_text", "driven_binary", "driven_text"}) {
        SCOPED_TRACE(name);
        expectStrip(importRig(testData(std::string("rig/") + name + ".fbx")));
    }
}

TEST(WildRig, ColladaSkinOfMorph) {
    for (const auto& [morphOf, skinOf, shown] :
         {std::array<const char*, 3>{"#base", "#base", "#bound"},
          {"#base", "#face", "#bound"},
          {"#bound", "#base", "#face"}}) {
        SCOPED_TRACE(shown);
        const ImportedRig rig = importRig(collada(morphOf, skinOf, shown));
        ASSERT_EQ(rig.body.weights.size(), 1u);
        EXPECT_EQ(rig.body.weights[0].bone, "bone");
        EXPECT_EQ(rig.body.weights[0].entries.size(), 3u);
    }
}

TEST(WildRig, RejectsCyclicColladaControllers) {
    expectError([] { importRig(collada("#bound", "#face", "#bound")); }, "expected one of a mesh");
}

TEST(WildRig, JointsOutsideTheScene) {
    test::GltfColumn column;
    column.bend();
    column.json["scenes"][0]["nodes"] = {column.meshNode};
    const ImportedRig rig = importRig(column.save("outside.gltf"));
    ASSERT_EQ(rig.rest.joints.size(), 3u);
    EXPECT_EQ(rig.rest.joints[2].name, "top");
    EXPECT_LT(glm::distance(rig.rest.joints[2].centre, glm::dvec3(0, 2, 0)), 1e-6);
    EXPECT_EQ(rig.body.weights.size(), 3u);
    EXPECT_EQ(rig.animations.size(), 1u);
}

/// Assimp lists all bones of such a model as children of one node.
TEST(WildRig, HalfLifeBoneHierarchy) {
    const std::string path = std::string(test::kModels) + "MDL/MDL (HL1)/man.mdl";
    OSGSKIN_NEEDS(path);
    const osgSkin::RestSkeleton rest = importRig(path).rest;
    std::size_t deepest = 0;
    for (const osgSkin::RestJoint& joint : rest.joints) {
        std::size_t depth = 0;
        for (int up = joint.parent; up >= 0; up = rest.joints[std::size_t(up)].parent) ++depth;
        deepest = std::max(deepest, depth);
    }
    EXPECT_GE(deepest, 2u);
}
