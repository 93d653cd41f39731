// SPDX-License-Identifier: MIT
// Results for Assimp's test models (Debian: assimp-testmodels), including broken ones: read, or
// refused with a reason, but never a crash.
#include "assimp/EditedFile.h"

#include "ExpectError.h"
#include "LeaksOfOthers.h"
#include "MeshParts.h"
#include "Paths.h"
#include "RiggedModels.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <osg/Geometry>
#include <osg/Texture2D>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace {

using test::kModels;
using test::kRigged;
using test::Rigged;

std::vector<std::filesystem::path> allModels() {
    std::vector<std::filesystem::path> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kModels))
        if (entry.is_regular_file()) result.push_back(entry.path());
    std::sort(result.begin(), result.end());
    return result;
}

/// Whether a file has a format for trusted files only: Assimp leaks memory on errors.
bool isForTrustedOnly(const std::filesystem::path& file) {
    const std::string ours[] = {".obj", ".ply", ".bvh", ".gltf", ".glb", ".vrm", ".vrma"};
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::find(std::begin(ours), std::end(ours), extension) == std::end(ours);
}

} // namespace

TEST(EditedFile, IsThatOfFbxAndCollada) {
    Assimp::Importer importer;
    const std::string fbx = testing::TempDir() + "edited.fbx", obj = testing::TempDir() + "a.obj",
                      dae = testing::TempDir() + "edited.dae";
    std::ofstream(fbx) << "; FBX 7.4.0 project file\n";
    std::ofstream(obj) << "v 0 0 0\n";
    EXPECT_EQ(osgSkin::editFile(obj, {}, importer), "");
    EXPECT_TRUE(importer.IsDefaultIOHandler());
    EXPECT_EQ(osgSkin::editFile(fbx, {}, importer), "; FBX 7.4.0 project file\n");
    EXPECT_FALSE(importer.IsDefaultIOHandler());
    std::ofstream(dae) << R"(<controller id="a"><skin source="#b"></skin></controller>)"
                       << R"(<controller id="b"><skin source="#a"></skin></controller>)";
    expectError([&] { osgSkin::editFile(dae, {}, importer); }, "expected one of a mesh");
}

/// Each was looked for among all others.
TEST(EditedFile, FollowsLongChainsOfMorphs) {
    Assimp::Importer importer;
    const std::string dae = testing::TempDir() + "chain.dae";
    std::ofstream out(dae);
    const std::size_t count = 30'000;
    for (std::size_t m = 0; m < count; ++m)
        out << "<controller id='m" << m << "'><morph source='#m" << m + 1 << "'/></controller>";
    out << "<controller id='s'><skin source='#m0'/></controller><instance_controller url='#m9'/>"
           "<controller id='c'><morph source='#d'/></controller><controller id='d'>"
           "<morph source='#c'/></controller>";
    out.close();
    const std::clock_t begin = std::clock();
    osgSkin::editFile(dae, {}, importer);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 3.0);
    Assimp::IOStream* const edited = importer.GetIOHandler()->Open(dae.c_str(), "rb");
    std::string bytes(edited->FileSize(), ' ');
    edited->Read(bytes.data(), 1, bytes.size());
    importer.GetIOHandler()->Close(edited);
    EXPECT_EQ(bytes, "<controller id='s'><skin source='#m" + std::to_string(count) +
                         "'/></controller><instance_controller url='#m" + std::to_string(count) +
                         "'/>");
}

TEST(EditedFile, RejectsDeepCollada) {
    Assimp::Importer importer;
    const std::string dae = testing::TempDir() + "deep.dae";
    const auto edit = [&](int depth) {
        std::ofstream out(dae);
        for (int k = 0; k < 2000; ++k) out << "<a b='>'/><!-- <c> --><![CDATA[<d>]]><e></e>";
        for (int k = 0; k < depth; ++k) out << "<node>";
        out.close();
        osgSkin::editFile(dae, {}, importer);
    };
    EXPECT_NO_THROW(edit(1064));
    expectError([&] { edit(1065); }, "nested more than 1064 deep (option maxDepth)");
}

TEST(AssimpModels, SaysWhichFormatsLoseTheirBones) {
    OSGSKIN_NEEDS(kModels);
    expectError([] { osgSkin::importRig(std::string(kModels) + "/IQM/mrfixit.iqm"); },
                "Assimp reads no bones of .iqm files");
}

