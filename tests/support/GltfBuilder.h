// SPDX-License-Identifier: MIT
// Small glTF files for tests, each with a habit of some exporter.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace test {

/// A file under construction: `json` may be changed freely before save().
class GltfBuilder {
public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", nlohmann::json::array()}}}},
                           {"nodes", nlohmann::json::array()},
                           {"meshes", nlohmann::json::array()},
                           {"accessors", nlohmann::json::array()},
                           {"bufferViews", nlohmann::json::array()}};

    std::size_t node(const nlohmann::json& node) {
        json["nodes"].push_back(node);
        return json["nodes"].size() - 1;
    }

    /// Adds numbers of a component type (5126: float), in a buffer view of their own. Normalised
    /// ones are given as the floats that they represent.
    std::size_t accessor(const std::string& type, const std::vector<double>& values,
                         int component = 5126, bool normalized = false) {
        while (_bytes.size() % 4 != 0) _bytes.push_back('\0');
        const std::size_t begin = _bytes.size();
        for (const double value : values) add(value, component, normalized);
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", _bytes.size() - begin}});
        const std::size_t width = type == "SCALAR" ? 1
                                  : type == "MAT4" ? 16
                                                   : static_cast<std::size_t>(type[3] - '0');
        nlohmann::json accessor = {{"bufferView", json["bufferViews"].size() - 1},
                                   {"componentType", component},
                                   {"count", values.size() / width},
                                   {"type", type}};
        if (normalized) accessor["normalized"] = true;
        json["accessors"].push_back(accessor);
        return json["accessors"].size() - 1;
    }

    /// Adds an animation of one channel, or adds the channel to the existing animation `name`.
    void animate(const std::string& name, std::size_t node, const std::string& path,
                 const std::vector<double>& times, const std::vector<double>& values,
                 const std::string& interpolation = "LINEAR", int component = 5126) {
        nlohmann::json* found = nullptr;
        for (nlohmann::json& known : json["animations"])
            if (known["name"] == name) found = &known;
        if (found == nullptr) {
            json["animations"].push_back({{"name", name},
                                          {"channels", nlohmann::json::array()},
                                          {"samplers", nlohmann::json::array()}});
            found = &json["animations"].back();
        }
        const std::size_t input = accessor("SCALAR", times);
        const std::size_t output = accessor(path == "rotation"  ? "VEC4"
                                            : path == "weights" ? "SCALAR"
                                                                : "VEC3",
                                            values, component, component != 5126);
        (*found)["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
        (*found)["channels"].push_back({{"sampler", (*found)["samplers"].size() - 1},
                                        {"target", {{"node", node}, {"path", path}}}});
    }

    const std::string& bytes() const { return _bytes; }

    /// Writes a file with an embedded buffer to the tests' folder; returns its path.
    std::string save(const std::string& name) {
        if (!json.contains("buffers"))
            json["buffers"] = {{{"byteLength", _bytes.size()},
                                {"uri", "data:application/octet-stream;base64," + base64()}}};
        std::string path = testing::TempDir() + name;
        std::ofstream(path) << json.dump();
        return path;
    }

private:
    template <typename Number>
    void raw(Number number) {
        char bytes[sizeof number];
        std::memcpy(bytes, &number, sizeof number);
        _bytes.append(bytes, sizeof number);
    }

    void add(double value, int component, bool normalized) {
        switch (component) {
        case 5120:
            raw(std::int8_t(std::lround(value * (normalized ? 127 : 1))));
            break;
        case 5121:
            raw(std::uint8_t(std::lround(value * (normalized ? 255 : 1))));
            break;
        case 5122:
            raw(std::int16_t(std::lround(value * (normalized ? 32767 : 1))));
            break;
        case 5123:
            raw(std::uint16_t(std::lround(value * (normalized ? 65535 : 1))));
            break;
        case 5125:
            raw(std::uint32_t(value));
            break;
        default:
            raw(float(value));
        }
    }

    std::string base64() const {
        static const char* letters =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text, padded = _bytes;
        while (padded.size() % 3 != 0) padded.push_back('\0');
        for (std::size_t i = 0; i < padded.size(); i += 3) {
            const unsigned bits = unsigned(std::uint8_t(padded[i])) << 16 |
                                  unsigned(std::uint8_t(padded[i + 1])) << 8 |
                                  unsigned(std::uint8_t(padded[i + 2]));
            for (int k = 18; k >= 0; k -= 6) text.push_back(letters[bits >> k & 63u]);
        }
        for (std::size_t k = 0; k < padded.size() - _bytes.size(); ++k)
            text[text.size() - 1 - k] = '=';
        return text;
    }

    std::string _bytes;
};

