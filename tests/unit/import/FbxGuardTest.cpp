// SPDX-License-Identifier: MIT
// FBX files that are refused before Assimp reads them, and parts that are not read at all.
#include "assimp/FbxDocument.h"
#include "assimp/FbxModels.h"

#include "ExpectError.h"

#include <cstdint>
#include <string>
#include <vector>

namespace {

using osgSkin::FbxDocument;

std::string bytesOf(std::uint32_t number) {
    std::string result;
    for (int k = 0; k < 4; ++k, number >>= 8u) result += static_cast<char>(number & 0xffu);
    return result;
}

/// A record of a binary file.
struct Record {
    std::string name;
    std::vector<std::string> values{};
    std::vector<Record> records{};
    int longer = 0; ///< bytes that its stated end is off

    std::string write(std::size_t at) const {
        std::string all;
        for (const std::string& value : values) all += value;
        const auto bytes = static_cast<std::uint32_t>(all.size());
        const std::size_t begin = at + 13 + name.size();
        for (const Record& record : records) all += record.write(begin + all.size());
        if (!records.empty()) all += std::string(13, '\0');
        const auto end =
            static_cast<std::uint32_t>(begin + all.size()) + static_cast<std::uint32_t>(longer);
        return bytesOf(end) + bytesOf(static_cast<std::uint32_t>(values.size())) + bytesOf(bytes) +
               static_cast<char>(name.size()) + name + all;
    }
};

std::string binaryOf(const std::vector<Record>& records) {
    std::string file = std::string("Kaydara FBX Binary  \0\x1a\0", 23) + bytesOf(7400);
    for (const Record& record : records) file += record.write(file.size());
    return file + std::string(13, '\0');
}

std::string text(const std::string& value) {
    return 'S' + bytesOf(static_cast<std::uint32_t>(value.size())) + value;
}

std::string id(std::uint32_t number) {
    return 'L' + bytesOf(number) + bytesOf(0);
}

/// A compressed array of eight bytes, which are no zlib stream.
std::string array(char type, std::uint32_t count) {
    return type + bytesOf(count) + bytesOf(1) + bytesOf(8) + "garbage!";
}

std::string fileWith(const Record& inModel) {
    return binaryOf({{"Objects", {}, {{"Model", {id(7), text("a"), text("Null")}, {inModel}}}}});
}

void expectRefusal(const std::string& file, const std::string& part) {
    expectError([&] { FbxDocument::read(file, "x.fbx"); }, part);
}

Record nested(int depth) {
    Record result{"deepest"};
    for (int d = 1; d < depth; ++d) result = {"deep", {}, {result}};
    return result;
}

} // namespace

TEST(FbxGuard, InflatesOnlyArraysThatAreRead) {
    const FbxDocument document =
        FbxDocument::read(fileWith({"Vertices", {array('d', 100)}}), "x.fbx");
    ASSERT_EQ(document.objects.size(), 1u);
    EXPECT_TRUE(document.objects[0].records.empty());
    expectRefusal(fileWith({"TransformLink", {array('d', 16)}}), "malformed record at byte");
}

TEST(FbxGuard, RejectsStatedLengthsBeyondTheFiles) {
    const std::string huge = "its arrays state too many numbers for a file of ";
    for (const char* const name : {"Vertices", "KeyTime"}) {
        expectRefusal(fileWith({name, {array('d', 0xffffffffu)}}), huge);
        expectRefusal(fileWith({name, {array('b', 20u << 20u)}}), huge);
    }
    // All together, and in records that are not kept.
    const std::string large = array('d', 1u << 20u);
    expectRefusal(binaryOf({{"Takes", {large, large, large}}}), huge);
    const std::string plain = "i" + bytesOf(4) + bytesOf(0) + bytesOf(8) + "12345678";
    expectRefusal(fileWith({"Edges", {plain}}), "malformed record at byte");
    expectRefusal("Objects: {\n Geometry: 1 {\n Vertices: *99999999999999999999 {\n",
                  "states more numbers than the file has characters");
    expectRefusal("Objects: {\n Geometry: 1 {\n Vertices: *4000 {\n",
                  "states more numbers than the file has characters");
}

TEST(FbxGuard, RejectsDeepRecords) {
    EXPECT_NO_THROW(FbxDocument::read(binaryOf({nested(65)}), "x.fbx"));
    expectRefusal(binaryOf({nested(66)}), "x.fbx: records are nested more than 64 deep");
    std::string deep = "; \"{ {\nA: \"{\" ";
    for (int d = 0; d < 64; ++d) deep += "{\nB: ";
    EXPECT_NO_THROW(FbxDocument::read(deep, "x.fbx"));
    expectRefusal(deep + "{\n", "records are nested more than 64 deep");
}

/// Otherwise bytes would be read again at each depth.
TEST(FbxGuard, RejectsRecordsThatEndAfterTheOneAbove) {
    Record inner{"Version"};
    inner.longer = 14;
    expectRefusal(fileWith(inner), "malformed record at byte");
}

TEST(FbxGuard, CountsModelsForEachConnection) {
    const auto check = [](const std::string& connections) {
        const osgSkin::FbxModels models(FbxDocument::read(
            "Objects: {\nModel: 1, \"Model::a\", \"Null\" {\n}\nModel: 2, \"Model::b\", \"Null\" "
            "{\n}\n}\nConnections: {\nC: \"OO\",1,0\n" +
                connections + "}\n",
            "x.fbx"));
        osgSkin::ReadLimits limits;
        limits.joints = 50;
        limits.depth = 20;
        models.checkNodes("x.fbx", limits);
    };
    std::string repeated;
    for (int k = 0; k < 49; ++k) repeated += "C: \"OO\",2,1\n";
    EXPECT_NO_THROW(check(repeated));
    expectError([&] { check(repeated + "C: \"OO\",2,1\n"); }, "(option maxJoints)");
    expectError([&] { check("C: \"OO\",2,1\nC: \"OO\",1,2\n"); }, "is nested more than 20 deep");
}
