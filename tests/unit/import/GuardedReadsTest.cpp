// SPDX-License-Identifier: MIT
// Third-party readers' requests to OpenSceneGraph go through our guard, for objects of every kind.
#include "ExpectError.h"
#include "LeaksOfOthers.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinImport/ReadScene>

#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace {

using Result = osgDB::ReaderWriter::ReadResult;

/// Reads `KIND FILE` from its own file, requests that, and makes a group that is named after the
/// result.
class Asker : public osgDB::ReaderWriter {
public:
    Asker() { supportsExtension("asks", "what a reader may ask for"); }

    ReadResult readNode(const std::string& path, const osgDB::Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(path)))
            return ReadResult::FILE_NOT_HANDLED;
        std::string kind, name;
        std::ifstream(osgDB::findDataFile(path, options)) >> kind >> name;
        osgDB::Registry& registry = *osgDB::Registry::instance();
        Result result;
        if (kind == "node") result = registry.readNode(name, options);
        if (kind == "object") result = registry.readObject(name, options);
        if (kind == "image") result = registry.readImage(name, options);
        if (kind == "field") result = registry.readHeightField(name, options);
        if (kind == "shader") result = registry.readShader(name, options);
        if (kind == "script") result = registry.readScript(name, options);
        if (kind == "archive")
            result = registry.openArchive(name, osgDB::ReaderWriter::READ, 4096, options);
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        group->setName(result.success() ? "read" : result.message());
        return group.get();
    }
};

class GuardedReads : public testing::Test {
public:
    GuardedReads() {
        std::filesystem::create_directories(_folder);
        osgDB::Registry::instance()->addReaderWriter(_asker.get());
    }
    ~GuardedReads() override {
        osgDB::Registry::instance()->removeReaderWriter(_asker.get());
        std::filesystem::remove_all(_folder);
    }

    /// The result that a reader gets when it requests a file.
    std::string asked(const std::string& kind, const std::string& name) {
        const std::string path = file("reader.asks");
        std::ofstream(path) << kind << ' ' << name;
        return osgSkin::readScene(path, nullptr)->getName();
    }
    std::string file(const std::string& name) const { return _folder + name; }

private:
    const std::string _folder = testing::TempDir() + "guarded_reads_" +
                                testing::UnitTest::GetInstance()->current_test_info()->name() + "/";
    const osg::ref_ptr<Asker> _asker = new Asker;
};

/// Nested joints, more than OpenSceneGraph's recursive reader has stack for.
std::string deepBvh(int joints) {
    std::string text = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (int j = 0; j < joints; ++j)
        text += "JOINT " + std::to_string(j) + "\n{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\n";
    for (int j = 0; j <= joints; ++j) text += "}\n";
    return text + "MOTION\nFrames: 0\nFrame Time: .1\n";
}

osg::BoundingBox boxOf(osg::Node& scene) {
    osg::ComputeBoundsVisitor visitor;
    scene.accept(visitor);
    return visitor.getBoundingBox();
}

const char* const kAll[] = {"node", "object", "image", "field", "shader", "script"};

} // namespace

TEST_F(GuardedReads, RejectAddressesAndScripts) {
    const std::string script = file("script.lua"), ran = file("ran");
    std::ofstream(script) << "io.open(\"" << ran << "\", \"w\"):close()";
    for (const char* kind : kAll) {
        EXPECT_NE(asked(kind, "http://127.0.0.1:9/a").find("network addresses are not read"),
                  std::string::npos)
            << kind;
        EXPECT_NE(asked(kind, script).find("archives, scripts and network formats are not read"),
                  std::string::npos)
            << kind;
    }
    EXPECT_FALSE(std::filesystem::exists(ran));
}

TEST_F(GuardedReads, CheckSavedScenes) {
    const std::string saved = file("saved.osgt");
    ASSERT_TRUE(osgDB::writeNodeFile(*osg::ref_ptr<osg::Node>(new osg::Group), saved));
    EXPECT_EQ(asked("node", saved), "read");
    EXPECT_EQ(asked("object", saved), "read");
    const osg::ref_ptr<osg::MatrixTransform> away =
        new osg::MatrixTransform(osg::Matrix::translate(1e30, 0, 0));
    ASSERT_TRUE(osgDB::writeNodeFile(*away, saved));
    for (const char* kind : {"node", "object"})
        EXPECT_NE(asked(kind, saved).find(saved + ": transform"), std::string::npos) << kind;
}