TEST(AssimpModels, ReadsRiggedModels) {
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

/// The file has weights for joint3 and joint4, but no frames for them.
TEST(AssimpModels, BonesWithoutNodeFollowNeighbours) {
    OSGSKIN_NEEDS(kModels);
    const osgSkin::ImportedRig rig = osgSkin::importRig(std::string(kModels) + "X/anim_test.x");
    const std::vector<osgSkin::RestJoint>& joints = rig.rest.joints;
    ASSERT_EQ(joints.size(), 4u);
    double height = -4.8; // of a cylinder from -5 to 5: joint1's
    for (int j = 0; j < 4; ++j) {
        const osgSkin::RestJoint& joint = joints[std::size_t(j)];
        EXPECT_EQ(joint.name, "joint" + std::to_string(j + 1));
        EXPECT_EQ(joint.parent, j - 1);
        EXPECT_NEAR(joint.centre.x, 0.0, 1e-3);
        EXPECT_GT(joint.centre.y, height + (j > 0 ? 1.0 : -0.1));
        height = joint.centre.y;
    }
    EXPECT_LT(height, 5.0);
    // The weights of every vertex sum to 1.
    std::vector<double> sums(rig.body.mesh.positions.size(), 0.0);
    for (const osgSkin::BoneWeights& weights : rig.body.weights)
        for (const auto& entry : weights.entries) sums[entry.vertex] += entry.weight;
    for (const double sum : sums) EXPECT_NEAR(sum, 1.0, 1e-3);
}

TEST(AssimpModels, ReadsEmbeddedTextures) {
    OSGSKIN_NEEDS(kModels);
    const osgSkin::ImportedRig rig =
        osgSkin::importRig(std::string(kModels) + "MDL/MDL (HL1)/alpha_test.mdl");
    ASSERT_EQ(rig.body.parts.size(), 1u);
    const osg::Image* const image = imageOf(rig.body.parts[0]);
    ASSERT_NE(image, nullptr);
    ASSERT_EQ(image->s(), 512);
    EXPECT_EQ(image->getColor(0, 0), osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f));
    EXPECT_GT(image->getColor(256, 256).r(), 0.7f);
}

TEST(AssimpModels, RejectsOthersWithReason) {
    OSGSKIN_NEEDS(kModels);
    std::map<std::string, std::size_t> reasons;
    std::size_t read = 0;
    for (const std::filesystem::path& file : allModels()) {
        try {
            const test::LeaksOfOthers leaks(isForTrustedOnly(file));
            osgSkin::importRig(file.string());
            ++read;
            const std::string name = std::filesystem::relative(file, kModels).string();
            const bool known =
                std::any_of(std::begin(kRigged), std::end(kRigged),
                            [&](const Rigged& rigged) { return name == rigged.file; });
            EXPECT_TRUE(known || !isAssimp52()) << name << " is rigged, and not on the list";
        } catch (const osgSkin::Error& error) {
            const std::string what = error.what();
            EXPECT_EQ(what.rfind(file.string() + ": ", 0), 0u) << what;
            EXPECT_GT(what.size(), file.string().size() + 5) << what;
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            ++reasons[what.substr(file.string().size() + 2, 30)];
        }
    }
    EXPECT_GE(read, std::size(kRigged));
    EXPECT_GT(reasons["no mesh with bones, expected a"], 200u);
}

/// As the mesh, the skeleton and the motions of a `.skin` file.
TEST(AssimpModels, ReadsOrRejectsMeshSkeletonAndMotion) {
    OSGSKIN_NEEDS(kModels);
    std::size_t read = 0, refused = 0;
    const auto attempt = [&](const std::string& file, const auto& import) {
        try {
            const test::LeaksOfOthers leaks(isForTrustedOnly(file));
            import(file);
            ++read;
        } catch (const osgSkin::Error& error) {
            const std::string what = error.what();
            EXPECT_EQ(what.rfind(file, 0), 0u) << what;
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            ++refused;
        }
    };
    for (const std::filesystem::path& file : allModels()) {
        attempt(file.string(), [](const std::string& f) { osgSkin::importMesh(f); });
        attempt(file.string(), [](const std::string& f) { osgSkin::importSkeleton(f); });
        attempt(file.string(), [](const std::string& f) { osgSkin::importMotion(f); });
    }
    EXPECT_GT(read, 300u);
    EXPECT_GT(refused, 300u);
}

TEST(AssimpModels, RejectsInvalidMeshes) {
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
