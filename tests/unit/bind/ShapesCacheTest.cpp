// SPDX-License-Identifier: GPL-3.0-or-later
#include "ScratchFolder.h"
#include "TextFile.h"

#include <correctives/ShapesCache.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

const std::string kDigest = digestOf("what they are made of");

/// Two vertices below a root and one joint.
Binding someBinding() {
    Binding binding;
    binding.joints.resize(2);
    binding.joints[1].parent = 0;
    binding.regions = {0, 1};
    return binding;
}

MadeShapes someShapes() {
    MadeShapes shapes;
    shapes.notes = {"a line", ""};
    CorrectiveJoint& joint = shapes.correctives.joints.emplace_back();
    joint.joint = 1;
    joint.axis = {1, 0, 0};
    joint.low = {-0.5, -0.25};
    joint.high = {0.75, 0.25};
    joint.modes = 1;
    joint.coefficients = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    shapes.correctives.firstEntry = {0, 0, 1};
    shapes.correctives.entries = {{0, 0}};
    shapes.correctives.shares = {Correctives::kUnit, 0, -5};
    return shapes;
}

void replace(const std::filesystem::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

} // namespace

TEST(ShapesCache, GivesBackWhatItWasGiven) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    const ShapesCache cache((scratch.path() / "a" / "b").string(), kDigest);
    EXPECT_FALSE(cache.read(someBinding(), notes));
    cache.write(someShapes(), notes);
    EXPECT_EQ(scratch.files().size(), 1u); // no temporary file remains
    const std::optional<MadeShapes> found = cache.read(someBinding(), notes);
    EXPECT_TRUE(notes.empty());
    ASSERT_TRUE(found);
    const MadeShapes expected = someShapes();
    EXPECT_EQ(found->notes, expected.notes);
    const CorrectiveJoint &joint = found->correctives.joints.at(0),
                          &known = expected.correctives.joints[0];
    EXPECT_EQ(joint.joint, known.joint);
    EXPECT_EQ(joint.basis, known.basis);
    EXPECT_EQ(joint.axis, known.axis);
    EXPECT_EQ(joint.low, known.low);
    EXPECT_EQ(joint.high, known.high);
    EXPECT_EQ(joint.modes, known.modes);
    EXPECT_EQ(joint.coefficients, known.coefficients);
    EXPECT_EQ(found->correctives.firstEntry, expected.correctives.firstEntry);
    EXPECT_EQ(found->correctives.entries.size(), 1u);
    EXPECT_EQ(found->correctives.shares, expected.correctives.shares);
}

TEST(ShapesCache, KnowsNothingOfOthers) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    ShapesCache(scratch.path().string(), kDigest).write(someShapes(), notes);
    EXPECT_NE(digestOf("something else"), kDigest);
    const ShapesCache other(scratch.path().string(), digestOf("something else"));
    EXPECT_FALSE(other.read(someBinding(), notes));
    EXPECT_TRUE(notes.empty());
}

TEST(ShapesCache, SaysSoOfAFileThatIsNoUse) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    const ShapesCache cache(scratch.path().string(), kDigest);
    cache.write(someShapes(), notes);
    const std::filesystem::path file = scratch.files().at(0);
    const std::string whole = test::fileText(file);
    std::string changed = whole;
    changed[whole.size() - 3] = static_cast<char>(changed[whole.size() - 3] ^ 1);
    const std::vector<std::string> broken{
        "",          "no",    whole.substr(0, whole.size() - 1),
        whole + "x", changed, std::string("x").append(whole.substr(1))};
    for (std::size_t i = 0; i < broken.size(); ++i) {
        replace(file, broken[i]);
        notes.clear();
        EXPECT_FALSE(cache.read(someBinding(), notes)) << i;
        EXPECT_EQ(notes.size(), 1u) << i;
    }
    replace(file, whole);
    Binding smaller = someBinding();
    smaller.regions.pop_back(); // the file is complete, but for another skin
    notes.clear();
    EXPECT_FALSE(cache.read(smaller, notes));
    EXPECT_EQ(notes.size(), 1u);
}

TEST(ShapesCache, OpensNothingButFilesAsLargeAsShapesAre) {
    const ScratchFolder scratch;
    std::vector<std::string> notes;
    const ShapesCache cache(scratch.path().string(), kDigest);
    cache.write(someShapes(), notes);
    const std::filesystem::path file = scratch.files().at(0);
    const auto expectNoUse = [&](const char* what) {
        notes.clear();
        EXPECT_FALSE(cache.read(someBinding(), notes)) << what;
        EXPECT_EQ(notes.size(), 1u) << what;
        std::filesystem::remove(file);
    };
    std::filesystem::resize_file(file, std::uintmax_t(1) << 40); // a sparse file, without disk
                                                                 // space
    expectNoUse("a file of a terabyte");
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    expectNoUse("a pipe");
    std::filesystem::create_symlink("/dev/zero", file);
    expectNoUse("a device");
    std::filesystem::create_directory(file);
    expectNoUse("a folder");
    cache.write(someShapes(), notes);
    EXPECT_TRUE(cache.read(someBinding(), notes));
}

TEST(ShapesCache, SaysWhereItCannotWrite) {
    const ScratchFolder scratch;
    replace(scratch.path() / "file", "no folder");
    std::vector<std::string> notes;
    const ShapesCache cache((scratch.path() / "file").string(), kDigest);
    cache.write(someShapes(), notes);
    EXPECT_EQ(notes.size(), 1u);
}
