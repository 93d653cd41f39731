// SPDX-License-Identifier: MIT
// osgskinbake's other formats have the same frames as OBJ, and conform to their standards.
#include "Command.h"
#include "ExpectContains.h"
#include "GlbFile.h"
#include "ReferenceSkin.h"

#include <osgSkinImport/ImportMesh>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using test::at;
using test::Glb;
using test::readBytes;
using test::vectorAt;

const std::string kThrower = "'" OSGSKIN_DATA "/thrower.skin' ";

/// A folder with frames 10, 15 and 20 as OBJ, and any other outputs of `arguments`.
struct Baked {
    explicit Baked(const std::string& out) : folder(test::makeTestFolder()) {
        for (const std::string& name : {std::string("frame_%02d.obj"), out}) {
            const auto result = test::runBake(kThrower + "--frames 10:20:5 --out " + name, folder);
            EXPECT_EQ(result.status, 0) << result.err;
        }
        for (const char* frame : {"10", "15", "20"})
            frames.push_back(test::readObjVertices(folder + "/frame_" + frame + ".obj"));
        for (const glm::dvec3& v : frames[0]) height = std::max(height, std::abs(v.y));
    }
    std::string folder;
    std::vector<std::vector<glm::dvec3>> frames;
    double height = 0.0;
};

} // namespace

TEST(BakeFormats, PlyHasTheFramesAndTheFaces) {
    const Baked baked("frame_%02d.ply");
    const osgSkin::ImportedMesh body = osgSkin::importMesh(OSGSKIN_DATA "/thrower.obj");
    const osgSkin::ImportedMesh frame = osgSkin::importMesh(baked.folder + "/frame_15.ply");
    EXPECT_EQ(frame.mesh.faceSizes, body.mesh.faceSizes);
    EXPECT_EQ(frame.mesh.faceVertices, body.mesh.faceVertices);
    ASSERT_EQ(frame.mesh.positions.size(), baked.frames[1].size());
    for (std::size_t v = 0; v < baked.frames[1].size(); ++v)
        EXPECT_LT(glm::distance(frame.mesh.positions[v], baked.frames[1][v]), 1e-6 * baked.height);
}

TEST(BakeFormats, PointCacheHasAllFrames) {
    const Baked baked("all.pc2");
    const std::string bytes = readBytes(baked.folder + "/all.pc2");
    const std::size_t points = baked.frames[0].size();
    ASSERT_EQ(bytes.size(), 32 + 3 * points * 12);
    EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
    EXPECT_EQ(at<std::int32_t>(bytes, 12), 1);
    EXPECT_EQ(at<std::int32_t>(bytes, 16), std::int32_t(points));
    EXPECT_EQ(at<float>(bytes, 20), 10.0f);
    EXPECT_EQ(at<float>(bytes, 24), 1.0f);
    EXPECT_EQ(at<std::int32_t>(bytes, 28), 3);
    for (std::size_t f = 0; f < 3; ++f)
        for (std::size_t v = 0; v < points; ++v)
            ASSERT_LT(
                glm::distance(vectorAt(bytes, 32 + 12 * (f * points + v)), baked.frames[f][v]),
                1e-6 * baked.height);
}

TEST(BakeFormats, GlbBlendsFramesByMorphTargets) {
    const Baked baked("all.glb");
    const Glb glb(baked.folder + "/all.glb");
    const nlohmann::json& primitive = glb.json["meshes"][0]["primitives"][0];
    const auto base = glb.vectors(primitive["attributes"]["POSITION"]);
    ASSERT_EQ(base.size(), baked.frames[0].size());
    ASSERT_EQ(primitive["targets"].size(), 2u);
    for (std::size_t v = 0; v < base.size(); ++v)
        ASSERT_LT(glm::distance(base[v], baked.frames[0][v]), 1e-6 * baked.height);
    for (std::size_t f = 1; f < 3; ++f) {
        const auto moved = glb.vectors(primitive["targets"][f - 1]["POSITION"]);
        for (std::size_t v = 0; v < base.size(); ++v)
            ASSERT_LT(glm::distance(base[v] + moved[v], baked.frames[f][v]), 1e-6 * baked.height);
    }
    const nlohmann::json& sampler = glb.json["animations"][0]["samplers"][0];
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    const std::string times = glb.data(sampler["input"]), weights = glb.data(sampler["output"]);
    ASSERT_EQ(times.size(), 12u);
    ASSERT_EQ(weights.size(), 24u);
    EXPECT_EQ(at<float>(times, 0), 0.0f);
    EXPECT_NEAR(at<float>(times, 8), 2.0f * at<float>(times, 4), 1e-6f);
    const float expected[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (std::size_t f = 0; f < 3; ++f)
        for (std::size_t target = 0; target < 2; ++target)
            EXPECT_EQ(at<float>(weights, 4 * (2 * f + target)), expected[f][target]);
    const std::string indices = glb.data(primitive["indices"]);
    for (std::size_t offset = 0; offset < indices.size(); offset += 4)
        ASSERT_LT(at<std::uint32_t>(indices, offset), base.size());
    // The range of positions is required, and must be that of the stored numbers.
    const nlohmann::json& accessor =
        glb.json["accessors"][std::size_t(primitive["targets"][1]["POSITION"])];
    float low = 1e30f;
    for (const glm::dvec3& v : glb.vectors(primitive["targets"][1]["POSITION"]))
        low = std::min(low, float(v.y));
    EXPECT_EQ(float(accessor["min"][1]), low);
}

TEST(BakeFormats, GlbOfOneFrameHasNoAnimation) {
    const std::string folder = test::makeTestFolder();
    ASSERT_EQ(test::runBake(kThrower + "--frames 3 --out one.glb", folder).status, 0);
    const Glb glb(folder + "/one.glb");
    EXPECT_EQ(glb.json.count("animations"), 0u);
    EXPECT_EQ(glb.json["meshes"][0]["primitives"][0].count("targets"), 0u);
}

TEST(BakeFormats, GlbPassesTheKhronosValidator) {
    std::string why;
    if (!test::hasGlbValidator(why)) GTEST_SKIP() << why;
    const Baked baked("all.glb");
    EXPECT_EQ(test::glbComplaints(baked.folder + "/all.glb"), "");
}

TEST(BakeFormats, RejectsOtherExtensions) {
    const std::string folder = test::makeTestFolder();
    const auto result = test::runBake(kThrower + "--frames 3 --out frame.fbx", folder);
    EXPECT_EQ(result.status, 2);
    test::expectContains(result.err, "expected a name that ends in .obj");
    const auto unwritable =
        test::runBake(kThrower + "--frames 3 --out no/such/folder/a.pc2", folder);
    EXPECT_EQ(unwritable.status, 1);
    test::expectContains(unwritable.err, "a.pc2: cannot be written");
}
