// SPDX-License-Identifier: MIT
// Files that third-party readers trusted: each took excessive memory or time, or crashed the
// program.
#include "ExpectError.h"
#include "Glb.h"
#include "MeshParts.h"
#include "Paths.h"
#include "TextFile.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinImport/ReadScene>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/Group>
#include <osgDB/FileNameUtils>
#include <osgDB/WriteFile>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ostream>
#include <string>

#ifndef _WIN32
#include <sys/stat.h>
#endif

namespace {

using test::glb;
using test::saveText;

struct Guarded {
    const char* name; ///< of a file
    std::string content;
    const char* message;
};

void PrintTo(const Guarded& file, std::ostream* out) {
    *out << file.name;
}

const std::string kPlyVertices = "element vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\n";
const std::string kPlyFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyTriangle = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Joints without channels below one with a channel.
std::string bvh(std::size_t joints, std::size_t frames, bool nested) {
    std::string text = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (std::size_t j = 0; j < joints; ++j)
        text += "JOINT " + std::to_string(j) + "\n{\nOFFSET 0 1 0\n" + (nested ? "" : "}\n");
    for (std::size_t j = 0; nested && j < joints; ++j) text += "}\n";
    text += "}\nMOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: .1\n";
    for (std::size_t f = 0; f < frames; ++f) text += "0\n";
    return text;
}

std::string repeated(std::size_t count, const std::function<std::string(std::size_t)>& text) {
    std::string result;
    for (std::size_t i = 0; i < count; ++i) result += (i > 0 ? "," : "") + text(i);
    return result;
}

std::string gltf(const std::string& parts) {
    return R"({"asset":{"version":"2.0"},)" + parts + "}";
}

/// Nested lists.
std::string nested(std::size_t lists) {
    return std::string(lists, '[') + std::string(lists, ']');
}

/// Keys at 0 and 1e30 seconds; the values are zeros without a buffer view.
const std::string kLongSpline =
    gltf(R"("buffers":[{"byteLength":8,"uri":"data:;base64,AAAAAMrySXE="}],
"bufferViews":[{"buffer":0,"byteLength":8}],"nodes":[{}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"SCALAR","count":2},
             {"componentType":5126,"type":"VEC3","count":6}],
"animations":[{"samplers":[{"input":0,"output":1,"interpolation":"CUBICSPLINE"}],
               "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])");

/// Positions with a sparse change of number 9, if there are so many.
std::string sparse(std::size_t vertices, int indexType, const std::string& primitive = "",
                   const std::string& mesh = "") {
    return gltf(R"("buffers":[{"byteLength":16,"uri":"data:;base64,CQAAAAAAAAAAAAAAAAAAAA=="}],
"bufferViews":[{"buffer":0,"byteLength":4},{"buffer":0,"byteOffset":4,"byteLength":12}],
"accessors":[{"componentType":5126,"type":"VEC3","count":)" +
                std::to_string(vertices) +
                R"(,"sparse":{"count":1,"values":{"bufferView":1},
    "indices":{"bufferView":0,"componentType":)" +
                std::to_string(indexType) + R"(}}}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0})" +
                primitive + "}]" + mesh + "}]");
}

/// Nodes that instance one mesh, each with its own weights: each copies all primitives.
const std::string kManyCopies = gltf(
    R"("accessors":[{"componentType":5126,"type":"VEC3","count":0}],
"meshes":[{"primitives":[)" +
    repeated(1000, [](std::size_t) { return R"({"attributes":{"POSITION":0}})"; }) +
    R"(]}],"nodes":[)" +
    repeated(1000,
             [](std::size_t i) { return R"({"mesh":0,"weights":[)" + std::to_string(i) + "]}"; }) +
    "]");

std::string plyOfManyElements() {
    std::string text = "ply\nformat ascii 1.0\n";
    for (int i = 0; i < 200; ++i) text += "element e" + std::to_string(i) + " 0\n";
    return text + kPlyVertices + kPlyFaces + kPlyTriangle;
}

std::string plyOfManyProperties() {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (int i = 0; i < 1100; ++i) text += "property int p" + std::to_string(i) + "\n";
    return text;
}

class GuardedMesh : public testing::TestWithParam<Guarded> {};

} // namespace

TEST_P(GuardedMesh, ErrorNamesFileAndPosition) {
    const Guarded& file = GetParam();
    const std::string path = saveText(std::string("guarded_") + file.name, file.content);
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + file.message);
}

TEST(GuardedPly, IgnoresUnknownHeaderLines) {
    const std::string path =
        saveText("remark.ply", "ply\nformat ascii 1.0\nCreated by Blender3D 247\n\n" +
                                   kPlyVertices + kPlyFaces + kPlyTriangle);
    EXPECT_EQ(osgSkin::importMesh(path).mesh.positions.size(), 3u);
}

INSTANTIATE_TEST_SUITE_P(
    Files, GuardedMesh,
    testing::Values(
        // A CR alone ends the comment.
        Guarded{"cr.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n# hidden\rf 1//9 2//9 300//9\nf 1 2 3\n",
                "line 5: \"1//9\" in a face"},
        Guarded{"beyond_floats.obj", "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "mesh: vertex 0 has a coordinate beyond -1e18 to 1e18"},
        Guarded{"cr.ply",
                "ply\nformat ascii 1.0\ncomment a\relement vertex 500000000\n" + kPlyVertices +
                    kPlyFaces + kPlyTriangle,
                "line 4: \"500000000\" elements"},
        Guarded{"typo.ply", "ply\nformat asci 1.0\n" + kPlyVertices + kPlyFaces + kPlyTriangle,
                "line 2: unknown format \"asci\""},
        Guarded{"vertex_twice.ply",
                "ply\nformat ascii 1.0\n" + kPlyVertices + kPlyVertices + kPlyFaces + kPlyTriangle,
                "line 7: a second element \"vertex\""},
        Guarded{"nan_count.ply",
                "ply\nformat ascii 1.0\n" + kPlyVertices + kPlyFaces +
                    "end_header\n0 0 0\n1 0 0\n0 1 0\nnan 0 1 2\n",
                "element \"face\" 0: a list of nan entries"},
        Guarded{"word.ply",
                "ply\nformat ascii 1.0\n" + kPlyVertices + kPlyFaces +
                    "end_header\n0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n",
                "element \"vertex\" 1: not a number"},
        Guarded{"elements.ply", plyOfManyElements(), "line 103: more than 100 elements"},
        Guarded{"properties.ply", plyOfManyProperties(),
                "line 1004: more than 1000 properties of \"vertex\""},
        Guarded{"nameless.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float\n",
                "line 5: a property without a name"},
        Guarded{"property_twice.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float x\n",
                "line 5: a second property \"x\" of \"vertex\""},
        // Rows would have one more number than the known columns.
        Guarded{"misspelt.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\npropertty float quality\n",
                "line 4: unknown keyword \"propertty\"; did you mean \"property\"?"},
        Guarded{"spline.gltf", kLongSpline, "animation \"0\": sampler 0: a spline of"},
        Guarded{"sparse.gltf", sparse(9, 5121),
                "malformed glTF: accessors[0].sparse.indices: expected numbers below 9"},
        Guarded{"sparse_floats.gltf", sparse(10, 5126),
                "malformed glTF: accessors[0], meshes[0].primitives[0].POSITION: expected sparse "
                "indices"},
        Guarded{"kind.gltf",
                R"({"asset": {"version": "2.0"},
                    "accessors": [{"count": 1, "componentType": 5126, "type": 7}]})",
                "malformed glTF: accessors[0]: type must be string, but is number"},
        Guarded{"member.gltf", R"({"asset": {"version": "2.0"}, "animations": [{"samplers": []}]})",
                "malformed glTF: animations[0]: key 'channels' not found"},
        Guarded{"packed.gltf",
                R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4}], "bufferViews": [
                    {"buffer": 0, "byteLength": 4, "extensions":
                     {"EXT_meshopt_compression": {"buffer": 0, "byteLength": "4"}}}]})",
                "malformed glTF: bufferViews[0].EXT_meshopt_compression: type must be number, but "
                "is string"},
        Guarded{"copies.gltf", kManyCopies,
                "malformed glTF: nodes, bones, materials and channels: expected at most"},
        Guarded{"deep.gltf", gltf("\"extras\":" + nested(200'000)), "lists and objects are nested"},
        Guarded{"deep.glb", glb(gltf("\"extras\":" + nested(200'000))),
                "lists and objects are nested more than 64 deep"},
        Guarded{"digits.off", "OFF\n500000000x 500000000 0\n0 0 0\n", "\"500000000x\""},
        Guarded{"marked.off", "N90199019 1 ", "\"N90199019\", expected OFF"},
        Guarded{"joined.off", "OFF90199019 1 0\n", "\"OFF90199019\", expected OFF"},
        Guarded{"commented.off", "OFF # a\r90199019 1 0\n3 1 0\n", "\"90199019\" vertices"},
        Guarded{"form_feed.off", "OFF # a\f1 0 0\n1 90199019 0\n3 0 0 0\n", "a form feed"},
        Guarded{"small_number.off", "OFF\n90199019e-9 1 0\n", "\"90199019e-9\", expected a number"},
        Guarded{"many_faces.off", "OFF\n1 2 0\n0 1 0\n3 0 0 0\n99 0\n0 0 0\n", "face 1: expected"},
        Guarded{"beyond.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                "face 0: expected the number of its corners and as many vertex numbers below 3"},
        Guarded{"short.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "vertex 1: expected"},
        Guarded{"dimensions.off", "nOFF\n3 90199019 1 0\n", "\"90199019\" vertices"},
        Guarded{"deep.bvh", bvh(25'000, 1, true), "BVH files have no mesh"},
        Guarded{"other.skin", "{}", "a character, expected a mesh"}),
    [](const auto& c) {
        std::string name = c.param.name;
        std::replace(name.begin(), name.end(), '.', '_');
        return name;
    });

TEST(Guard, RejectsIncompleteTriangle) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry->setVertexArray(new osg::Vec3Array(3, corners));
    const GLuint indices[] = {0, 1, 2, 0};
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, 4, indices));
    const std::string path = testing::TempDir() + "begun.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*geometry, path));
    expectError([&] { osgSkin::importMesh(path); }, "4 corners of triangles");
}

#ifndef _WIN32 // which has no pipes and devices among its files
TEST(Guard, OpensRegularFilesOnly) {
    const std::string folder = testing::TempDir() + "guard_pipes";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    for (const char* extension : {"obj", "ply", "glb", "fbx", "x", "bvh", "osgt"}) {
        const std::string pipe = folder + "/pipe." + extension;
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        expectError([&] { osgSkin::importMesh(pipe); }, pipe + ": cannot open: not a regular");
        if (std::string(extension) != "ply")
            expectError([&] { osgSkin::importSkeleton(pipe); }, "cannot open: not a regular");
    }
    expectError([&] { osgSkin::importMotion(folder + "/pipe.bvh"); }, "not a regular file");
    const std::string endless = folder + "/endless.bvh";
    std::filesystem::create_symlink("/dev/zero", endless);
    expectError([&] { osgSkin::importMotion(endless); }, "not a regular file");
    expectError([] { osgSkin::importMesh("http://127.0.0.1:9/a.osgt"); }, "network addresses");

    ASSERT_EQ(mkfifo((folder + "/pipe.mtl").c_str(), 0600), 0);
    // Unavailable materials and textures are ignored.
    for (const char* library : {"pipe.mtl", "texture.mtl"}) {
        const std::string mesh = folder + "/mesh.obj";
        std::ofstream(mesh) << "mtllib " << library
                            << "\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::ofstream(folder + "/texture.mtl") << "newmtl a\nKd 1 0 0\nmap_Kd pipe.fbx\n";
        EXPECT_EQ(osgSkin::importMesh(mesh).mesh.positions.size(), 3u) << library;
    }
    std::filesystem::remove_all(folder);
}
#endif

TEST(Guard, RunsNoScriptsAndUnpacksNoArchives) {
    const std::string folder = testing::TempDir() + "guard_scripts/";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    const std::string ran = folder + "ran", script = folder + "script.lua";
    std::ofstream(script) << "io.open(\"" << ran << "\", \"w\"):close()";
    const char* const reason = "archives, scripts and network formats are not read";
    for (const char* behind : {"", ".90,0,0.rot"}) {
        expectError([&] { osgSkin::importMesh(script + behind); }, reason);
        expectError([&] { osgSkin::importSkeleton(script + behind); }, reason);
        expectError([&] { osgSkin::readScene(script + behind, nullptr); }, reason);
    }
    // A shell command would contain this name; OpenSceneGraph crashes on the other.
    const std::string archive = folder + "a;touch ran;.tgz";
    for (const std::string& packed : {archive, folder + "body.gz", folder + "body.OSGT.GZ"}) {
        std::ofstream(packed) << "v 0 0 0";
        expectError([&] { osgSkin::importMesh(packed); }, reason);
        expectError([&] { osgSkin::importMotion(packed); }, reason);
    }
    const std::string mesh = folder + "mesh.obj";
    std::ofstream(mesh) << "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder + "a.mtl") << "newmtl a\nKd 1 0 0\nmap_Kd script.lua\n";
    EXPECT_EQ(osgSkin::importMesh(mesh).mesh.positions.size(), 3u);
    EXPECT_FALSE(std::filesystem::exists(ran));
    std::filesystem::remove_all(folder);
}

// Assimp detects the format of files with unknown extensions by content: it would use readers of
// formats that we check by extension, and readers that read out of bounds.
TEST(Guard, ChoosesReaderByExtensionOnly) {
    for (const char* name :
         {"walk.osgt", "walk.osgb", "walk.osgx", "walk.skin", "walk.dat", "walk"})
        for (const char* content : {"c?\?metric?\?????G::Group${\n",
                                    R"({"asset": {"version": "2.0"}})", "MD5Version 10\n"}) {
            const std::string path = saveText(name, content);
            const std::string expected = std::string(name) == "walk"
                                             ? "walk: the file's name has no extension"
                                             : std::string(name) + ": \"." +
                                                   osgDB::getFileExtension(name) +
                                                   "\" files are not read as rigs or motions, "
                                                   "expected .bvh";
            expectError([&] { osgSkin::importMotion(path); }, expected);
            expectError([&] { osgSkin::importRig(path); }, expected);
        }
}

TEST(Guard, LimitsSamplesByFileSize) {
    const std::string path = saveText("wide.bvh", bvh(3000, 3000, false));
    expectError([&] { osgSkin::importMotion(path); }, "3000 frames of 3001 joints");
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("maxSamples=10000000");
    EXPECT_EQ(osgSkin::importMotion(path, 0, {}, options).frames, 3000u);
    const std::string fits = bvh(9, 200, false);
    const auto limit = [&](std::size_t samples) {
        const auto most = std::to_string(samples - fits.size() / 2);
        return osg::ref_ptr<osgDB::Options>(new osgDB::Options("maxSamples=" + most));
    };
    const std::string just = saveText("just.bvh", fits);
    EXPECT_EQ(osgSkin::importMotion(just, 0, {}, limit(2000)).frames, 200u);
    expectError([&] { osgSkin::importMotion(just, 0, {}, limit(1999)); }, "at most 1999 rotations");
    const std::string many = saveText("many.bvh", bvh(20'000, 1, false));
    expectError([&] { osgSkin::importSkeleton(many); },
                "exceeds the limit of 10000 joints (option maxJoints)");
}

/// Only the faces' corners have texture coordinates; the strips' have none.
TEST(Guard, StripsBesideFacesHaveNoTextureCoordinates) {
    const std::string path = saveText(
        "strips.ply", "ply\nformat ascii 1.0\n" + kPlyVertices + kPlyFaces +
                          "property list uchar float texcoord\nelement tristrips 1\nproperty list "
                          "int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
                          "3 0 1 2 6 .5 .5 1 .5 .5 1\n3 2 1 0\n");
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    ASSERT_EQ(mesh.mesh.faceSizes.size(), 2u);
    std::size_t zeros = 0;
    for (const osgSkin::MeshPart& part : mesh.parts)
        for (const osg::Vec2& texCoord :
             dynamic_cast<const osg::Vec2Array&>(*part.geometry->getTexCoordArray(0)))
            zeros += texCoord == osg::Vec2(0.0f, 0.0f) ? 1 : 0;
    EXPECT_EQ(zeros, 3u);
}

TEST(Guard, LimitsMorphTargetsAndBuffersByFileSize) {
    const auto import = [](const std::string& path, const char* words) {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(words);
        osgSkin::importMesh(path, options);
    };
    const std::string targets = repeated(500, [](std::size_t) { return R"({"POSITION":0})"; });
    const std::string ones = repeated(500, [](std::size_t) { return "1"; });
    const std::string morphs =
        saveText("morphs.gltf", sparse(1000, 5121, ",\"targets\":[" + targets + "]",
                                       ",\"weights\":[" + ones + "]"));
    expectError([&] { import(morphs, "maxSamples=9000"); },
                "malformed glTF: expected morph targets of fewer vertices");

    saveText("buffer.bin", std::string(600'000, 'x'));
    const std::string buffers = saveText(
        "buffers.gltf",
        gltf(
            R"("buffers":[)" +
            repeated(2, [](std::size_t) { return R"({"byteLength":600000,"uri":"buffer.bin"})"; }) +
            "]"));
    expectError([&] { import(buffers, "maxFileMB=1"); },
                "malformed glTF: buffers: expected less than 1 MB in all (option maxFileMB)");
}

/// One library under many spellings of its name, with many materials of kilobytes each.
TEST(Guard, ReadsMaterialLibrariesOnce) {
    std::string library, text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 20'000; ++i) library += "newmtl a" + std::to_string(i) + "\nKd 0 0 1\n";
    saveText("spelled.mtl", library + "newmtl a7\nKd 1 0 0\n");
    for (int i = 0; i < 200; ++i) {
        text += "mtllib ";
        for (int k = 0; k < 8; ++k) text += (i >> k) % 2 == 0 ? "./" : ".//";
        text += "spelled.mtl\n";
    }
    const std::string path = saveText("spelled.obj", text + "usemtl a7\nf 1 2 3\n");
    const auto begin = std::chrono::steady_clock::now();
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
    ASSERT_EQ(mesh.parts.size(), 1u);
    EXPECT_EQ(diffuseOf(mesh), osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f));

    std::string uses;
    for (int i = 0; i < 100; ++i) uses += "usemtl " + std::to_string(i) + "\nf 1 2 3\n";
    const std::string many = saveText("materials.obj", text + uses);
    const osg::ref_ptr<osgDB::Options> few = new osgDB::Options("maxSamples=1");
    const std::size_t most = (1 + (text.size() + uses.size()) / 2) / 20;
    EXPECT_GT(most, 100u);
    EXPECT_EQ(osgSkin::importMesh(many, few).mesh.positions.size(), 3u);
    const std::string beyond = saveText("materials.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + uses);
    expectError([&] { osgSkin::importMesh(beyond, few); }, "100 materials, expected at most ");
}

/// Numbers of any length have their value, or are refused.
TEST(Guard, ReadsLongNumbers) {
    const std::string rest = "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::string thirds(2000, '3');
    const auto first = [&](const std::string& number) {
        return osgSkin::importMesh(saveText("long.obj", "v " + number + " 0 0" + rest))
            .mesh.positions.at(0)[0];
    };
    EXPECT_EQ(first("1." + thirds), 4.0 / 3.0);
    EXPECT_EQ(first("-" + std::string(500, '0') + "12.5"), -12.5);
    EXPECT_EQ(first("0." + std::string(500, '0') + "1"), 0.0);
    expectError([&] { first(thirds.substr(0, 305)); }, "expected 3 finite numbers");
}

TEST(Guard, AppliesLimitsAndFormats) {
    const std::string path = testData("mesh/quads.obj");
    const auto import = [&](const char* words) {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(words);
        return osgSkin::importMesh(path, options);
    };
    EXPECT_EQ(import("formats=obj,bvh maxFileMB=1").mesh.positions.size(), 8u);
    expectError([&] { import("formats=glb,bvh"); },
                path + ": the format \"obj\" is not allowed, expected one of glb, bvh");
    expectError([&] { import("maxFileMB=none"); },
                "option maxFileMB=none: expected a whole number");
    expectError([&] { import("maxJoints=0"); }, "option maxJoints=0: expected a whole number");
}

TEST(Guard, ReadsAllLineEndsAndByteOrderMarks) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* end : {"\r", "\r\n"}) {
        std::string other = "\xef\xbb\xbf" + text;
        for (std::size_t at = 0; (at = other.find('\n', at)) != std::string::npos;
             at += std::string(end).size())
            other.replace(at, 1, end);
        EXPECT_EQ(osgSkin::importMesh(saveText("ends.obj", other)).mesh.positions.size(), 3u);
    }
}
