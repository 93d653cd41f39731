// SPDX-License-Identifier: MIT
#include "GlbFile.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace test {
namespace {

const std::string kNode =
    "NODE_PATH='" OSGSKIN_NODE_MODULES "'\"${NODE_PATH:+:$NODE_PATH}\" node -e ";

} // namespace

std::string readBytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

nlohmann::json readJson(const std::string& file) {
    return nlohmann::json::parse(readBytes(file));
}

glm::dvec3 vectorAt(const std::string& bytes, std::size_t offset) {
    return {double(at<float>(bytes, offset)), double(at<float>(bytes, offset + 4)),
            double(at<float>(bytes, offset + 8))};
}

Glb::Glb(const std::string& file) {
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

std::string Glb::view(std::size_t index) const {
    const nlohmann::json& view = json["bufferViews"].at(index);
    const std::size_t begin = view["byteOffset"], size = view["byteLength"];
    EXPECT_EQ(begin % 4, 0u);
    EXPECT_LE(begin + size, binary.size());
    return binary.substr(begin, size);
}

std::string Glb::data(std::size_t index) const {
    const nlohmann::json& accessor = json["accessors"].at(index);
    std::string result = view(accessor["bufferView"]);
    const std::string type = accessor["type"];
    const std::size_t components = type == "SCALAR" ? 1 : std::size_t(type.back() - '0');
    EXPECT_EQ(result.size(), 4 * components * std::size_t(accessor["count"]));
    return result;
}

std::vector<float> Glb::floats(std::size_t accessor) const {
    const std::string bytes = data(accessor);
    std::vector<float> result;
    for (std::size_t offset = 0; offset < bytes.size(); offset += 4)
        result.push_back(at<float>(bytes, offset));
    return result;
}

std::vector<glm::dvec3> Glb::vectors(std::size_t accessor) const {
    const std::string bytes = data(accessor);
    std::vector<glm::dvec3> result;
    for (std::size_t offset = 0; offset < bytes.size(); offset += 12)
        result.push_back(vectorAt(bytes, offset));
    return result;
}

bool hasGlbValidator(std::string& why) {
    const std::string probe = kNode + "\"require('gltf-validator')\" >/dev/null 2>&1";
    if (std::system(probe.c_str()) == 0) return true; // NOLINT(cert-env33-c): our own words
    why = "needs node and the package gltf-validator, which tests/run installs "
          "into " OSGSKIN_NODE_MODULES;
    return false;
}

std::string glbComplaints(const std::string& file) {
    const std::string script =
        "const v=require('gltf-validator'),f=require('fs');"
        "v.validateBytes(new Uint8Array(f.readFileSync(process.argv[1]))).then(r=>{"
        "const bad=r.issues.messages.filter(m=>m.severity<2);"
        "console.log(bad.map(m=>JSON.stringify(m)).join());"
        "process.exit(r.issues.numErrors||r.issues.numWarnings?1:0)})";
    const std::string out = file + ".txt";
    const std::string command = kNode + "\"" + script + "\" '" + file + "' >'" + out + "' 2>&1";
    if (std::system(command.c_str()) == 0) return {}; // NOLINT(cert-env33-c): our own words
    return "refused: " + readBytes(out);
}

} // namespace test
