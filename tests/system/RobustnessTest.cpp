// SPDX-License-Identifier: MIT
// Unusual circumstances: another locale, odd names, files of other systems, a signal.
#include "Command.h"
#include "ExpectContains.h"
#include "TextFile.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <clocale>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <locale>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

namespace fs = std::filesystem;
using osgSkin::Character;
using osgSkin::loadCharacter;

const std::string kParts = OSGSKIN_TEST_DATA "/character/";

void write(const fs::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
}

/// The decimal comma of a German locale.
struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// Sets it for the program, in C++ and in C, by a locale made for this test.
class CommaLocale {
public:
    CommaLocale() : _before(std::locale::global(std::locale(std::locale(), new Comma))) {
        const std::string& folder = madeLocales();
        ::setenv("LOCPATH", folder.c_str(), 1);
        if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr ||
            *std::localeconv()->decimal_point != ',')
            throw std::runtime_error("no locale with a decimal comma in " + folder);
    }
    ~CommaLocale() {
        std::locale::global(_before);
        std::setlocale(LC_ALL, "C");
        ::unsetenv("LOCPATH");
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

private:
    static const std::string& madeLocales() {
        static const std::string folder = [] {
            std::string made = test::makeTestFolder() + "/locales";
            fs::create_directories(made);
            test::runCommand("localedef -i de_DE -f UTF-8 '" + made + "/de_DE.UTF-8'", made);
            return made;
        }();
        return folder;
    }

    std::locale _before;
};

void expectSame(const Character& a, const Character& b) {
    EXPECT_EQ(a.body.mesh.positions, b.body.mesh.positions);
    EXPECT_EQ(a.body.mesh.triangles(), b.body.mesh.triangles());
    ASSERT_EQ(a.rest.joints.size(), b.rest.joints.size());
    for (std::size_t j = 0; j < a.rest.joints.size(); ++j)
        EXPECT_EQ(a.rest.joints[j].centre, b.rest.joints[j].centre);
    ASSERT_EQ(a.binding.influences.size(), b.binding.influences.size());
    for (std::size_t i = 0; i < a.binding.influences.size(); ++i)
        EXPECT_EQ(a.binding.influences[i].bend, b.binding.influences[i].bend);
    EXPECT_EQ(a.motions.size(), b.motions.size());
}

/// Copies of the character's parts with another line end and a prefix before the first line.
std::string rewritten(const std::string& folder, const std::string& lineEnd,
                      const std::string& before) {
    for (const char* name : {"good.skin", "body.obj", "rig.bvh", "move.bvh"}) {
        std::string text = before;
        for (const char c : test::fileText(kParts + name))
            text += c == '\n' ? lineEnd : std::string(1, c);
        write(fs::path(folder) / name, text);
    }
    return folder + "/good.skin";
}

} // namespace

TEST(Robustness, IgnoresDecimalCommaOfTheLocale) {
    const std::string files[] = {kParts + "good.skin", kParts + "painted.skin",
                                 OSGSKIN_TEST_DATA "/rig/tube.gltf"};
    for (const std::string& file : files) {
        const Character plain = loadCharacter(file);
        const CommaLocale comma;
        expectSame(loadCharacter(file), plain);
    }
    // Read by osgDB, and searched for numbers in its text.
    const std::string saved = test::makeTestFolder() + "/saved.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*loadCharacter(files[0]).root, saved));
    const osg::ref_ptr<osg::Node> plain = osgDB::readRefNodeFile(saved);
    const CommaLocale comma;
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(saved);
    ASSERT_TRUE(plain && read);
    EXPECT_EQ(read->getBound().radius(), plain->getBound().radius());
}

TEST(Robustness, ReportsFilesThatCannotBeWritten) {
    const std::string folder = test::makeTestFolder();
    const std::string good = "'" + kParts + "good.skin' --quiet ";
    fs::create_directories(folder + "/taken.glb");
    write(folder + "/file", "whole");
    for (const char* out :
         {"--out nowhere/o.glb", "--out file/o.glb", "--out taken.glb", "--rest nowhere/r.obj",
          "--pose nowhere/p.json", "--out nowhere/f%d.ply"}) {
        const auto result = test::runBake(good + out, folder);
        EXPECT_EQ(result.status, 1) << out;
        test::expectContains(result.err, "cannot be written", out);
    }
    EXPECT_EQ(test::fileText(folder + "/file"), "whole");
    EXPECT_TRUE(fs::is_empty(folder + "/taken.glb"));
    EXPECT_FALSE(fs::exists(folder + "/nowhere"));
}

