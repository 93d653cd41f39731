// SPDX-License-Identifier: MIT
// What a reader behind us asks OpenSceneGraph for goes through our guard, whatever kind it is of.
#include <osgSkinImport/ReadScene>

#include <osg/Group>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace {

using Result = osgDB::ReaderWriter::ReadResult;

/// Reads `KIND FILE` from its own file, asks for that, and makes a group that is named after what
/// came of it.
class Asker : public osgDB::ReaderWriter {
public:
    Asker() { supportsExtension("asks", "what a reader may ask for"); }

    ReadResult readNode(const std::string& path, const osgDB::Options* options) const override {
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

    /// What a reader is told that asks for a file.
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

const char* const kAll[] = {"node", "object", "image", "field", "shader", "script"};

} // namespace

TEST_F(GuardedReads, OpenNoAddressAndRunNoScript) {
    const std::string script = file("script.lua"), ran = file("ran");
    std::ofstream(script) << "io.open(\"" << ran << "\", \"w\"):close()";
    for (const char* kind : kAll) {
        EXPECT_NE(asked(kind, "http://127.0.0.1:9/a").find("an address, expected a file"),
                  std::string::npos)
            << kind;
        EXPECT_NE(asked(kind, script).find("expected a file that only has to be read"),
                  std::string::npos)
            << kind;
    }
    EXPECT_FALSE(std::filesystem::exists(ran));
}

TEST_F(GuardedReads, ReadSavedScenesByOurOwnReader) {
    const std::string saved = file("saved.osgt");
    ASSERT_TRUE(osgDB::writeNodeFile(*osg::ref_ptr<osg::Node>(new osg::Group), saved));
    EXPECT_EQ(asked("node", saved), "read");
    EXPECT_EQ(asked("object", saved), "read");
    for (const char* kind : {"image", "field", "shader", "script"})
        EXPECT_NE(asked(kind, saved).find(saved + ": a saved scene, expected a"), std::string::npos)
            << kind;
}

TEST_F(GuardedReads, ReadWhatOpenSceneGraphReads) {
    const std::string shader = file("plain.frag");
    std::ofstream(shader) << "void main() {}\n";
    EXPECT_EQ(asked("shader", shader), "read");
    EXPECT_NE(asked("field", file("none.hf")), "read");
    EXPECT_NE(asked("script", file("none.unknown")), "read");
}