/// A column of boxes, one per joint, each joint at its box's foot with weight 1: "base", "middle"
/// and "top", one unit apart along y. The mesh is a sibling of the joints.
struct GltfColumn : GltfBuilder {
    std::vector<std::size_t> joints;
    std::size_t meshNode = 0, positions = 0, weights = 0, jointIndices = 0, inverseBind = 0;
    std::vector<double> places; ///< of the mesh's vertices

    /// \param unit size of a box in the mesh's own space
    explicit GltfColumn(double unit = 1.0) {
        const char* names[] = {"base", "middle", "top"};
        for (std::size_t j = 0; j < 3; ++j) {
            nlohmann::json joint = {{"name", names[j]}};
            if (j > 0) joint["translation"] = {0, 1, 0};
            joints.push_back(node(joint));
        }
        json["nodes"][0]["children"] = {1};
        json["nodes"][1]["children"] = {2};
        std::vector<double> corners, indices, whole;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t first = places.size() / 3;
            for (int c = 0; c < 8; ++c) {
                places.push_back(unit * (c & 1 ? 0.3 : -0.3));
                places.push_back(unit * (double(j) + (c & 2 ? 0.95 : 0.05)));
                places.push_back(unit * (c & 4 ? 0.2 : -0.2));
                corners.insert(corners.end(), {double(j), 0, 0, 0});
                whole.insert(whole.end(), {1, 0, 0, 0});
            }
            for (const int corner : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
                indices.push_back(double(first) + corner);
        }
        positions = accessor("VEC3", places);
        jointIndices = accessor("VEC4", corners, 5121);
        weights = accessor("VEC4", whole);
        const std::size_t faces = accessor("SCALAR", indices, 5123);
        std::vector<double> matrices;
        for (std::size_t j = 0; j < 3; ++j)
            for (int k = 0; k < 16; ++k)
                matrices.push_back(k == 13      ? -double(j)
                                   : k == 15    ? 1.0
                                   : k % 5 == 0 ? 1.0 / unit
                                                : 0.0);
        inverseBind = accessor("MAT4", matrices);
        json["meshes"].push_back(
            {{"name", "column"},
             {"primitives",
              {{{"attributes",
                 {{"POSITION", positions}, {"JOINTS_0", jointIndices}, {"WEIGHTS_0", weights}}},
                {"indices", faces}}}}});
        json["skins"] = {{{"joints", joints}, {"inverseBindMatrices", inverseBind}}};
        meshNode = node({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
        json["scenes"][0]["nodes"] = {0, meshNode};
    }

    nlohmann::json& attributes() { return json["meshes"][0]["primitives"][0]["attributes"]; }

    /// A rotation about x, in degrees.
    static std::vector<double> turn(double degrees) {
        const double half = degrees * std::acos(-1.0) / 360.0;
        return {std::sin(half), 0, 0, std::cos(half)};
    }

    static std::vector<double> turns(const std::vector<double>& degrees) {
        std::vector<double> result;
        for (const double angle : degrees)
            for (const double number : turn(angle)) result.push_back(number);
        return result;
    }

    /// "bend": middle and top rotate by up to 90 degrees in one second.
    void bend() {
        for (const std::size_t joint : {joints[1], joints[2]})
            animate("bend", joint, "rotation", {0.0, 0.5, 1.0}, turns({0, 60, 90}));
    }
};

} // namespace test
