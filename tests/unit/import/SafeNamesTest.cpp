// SPDX-License-Identifier: MIT
// File names: archives in their paths, zero bytes, length, and which file they mean.
#include "ExpectError.h"
#include "MeshParts.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinImport/ReadScene>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osgDB/Archive>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

class SafeNames : public testing::Test {
public:
    SafeNames() {
        std::filesystem::remove_all(_folder);
        std::filesystem::create_directories(_folder);
    }
    ~SafeNames() override { std::filesystem::remove_all(_folder); }

    std::string file(const std::string& name) const { return _folder + name; }
    std::string save(const std::string& name, const std::string& content) const {
        std::ofstream(file(name), std::ios::binary) << content;
        return file(name);
    }
    /// A triangle that OSG saved.
    std::string saveScene(const std::string& name) const {
        EXPECT_TRUE(osgDB::writeNodeFile(*triangle(), file(name)));
        return file(name);
    }
    static osg::ref_ptr<osg::Geometry> triangle() {
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        geometry->setVertexArray(new osg::Vec3Array(3, corners));
        geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
        return geometry;
    }

private:
    const std::string _folder = testing::TempDir() + "safe_names_" +
                                testing::UnitTest::GetInstance()->current_test_info()->name() + "/";
};

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

bool hasTexture(const osgSkin::ImportedMesh& mesh) {
    return std::any_of(mesh.parts.begin(), mesh.parts.end(),
                       [](const osgSkin::MeshPart& part) { return imageOf(part) != nullptr; });
}

} // namespace

TEST_F(SafeNames, RejectArchivesInPaths) {
    const std::string archive = file("evil.osga");
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    {
        const osg::ref_ptr<osgDB::Archive> made =
            osgDB::Registry::instance()
                ->openArchive(archive, osgDB::ReaderWriter::CREATE, 4096, nullptr)
                .takeArchive();
        ASSERT_TRUE(made);
        ASSERT_TRUE(made->writeNode(*triangle(), "inner.osgt").success());
        ASSERT_TRUE(made->writeImage(*image, "inner.bmp").success());
        made->close();
    }
    osgDB::Registry::instance()->clearArchiveCache(); // the cache keeps closed archives
    ASSERT_TRUE(osgDB::readRefNodeFile(archive + "/inner.osgt"));
    osgDB::Registry::instance()->clearArchiveCache();
    const char* const reason = "archives, scripts and network formats are not read";
    for (const char* behind : {"/inner.osgt", "\\inner.osgt", "/inner.osgt.2.scale", "/inner.stl"})
        for (const std::string& packed : {archive, file("EVIL.ZIP"), file("a.osga/b")}) {
            expectError([&] { osgSkin::importMesh(packed + behind); }, reason);
            expectError([&] { osgSkin::importSkeleton(packed + behind); }, reason);
            expectError([&] { osgSkin::readScene(packed + behind, nullptr); }, reason);
        }
    save("a.mtl", "newmtl a\nKd 1 0 0\nmap_Kd evil.osga/inner.bmp\n");
    const std::string mesh = save("mesh.obj", "mtllib a.mtl\nusemtl a\n" + kTriangle);
    EXPECT_FALSE(hasTexture(osgSkin::importMesh(mesh)));
    // Folders may have any name.
    std::filesystem::create_directory(file("folder.zip"));
    EXPECT_EQ(osgSkin::importMesh(save("folder.zip/m.obj", kTriangle)).mesh.positions.size(), 3u);
}

/// Some readers end a name at a byte 0, others do not: the checked file would differ from the one
/// that is read.
TEST_F(SafeNames, RejectZeroBytes) {
    const char* const reason = "contains a zero byte";
    for (const std::string& whole : {save("mesh.obj", kTriangle), testData("rig/tube.gltf"),
                                     testData("bvh/two_joints.bvh"), testData("saved/tube.osgt")})
        for (const std::string& behind : {std::string(1, '\0'), std::string("\0.obj", 5)}) {
            const std::string name = whole + behind;
            expectError([&] { osgSkin::importMesh(name); }, reason);
            expectError([&] { osgSkin::importSkeleton(name); }, reason);
            expectError([&] { osgSkin::importMotion(name); }, reason);
            expectError([&] { osgSkin::importRig(name); }, reason);
            expectError([&] { osgSkin::readScene(name, nullptr); }, reason);
        }
}

TEST_F(SafeNames, LimitLength) {
    const std::string scene = saveScene("m.osgt");
    std::string scaled = scene;
    for (int i = 0; i < 5000; ++i) scaled += ".1.scale";
    for (const std::string& name : {scaled, std::string(500'000, 'n') + ".obj"}) {
        expectError([&] { osgSkin::importMesh(name); }, "expected at most 4096");
        expectError([&] { osgSkin::readScene(name, nullptr); }, "expected at most 4096");
        try {
            osgSkin::importMesh(name);
        } catch (const osgSkin::Error& error) {
            EXPECT_LT(std::string(error.what()).size(), 300u);
        }
    }
}

/// A texture often names folders of another machine: only the mesh's own folder is searched.
TEST_F(SafeNames, TexturesComeFromTheMeshFolder) {
    const std::string ppm = "P6\n1 1\n255\nabc";
    for (const std::string folder : {"here", "mesh"})
        std::filesystem::create_directories(file(folder));
    std::ofstream(file("here/away.ppm"), std::ios::binary) << ppm;
    std::ofstream(file("mesh/beside.ppm"), std::ios::binary) << ppm;
    std::ofstream(file("mesh/m.obj"))
        << "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(file("here"));
    for (const std::string name :
         {"../secret/away.ppm", "C:\\Users\\x\\beside.ppm", "beside.ppm"}) {
        std::ofstream(file("mesh/m.mtl")) << "newmtl m\nKd 1 1 1\nmap_Kd " << name << "\n";
        const osgSkin::ImportedMesh mesh = osgSkin::importMesh("../mesh/m.obj");
        EXPECT_EQ(hasTexture(mesh), name.find("beside") != std::string::npos) << name;
    }
    std::filesystem::current_path(before);
}

/// OSG would search for the name's last part in the working folder.
TEST_F(SafeNames, IgnoreFilesOfTheSameBaseName) {
    saveScene("named.osgt");
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(file(""));
    EXPECT_EQ(osgSkin::importMesh("named.osgt").mesh.positions.size(), 3u);
    EXPECT_EQ(osgSkin::importMesh("./named.osgt.2.scale").mesh.positions.size(), 3u);
    for (const std::string name : {"sub/named.osgt", "sub/named.osgt.2.scale"}) {
        expectError([&] { osgSkin::importMesh(name); }, "sub/named.osgt: cannot open");
        expectError([&] { osgSkin::importSkeleton(name); }, "sub/named.osgt: cannot open");
    }
    std::filesystem::current_path(before);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(file(""));
    EXPECT_TRUE(osgSkin::readScene("named.osgt", options));
    expectError([&] { osgSkin::readScene("sub/named.osgt", options); }, "cannot open");
}