TEST_F(GuardedReads, ReadWhatOpenSceneGraphReads) {
    const std::string shader = file("plain.frag");
    std::ofstream(shader) << "void main() {}\n";
    EXPECT_EQ(asked("shader", shader), "read");
    EXPECT_NE(asked("field", file("none.hf")), "read");
    EXPECT_NE(asked("script", file("none.unknown")), "read");
}

/// Its readers of OBJ, PLY and BVH do not check their input.
TEST_F(GuardedReads, UseOurReadersForOurFormats) {
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                            "property float y\nproperty float z\nelement face 1\n"
                            "property list uchar int vertex_indices\nend_header\n"
                            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2000000000\n";
    const std::pair<std::string, std::string> hostile[] = {
        {"far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2000000000\n"},
        {"far.PLY", ply},
        {"deep.bvh", deepBvh(25'000)},
        {"wide.bvh", "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 600000000 Xrotation\n}\n"},
        {"other.glb", "glTF"},
        {"other.off", "OFF"}};
    for (const auto& [name, content] : hostile) {
        const std::string path = file(name);
        std::ofstream(path) << content;
        expectError([&] { osgSkin::readScene(path, nullptr); }, path + ": ");
        for (const char* behind : {".2.scale", ".90,0,0.rot", ".1,2,3.trans", ".gles", ".osgshadow",
                                   ".osgjs", ".2.scale.gles"}) {
            expectError([&] { osgSkin::readScene(path + behind, nullptr); }, path + ": ");
            expectError([&] { osgSkin::importMesh(path + behind); }, path + ": ");
            expectError([&] { osgSkin::importSkeleton(path + behind); }, path + ": ");
        }
        // These would bypass our check.
        for (const char* behind : {".normals", ".2.scale.normals", ".normals.gles", ".logo"})
            expectError([&] { osgSkin::readScene(path + behind, nullptr); },
                        "archives, scripts and network formats are not read");
        EXPECT_NE(asked("node", path).find(path + ": "), std::string::npos);
        EXPECT_NE(asked("object", path).find(path + ": "), std::string::npos);
    }
}

TEST_F(GuardedReads, ReadMeshesAsOpenSceneGraphWould) {
    for (const char* name : {"character/body.obj", "mesh/square.ply"}) {
        const std::string path = testData(name);
        osg::ref_ptr<osg::Node> theirs;
        {
            const test::LeaksOfOthers ofOpenSceneGraph; // its PLY reader leaks the properties
            theirs = osgDB::readRefNodeFile(path);
        }
        ASSERT_TRUE(theirs);
        const osg::BoundingBox box = boxOf(*theirs);
        const osg::BoundingBox ours = boxOf(*osgSkin::readScene(path, nullptr));
        const osg::BoundingBox scaled = boxOf(*osgSkin::readScene(path + ".2.scale", nullptr));
        for (unsigned i = 0; i < 8; ++i) {
            EXPECT_LT((ours.corner(i) - box.corner(i)).length(), 1e-5f) << name;
            EXPECT_LT((scaled.corner(i) - box.corner(i) * 2.0f).length(), 1e-5f) << name;
        }
        EXPECT_FALSE(osgSkin::importMesh(path + ".2.scale").mesh.positions.empty());
    }
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("noRotation");
    const std::string path = testData("character/body.obj");
    const osg::BoundingBox own = boxOf(*osgSkin::readScene(path, options));
    const osg::BoundingBox turned = boxOf(*osgSkin::readScene(path, nullptr));
    EXPECT_NE(own.yMax(), own.zMax());
    EXPECT_NEAR(own.yMax(), turned.zMax(), 1e-5f);
}

TEST_F(GuardedReads, LimitNesting) {
    std::string name = file("inner.osgt");
    ASSERT_TRUE(osgDB::writeNodeFile(*osg::ref_ptr<osg::Node>(new osg::Group), name));
    for (int i = 0; i < 10; ++i) name += ".1.scale";
    EXPECT_TRUE(osgSkin::readScene(name, nullptr));
    for (int i = 0; i < 100; ++i) name += ".1.scale";
    expectError([&] { osgSkin::readScene(name, nullptr); }, "nested more than 16 deep");
}

TEST_F(GuardedReads, RejectArchives) {
    EXPECT_NE(asked("archive", file("a.osg")).find("archives are not read"), std::string::npos);
}