TEST(Robustness, ReadsCrLfAndByteOrderMarks) {
    const std::string folder = test::makeTestFolder();
    const Character plain = loadCharacter(kParts + "good.skin");
    expectSame(loadCharacter(rewritten(folder, "\r\n", "")), plain);
    expectSame(loadCharacter(rewritten(folder, "\n", "\xef\xbb\xbf")), plain);
    expectSame(loadCharacter(rewritten(folder, "\r\n", "\xef\xbb\xbf")), plain);
    // A mark must not swallow the first word.
    std::string body = test::fileText(kParts + "body.obj");
    body.erase(0, body.find("v "));
    write(folder + "/body.obj", "\xef\xbb\xbf" + body);
    expectSame(loadCharacter(folder + "/good.skin"), plain);
}

TEST(Robustness, AcceptsUnicodeQuotesAndBlanksInFileNames) {
    const fs::path folder = fs::path(test::makeTestFolder()) / "-a b \xc3\xbc 'c' \"d\" %d";
    fs::create_directory(folder);
    fs::copy_file(kParts + "body.obj", folder / "-b\xc3\xb6"
                                                "dy #1 (x).obj");
    fs::copy_file(kParts + "rig.bvh", folder / "rig \"2\".bvh");
    fs::copy_file(kParts + "move.bvh", folder / "move's%20.bvh");
    const std::string skin = (folder / "-\xe4\xba\xba & co.skin").string();
    write(skin, "{\"osgskin\": 1, \"mesh\": \"-b\\u00f6dy #1 (x).obj\", \"skeleton\": \"rig "
                "\\\"2\\\".bvh\","
                " \"motions\": [{\"file\": \"move's%20.bvh\", \"name\": \"m\"}]}");
    const Character plain = loadCharacter(kParts + "good.skin");
    Character odd = loadCharacter(skin);
    EXPECT_EQ(odd.body.mesh.positions, plain.body.mesh.positions);
    EXPECT_EQ(odd.motions.size(), 1u);
    EXPECT_TRUE(osgDB::readRefNodeFile(skin));
    const auto baked =
        test::runBake("'./-\xe4\xba\xba & co.skin' --quiet --rest='-r \xc3\xbc.obj'",
                      folder.parent_path().string() + "/-a b \xc3\xbc '\\''c'\\'' \"d\" %d");
    EXPECT_EQ(baked.status, 0) << baked.err;
    EXPECT_TRUE(fs::exists(folder / "-r \xc3\xbc.obj"));
}

TEST(Robustness, AcceptsLongestFileNames) {
    const fs::path folder = test::makeTestFolder();
    for (const std::size_t length : {251u, 246u, 200u}) {
        const std::string name = std::string(length, 'n') + ".obj";
        const auto baked =
            test::runBake("'" + kParts + "good.skin' --quiet --rest " + name, folder.string());
        EXPECT_EQ(baked.status, 0) << baked.err;
        EXPECT_TRUE(fs::exists(folder / name));
    }
}

TEST(Robustness, FormatsNumbersInFileNamesOnly) {
    const fs::path folder = test::makeTestFolder();
    fs::create_directory(folder / "100%d");
    const auto baked = test::runBake(
        "'" + kParts + "good.skin' --quiet --frames 0:1 --out '100%d/x_%02d.obj'", folder.string());
    EXPECT_EQ(baked.status, 0) << baked.err;
    EXPECT_TRUE(fs::exists(folder / "100%d" / "x_01.obj"));
}

