// SPDX-License-Identifier: MIT
// Files that readers behind us believed: each took memory, time or the program with it.
#include "ExpectError.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Motion>

#include <osg/Geometry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <fstream>
#include <ostream>
#include <string>

#include <sys/stat.h>

namespace {

struct Guarded {
    const char* name; ///< of a file
    std::string content;
    const char* message;
};

void PrintTo(const Guarded& file, std::ostream* out) {
    *out << file.name;
}

std::string save(const std::string& name, const std::string& content) {
    std::string path = testing::TempDir() + name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

const std::string kPlyVertices = "element vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\n";
const std::string kPlyFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyTriangle = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Joints without channels below one that has a channel.
std::string bvh(std::size_t joints, std::size_t frames, bool nested) {
    std::string text = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (std::size_t j = 0; j < joints; ++j)
        text += "JOINT " + std::to_string(j) + "\n{\nOFFSET 0 1 0\n" + (nested ? "" : "}\n");
    for (std::size_t j = 0; nested && j < joints; ++j) text += "}\n";
    text += "}\nMOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: .1\n";
    for (std::size_t f = 0; f < frames; ++f) text += "0\n";
    return text;
}

class GuardedMesh : public testing::TestWithParam<Guarded> {};

} // namespace

TEST_P(GuardedMesh, IsRefusedWithFileAndPlace) {
    const Guarded& file = GetParam();
    const std::string path = save(std::string("guarded_") + file.name, file.content);
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + file.message);
}

INSTANTIATE_TEST_SUITE_P(
    Files, GuardedMesh,
    testing::Values(
        // tinyobjloader sees the face behind the CR.
        Guarded{"cr.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n# hidden\rf 1//9 2//9 300//9\nf 1 2 3\n",
                "line 5: \"1//9\" in a face"},
        Guarded{"beyond_floats.obj", "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "mesh: vertex 0 has a coordinate beyond -1e18 to 1e18"},
        Guarded{"cr.ply",
                "ply\nformat ascii 1.0\ncomment a\relement vertex 500000000\n" + kPlyVertices +
                    kPlyFaces + kPlyTriangle,
                "line 4: \"500000000\" elements"},
        Guarded{"typo.ply", "ply\nformat asci 1.0\n" + kPlyVertices + kPlyFaces + kPlyTriangle,
                "line 2: \"asci\" is no format"},
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
                "element \"vertex\" 1: a word that is no number"},
        Guarded{"digits.off", "OFF\n500000000x 500000000 0\n0 0 0\n", "\"500000000x\""},
        Guarded{"deep.bvh", bvh(25'000, 1, true), "no face in a BVH file"}),
    [](const auto& c) {
        std::string name = c.param.name;
        std::replace(name.begin(), name.end(), '.', '_');
        return name;
    });

TEST(Guard, ATriangleThatIsBegunIsRefused) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry->setVertexArray(new osg::Vec3Array(3, corners));
    const GLuint indices[] = {0, 1, 2, 0};
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, 4, indices));
    const std::string path = testing::TempDir() + "begun.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*geometry, path));
    expectError([&] { osgSkin::importMesh(path); }, "4 corners of triangles");
}

TEST(Guard, NothingButFilesIsOpened) {
    const std::string folder = testing::TempDir() + "guard_pipes";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    for (const char* extension : {"obj", "ply", "glb", "fbx", "x", "bvh", "osgt"}) {
        const std::string pipe = folder + "/pipe." + extension;
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        expectError([&] { osgSkin::importMesh(pipe); }, pipe + ": cannot open: it is no regular");
        if (std::string(extension) != "ply")
            expectError([&] { osgSkin::importSkeleton(pipe); }, "cannot open: it is no regular");
    }
    expectError([&] { osgSkin::importMotion(folder + "/pipe.bvh"); }, "it is no regular file");
    const std::string endless = folder + "/endless.bvh";
    std::filesystem::create_symlink("/dev/zero", endless);
    expectError([&] { osgSkin::importMotion(endless); }, "it is no regular file");
    expectError([] { osgSkin::importMesh("http://127.0.0.1:9/a.osgt"); }, "an address");

    ASSERT_EQ(mkfifo((folder + "/pipe.mtl").c_str(), 0600), 0);
    // Materials and textures that cannot be had are done without.
    for (const char* library : {"pipe.mtl", "texture.mtl"}) {
        const std::string mesh = folder + "/mesh.obj";
        std::ofstream(mesh) << "mtllib " << library
                            << "\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::ofstream(folder + "/texture.mtl") << "newmtl a\nKd 1 0 0\nmap_Kd pipe.fbx\n";
        EXPECT_EQ(osgSkin::importMesh(mesh).mesh.positions.size(), 3u) << library;
    }
    std::filesystem::remove_all(folder);
}

TEST(Guard, MotionsAreAsLargeAsTheirFiles) {
    const std::string path = save("wide.bvh", bvh(3000, 3000, false));
    expectError([&] { osgSkin::importMotion(path); }, "3000 frames of 3001 joints");
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("maxSamples=10000000");
    EXPECT_EQ(osgSkin::importMotion(path, 0, {}, options).frames, 3000u);
    const std::string many = save("many.bvh", bvh(20'000, 1, false));
    expectError([&] { osgSkin::importSkeleton(many); },
                "one of more than 10000 (option maxJoints)");
}

TEST(Guard, LimitsAndFormatsAreTheCallers) {
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

TEST(Guard, LineEndsAndMarksDoNotMatter) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* end : {"\r", "\r\n"}) {
        std::string other = "\xef\xbb\xbf" + text;
        for (std::size_t at = 0; (at = other.find('\n', at)) != std::string::npos;
             at += std::string(end).size())
            other.replace(at, 1, end);
        EXPECT_EQ(osgSkin::importMesh(save("ends.obj", other)).mesh.positions.size(), 3u);
    }
}
