// SPDX-License-Identifier: MIT
// The formats of osgskinbake beside OBJ hold the same frames, and are what their standards ask for.
#include "Command.h"
#include "ReferenceSkin.h"

#include <osgSkinImport/ImportMesh>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace {

const std::string kThrower = "'" OSGSKIN_DATA "/thrower.skin' ";

std::string readBytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <typename Number>
Number at(const std::string& bytes, std::size_t offset) {
    Number value{};
    EXPECT_LE(offset + sizeof value, bytes.size());
    if (offset + sizeof value <= bytes.size())
        std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

glm::dvec3 vectorAt(const std::string& bytes, std::size_t offset) {
    return {double(at<float>(bytes, offset)), double(at<float>(bytes, offset + 4)),
            double(at<float>(bytes, offset + 8))};
}

/// A folder with frames 10, 15 and 20 as OBJ, and what else `arguments` ask for.
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

/// A .glb file, its two chunks apart.
struct Glb {
    explicit Glb(const std::string& file) {
        const std::string bytes = readBytes(file);
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(at<std::uint32_t>(bytes, 4), 2u);
        EXPECT_EQ(at<std::uint32_t>(bytes, 8), bytes.size());
        const auto length = at<std::uint32_t>(bytes, 12);
        EXPECT_EQ(bytes.substr(16, 4), "JSON");
        EXPECT_EQ(length % 4, 0u);
        json = nlohmann::json::parse(bytes.substr(20, length));
        EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
        binary = bytes.substr(28 + length);
        EXPECT_EQ(at<std::uint32_t>(bytes, 20 + length), binary.size());
    }

    /// The bytes of an accessor, which must be as many as its type takes.
    std::string data(std::size_t index) const {
        const nlohmann::json& accessor = json["accessors"].at(index);
        const nlohmann::json& view =
            json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
        const std::size_t begin = view["byteOffset"], size = view["byteLength"];
        EXPECT_EQ(begin % 4, 0u);
        EXPECT_LE(begin + size, binary.size());
        const std::size_t components = accessor["type"] == "VEC3" ? 3 : 1;
        EXPECT_EQ(size, 4 * components * std::size_t(accessor["count"]));
        return binary.substr(begin, size);
    }

    std::vector<glm::dvec3> vectors(std::size_t index) const {
        const std::string bytes = data(index);
        std::vector<glm::dvec3> result;
        for (std::size_t offset = 0; offset < bytes.size(); offset += 12)
            result.push_back(vectorAt(bytes, offset));
        return result;
    }

    nlohmann::json json;
    std::string binary;
};

} // namespace

TEST(BakeFormats, PlyHoldsTheFramesAndTheFaces) {
    const Baked baked("frame_%02d.ply");
    const osgSkin::ImportedMesh body = osgSkin::importMesh(OSGSKIN_DATA "/thrower.obj");
    const osgSkin::ImportedMesh frame = osgSkin::importMesh(baked.folder + "/frame_15.ply");
    EXPECT_EQ(frame.mesh.faceSizes, body.mesh.faceSizes);
    EXPECT_EQ(frame.mesh.faceVertices, body.mesh.faceVertices);
    ASSERT_EQ(frame.mesh.positions.size(), baked.frames[1].size());
    for (std::size_t v = 0; v < baked.frames[1].size(); ++v)
        EXPECT_LT(glm::distance(frame.mesh.positions[v], baked.frames[1][v]), 1e-6 * baked.height);
}

TEST(BakeFormats, PointCacheHoldsAllFrames) {
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

TEST(BakeFormats, GlbGoesFromFrameToFrameByMorphTargets) {
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

TEST(BakeFormats, GlbOfOneFrameStandsStill) {
    const std::string folder = test::makeTestFolder();
    ASSERT_EQ(test::runBake(kThrower + "--frames 3 --out one.glb", folder).status, 0);
    const Glb glb(folder + "/one.glb");
    EXPECT_EQ(glb.json.count("animations"), 0u);
    EXPECT_EQ(glb.json["meshes"][0]["primitives"][0].count("targets"), 0u);
}

/// Khronos' own validator, where `npm install gltf-validator` has put it on NODE_PATH.
TEST(BakeFormats, GlbPassesTheKhronosValidator) {
    const std::string probe = "node -e \"require('gltf-validator')\" >/dev/null 2>&1";
    if (std::system(probe.c_str()) != 0)
        GTEST_SKIP() << "needs node and the package gltf-validator on NODE_PATH";
    const Baked baked("all.glb");
    const std::string script =
        "const v=require('gltf-validator'),f=require('fs');"
        "v.validateBytes(new Uint8Array(f.readFileSync(process.argv[1]))).then(r=>"
        "{console.error(JSON.stringify(r.issues));process.exit(r.issues.numErrors?1:0)})";
    const std::string command = "node -e \"" + script + "\" '" + baked.folder + "/all.glb'";
    EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(BakeFormats, OtherEndingsAreBadUsage) {
    const std::string folder = test::makeTestFolder();
    const auto result = test::runBake(kThrower + "--frames 3 --out frame.fbx", folder);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("expected a name that ends in .obj"), std::string::npos)
        << result.err;
    const auto unwritable =
        test::runBake(kThrower + "--frames 3 --out no/such/folder/a.pc2", folder);
    EXPECT_EQ(unwritable.status, 1);
    EXPECT_NE(unwritable.err.find("a.pc2: cannot be written"), std::string::npos) << unwritable.err;
}
