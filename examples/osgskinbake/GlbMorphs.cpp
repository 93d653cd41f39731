// SPDX-License-Identifier: GPL-3.0-or-later
#include "GlbMorphs.h"

#include <osgSkin/Error>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bake {
namespace {

constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

void pad(std::string& data, char with) {
    while (data.size() % 4 != 0) data += with;
}

std::vector<glm::dvec3> differences(const std::vector<glm::dvec3>& a,
                                    const std::vector<glm::dvec3>& b) {
    std::vector<glm::dvec3> result;
    result.reserve(a.size());
    for (std::size_t v = 0; v < a.size(); ++v) result.push_back(a[v] - b[v]);
    return result;
}

} // namespace

GlbMorphs::GlbMorphs(std::string file, const FrameSeries& series)
    : _file(std::move(file)), _series(series) {}

std::size_t GlbMorphs::accessor(std::size_t begin, std::size_t count, const char* type,
                                int component, Use use) {
    nlohmann::json view{
        {"buffer", 0}, {"byteOffset", begin}, {"byteLength", _buffer.data.size() - begin}};
    if (use != Use::Data)
        view["target"] = use == Use::Vertices ? kArrayBuffer : kElementArrayBuffer;
    _accessors.push_back({{"bufferView", _views.size()},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    _views.push_back(view);
    return _accessors.size() - 1;
}

std::size_t GlbMorphs::addVectors(const std::vector<glm::dvec3>& vectors, bool withRange) {
    const std::size_t begin = _buffer.data.size();
    // As floats, so that the range is that of what is stored.
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (const glm::dvec3& v : vectors) {
        _buffer.add(v);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<float>(v[static_cast<int>(axis)]);
            low[axis] = std::min(low[axis], value);
            high[axis] = std::max(high[axis], value);
        }
    }
    const std::size_t index = accessor(begin, vectors.size(), "VEC3", kFloat, Use::Vertices);
    if (withRange) {
        _accessors[index]["min"] = low;
        _accessors[index]["max"] = high;
    }
    return index;
}

std::size_t GlbMorphs::addIndices() {
    const std::size_t begin = _buffer.data.size();
    const std::vector<std::uint32_t> triangles = _series.mesh->triangles();
    for (const std::uint32_t v : triangles) _buffer.add(v);
    return accessor(begin, triangles.size(), "SCALAR", kUnsignedInt, Use::Indices);
}

void GlbMorphs::add(std::size_t, const PosedMesh& posed) {
    if (_frames++ == 0) {
        _base = posed;
        _attributes = {{"POSITION", addVectors(posed.positions, true)},
                       {"NORMAL", addVectors(posed.normals, false)}};
        return;
    }
    _targets.push_back(
        {{"POSITION", addVectors(differences(posed.positions, _base.positions), true)},
         {"NORMAL", addVectors(differences(posed.normals, _base.normals), false)}});
    if (_buffer.data.size() > std::numeric_limits<std::uint32_t>::max() / 2)
        throw osgSkin::Error(_file + ": too large for a .glb file, expected fewer frames");
}

nlohmann::json GlbMorphs::animation() {
    const std::size_t timesBegin = _buffer.data.size();
    for (std::size_t f = 0; f < _frames; ++f)
        _buffer.add(static_cast<float>(static_cast<double>(f) * _series.seconds));
    const std::size_t times = accessor(timesBegin, _frames, "SCALAR", kFloat, Use::Data);
    _accessors[times]["min"] = {0.0f};
    _accessors[times]["max"] = {
        static_cast<float>(static_cast<double>(_frames - 1) * _series.seconds)};
    const std::size_t weightsBegin = _buffer.data.size();
    for (std::size_t f = 0; f < _frames; ++f)
        for (std::size_t target = 1; target < _frames; ++target)
            _buffer.add(f == target ? 1.0f : 0.0f);
    const std::size_t weights =
        accessor(weightsBegin, _frames * (_frames - 1), "SCALAR", kFloat, Use::Data);
    return {{"name", "motion"},
            {"samplers", {{{"input", times}, {"output", weights}, {"interpolation", "LINEAR"}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}};
}

void GlbMorphs::finish() {
    const std::size_t indices = addIndices();
    nlohmann::json primitive{{"attributes", _attributes}, {"indices", indices}, {"material", 0}};
    nlohmann::json mesh{{"name", "skin"}};
    nlohmann::json node{{"name", "skin"}, {"mesh", 0}};
    if (_series.zUp) node["rotation"] = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    nlohmann::json root{{"asset", {{"version", "2.0"}, {"generator", "osgskinbake"}}},
                        {"scene", 0},
                        {"scenes", {{{"nodes", {0}}}}}};
    if (!_targets.empty()) {
        primitive["targets"] = _targets;
        mesh["weights"] = std::vector<double>(_targets.size(), 0.0);
        root["animations"] = {animation()};
    }
    mesh["primitives"] = {primitive};
    root["meshes"] = {mesh};
    root["nodes"] = {node};
    root["materials"] = {{{"name", "skin"},
                          {"pbrMetallicRoughness",
                           {{"baseColorFactor", {0.8, 0.74, 0.68, 1.0}},
                            {"metallicFactor", 0.0},
                            {"roughnessFactor", 0.8}}}}};
    root["accessors"] = _accessors;
    root["bufferViews"] = _views;
    root["buffers"] = {{{"byteLength", _buffer.data.size()}}};

    std::string json = root.dump();
    pad(json, ' ');
    pad(_buffer.data, '\0');
    Bytes file;
    file.data = "glTF";
    file.add(std::uint32_t(2));
    file.add(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + _buffer.data.size()));
    file.add(static_cast<std::uint32_t>(json.size()));
    file.data += "JSON" + json;
    file.add(static_cast<std::uint32_t>(_buffer.data.size()));
    file.data += std::string("BIN\0", 4);
    file.data += _buffer.data;
    writeBytes(_file, file.data);
}

} // namespace bake