/// Command lines that would open a window, print to a full disk or ignore what they ask for.
TEST(Robustness, ProgramsRejectIncompleteCommandLines) {
    const std::string folder = test::makeTestFolder();
    const std::string crowd = "'" OSGSKIN_CROWD "' '" + kParts + "good.skin' --count 2 ";
    const struct {
        std::string command;
        int status;
    } cases[] = {{"'" OSGSKIN_VIEWER "' --out ''", 2},
                 {"'" OSGSKIN_VIEWER "' --out=", 2},
                 {"'" OSGSKIN_VIEWER "' --times", 2},
                 {"'" OSGSKIN_THROW "' --out ''", 2},
                 {crowd + "--time 1 --out x", 2},
                 {crowd + "--frames 2", 2},
                 {crowd + "--frames 2:1 --out x", 2},
                 {crowd + "--window 0 0 10 0 --time 1", 2},
                 {crowd + "no.skin --time 1", 1},
                 {"'" OSGSKIN_CROWD "' --no-such-option", 2},
                 {"'" OSGSKIN_VIEWER "' no.skin --out x", 1},
                 {"'" OSGSKIN_VIEWER "' -O shapes=no --out x", 2},
                 {"'" OSGSKIN_VIEWER "' --width 100", 2},
                 {"'" OSGSKIN_THROW "' --data nowhere --out x", 1},
                 {"'" OSGSKIN_THROW "' --frames 0:1000000 --out x", 2},
                 {"'" OSGSKIN_THROW "' -O shapes=none --out x", 2},
                 {"'" OSGSKIN_FIGURES "'", 2},
                 {"'" OSGSKIN_FIGURES "' no.skin --out x", 1},
                 {"'" OSGSKIN_BAKE "'", 2},
                 {"'" OSGSKIN_BAKE "' no.skin --out x%d.obj", 1},
                 {crowd + "--time 1", 0},
                 {"(" + crowd + "--time 1 > /dev/full)", 1}};
    for (const auto& c : cases) {
        const test::CommandResult result = test::runCommand(c.command, folder);
        EXPECT_EQ(result.status, c.status) << c.command << "\n" << result.err;
        EXPECT_EQ(result.err.empty(), c.status == 0) << c.command << "\n" << result.err;
    }
}

/// Without a file to write, a program must not fill the folder.
TEST(Robustness, BakeWithoutOutputListsOutputs) {
    const fs::path folder = test::makeTestFolder();
    const auto result = test::runBake("'" + kParts + "good.skin'", folder.string());
    EXPECT_EQ(result.status, 2);
    test::expectContains(result.err,
                         "nothing to write: expected --out, --rest, --binding, --pose, --rigged or "
                         "--walker");
    test::expectContains(result.err, " frames, for example for --out frame_%04d.obj");
    for (const auto& entry : fs::directory_iterator(folder))
        EXPECT_EQ(entry.path().extension(), ".txt") << entry; // what the program has said
}

/// A sparse file that is larger than the memory the process may have.
TEST(Robustness, OutOfMemoryNamesTheFile) {
    if (OSGSKIN_SANITIZED) GTEST_SKIP() << "sanitizers need more memory than that";
    const fs::path folder = test::makeTestFolder();
    std::ofstream(folder / "big.glb", std::ios::binary) << "{";
    fs::resize_file(folder / "big.glb", 900u << 20);
    const auto result = test::runCommand(
        "ulimit -v 600000; '" OSGSKIN_BAKE "' big.glb --quiet --rest rest.obj", folder.string());
    fs::remove(folder / "big.glb");
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "osgskinbake: big.glb: out of memory\n");
}

TEST(Robustness, SignalsLeaveNoPartialFiles) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const fs::path folder = test::makeTestFolder();
        const std::string skin = rewritten(folder.string(), "\n", "");
        std::ofstream motion(folder / "move.bvh", std::ios::binary);
        const std::string whole = test::fileText(kParts + "move.bvh");
        motion << whole.substr(0, whole.find("Frames:")) << "Frames: 9000\nFrame Time: 0.1\n";
        for (int f = 0; f < 9000; ++f) motion << f << " 0 0 0 0 0 30 0 0\n";
        motion.close();
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            ::signal(signal, SIG_DFL);
            const std::string out = (folder / "f%d.obj").string();
            ::execl(OSGSKIN_BAKE, OSGSKIN_BAKE, skin.c_str(), "--quiet", "--motion", "move",
                    "--out", out.c_str(), nullptr);
            ::_exit(99);
        }
        for (int wait = 0; wait < 20000 && !fs::exists(folder / "f5.obj"); ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ::kill(child, signal);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
        const std::string first = test::fileText(folder / "f0.obj");
        const auto lines = std::count(first.begin(), first.end(), '\n');
        std::size_t files = 0;
        for (const auto& entry : fs::directory_iterator(folder)) {
            EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
            if (entry.path().filename().string()[0] != 'f' || entry.path().extension() != ".obj")
                continue;
            const std::string text = test::fileText(entry.path());
            EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), lines) << entry.path();
            ++files;
        }
        EXPECT_GE(files, 6u);
        EXPECT_LT(files, 9000u);
    }
}
