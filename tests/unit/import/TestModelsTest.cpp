// SPDX-License-Identifier: MIT
// What becomes of the test models of Assimp's makers (Debian: assimp-testmodels), the broken ones
// among them: read, or refused with a reason, and never a crash.
#include "Paths.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportRig>

#include <algorithm>
#include <map>

namespace {

const char* const kModels = "/usr/share/assimp/models/";

/// A rigged model and what is read from it.
struct Rigged {
    const char* file;
    std::size_t joints, vertices, clips;
};

const Rigged kRigged[] = {
    {"Collada/box_nested_animation.dae", 1, 36, 1},
    {"FBX/animation_with_skeleton.fbx", 15, 4224, 1},
    {"FBX/huesitos.fbx", 10, 256, 1},
    {"MD5/SimpleCube.md5mesh", 2, 36, 0},
    {"MDL/MDL (HL1)/alpha_test.mdl", 1, 24, 1},
    {"MDL/MDL (HL1)/blend_additive.mdl", 1, 6, 1},
    {"MDL/MDL (HL1)/chrome_sphere.mdl", 1, 242, 1},
    {"MDL/MDL (HL1)/duplicate_bodyparts.mdl", 1, 27, 1},
    {"MDL/MDL (HL1)/duplicate_sequence_groups/duplicate_sequence_groups.mdl", 1, 3, 9},
    {"MDL/MDL (HL1)/duplicate_sequences.mdl", 1, 3, 9},
    {"MDL/MDL (HL1)/duplicate_submodels.mdl", 1, 18, 1},
    {"MDL/MDL (HL1)/man.mdl", 7, 239, 6},
    {"MDL/MDL (HL1)/sequence_transitions.mdl", 1, 3, 7},
    {"MDL/MDL (HL1)/unnamed_bodyparts.mdl", 1, 27, 1},
    {"MDL/MDL (HL1)/unnamed_bones.mdl", 9, 192, 1},
    {"MDL/MDL (HL1)/unnamed_sequence_groups/unnamed_sequence_groups.mdl", 1, 3, 9},
    {"MDL/MDL (HL1)/unnamed_sequences.mdl", 1, 3, 9},
    {"SMD/WusonSMD.smd", 1, 11196, 1},
    {"SMD/holy_grailref.smd", 1, 2688, 1},
    {"SMD/triangle.smd", 1, 3, 1},
    {"X/BCN_Epileptic.X", 54, 15378, 1},
    {"X/Testwuson.X", 38, 11196, 3},
    {"X/anim_test.x", 2, 2520, 1},
    {"X/test_cube_binary.x", 1, 36, 0},
    {"X/test_cube_compressed.x", 1, 36, 0},
    {"X/test_cube_text.x", 1, 36, 0},
    {"glTF2/simple_skin/simple_skin.gltf", 2, 10, 1},
};

/// Files of other makers that Assimp 5.2.5 takes seconds to read; they are not rigged.
bool isSlow(const std::filesystem::path& file) {
    return std::filesystem::file_size(file) > (4u << 20);
}

std::vector<std::filesystem::path> allModels() {
    std::vector<std::filesystem::path> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kModels))
        if (entry.is_regular_file() && !isSlow(entry.path())) result.push_back(entry.path());
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace

TEST(TestModels, RiggedOnesAreReadWhole) {
    OSGSKIN_NEEDS(kModels);
    for (const Rigged& expected : kRigged) {
        SCOPED_TRACE(expected.file);
        try {
            const osgSkin::ImportedRig rig =
                osgSkin::importRig(std::string(kModels) + expected.file);
            EXPECT_EQ(rig.rest.joints.size(), expected.joints);
            EXPECT_EQ(rig.body.mesh.positions.size(), expected.vertices);
            EXPECT_EQ(rig.animations.size(), expected.clips);
            EXPECT_FALSE(rig.body.weights.empty());
        } catch (const osgSkin::Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
}

TEST(TestModels, AllOthersAreRefusedWithAReason) {
    OSGSKIN_NEEDS(kModels);
    std::map<std::string, std::size_t> reasons;
    std::size_t read = 0;
    for (const std::filesystem::path& file : allModels()) {
        try {
            osgSkin::importRig(file.string());
            ++read;
            const std::string name = std::filesystem::relative(file, kModels).string();
            const bool known =
                std::any_of(std::begin(kRigged), std::end(kRigged),
                            [&](const Rigged& rigged) { return name == rigged.file; });
            EXPECT_TRUE(known) << name << " is rigged, and not on the list";
        } catch (const osgSkin::Error& error) {
            const std::string what = error.what();
            EXPECT_EQ(what.rfind(file.string() + ": ", 0), 0u) << what;
            EXPECT_GT(what.size(), file.string().size() + 5) << what;
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            ++reasons[what.substr(file.string().size() + 2, 30)];
        }
    }
    EXPECT_EQ(read, std::size(kRigged));
    EXPECT_GT(reasons["no mesh with bones, expected a"], 200u);
}

TEST(TestModels, BrokenOnesAreRefusedAsMeshesToo) {
    OSGSKIN_NEEDS(kModels);
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(kModels) + "invalid")) {
        const std::string file = entry.path().string();
        try {
            osgSkin::importMesh(file);
            ADD_FAILURE() << file << " was read";
        } catch (const osgSkin::Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind(file, 0), 0u) << error.what();
        }
    }
}
