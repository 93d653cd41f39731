// SPDX-License-Identifier: GPL-3.0-or-later
#include "GlbBuffer.h"

#include <osgSkin/Error>

#include <algorithm>
#include <array>
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

} // namespace

std::size_t GlbBuffer::addView(std::size_t begin, Use use) {
    nlohmann::json view{
        {"buffer", 0}, {"byteOffset", begin}, {"byteLength", _bytes.data.size() - begin}};
    if (use != Use::Data)
        view["target"] = use == Use::Vertices ? kArrayBuffer : kElementArrayBuffer;
    _views.push_back(view);
    return _views.size() - 1;
}

std::size_t GlbBuffer::addAccessor(std::size_t begin, std::size_t count, const char* type,
                                   int component, Use use) {
    _accessors.push_back({{"bufferView", addView(begin, use)},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return _accessors.size() - 1;
}

std::size_t GlbBuffer::addVectors(const std::vector<glm::dvec3>& vectors, bool withRange) {
    const std::size_t begin = size();
    // As floats, so that the range is that of what is stored.
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (const glm::dvec3& v : vectors) {
        _bytes.add(v);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<float>(v[static_cast<int>(axis)]);
            low[axis] = std::min(low[axis], value);
            high[axis] = std::max(high[axis], value);
        }
    }
    const std::size_t index = addAccessor(begin, vectors.size(), "VEC3", kFloat, Use::Vertices);
    if (withRange) {
        _accessors[index]["min"] = low;
        _accessors[index]["max"] = high;
    }
    return index;
}

std::size_t GlbBuffer::addTexCoords(const std::vector<osg::Vec2>& texCoords) {
    const std::size_t begin = size();
    for (const osg::Vec2& t : texCoords) {
        _bytes.add(t.x());
        _bytes.add(1.0f - t.y()); // glTF counts from the upper left
    }
    return addAccessor(begin, texCoords.size(), "VEC2", kFloat, Use::Vertices);
}

std::size_t GlbBuffer::addColours(const std::vector<osg::Vec4>& linear) {
    const std::size_t begin = size();
    for (const osg::Vec4& c : linear)
        for (unsigned k = 0; k < 4; ++k) _bytes.add(std::clamp(c[k], 0.0f, 1.0f));
    return addAccessor(begin, linear.size(), "VEC4", kFloat, Use::Vertices);
}

std::size_t GlbBuffer::addIndices(const std::vector<std::uint32_t>& indices) {
    const std::size_t begin = size();
    for (const std::uint32_t index : indices) _bytes.add(index);
    return addAccessor(begin, indices.size(), "SCALAR", kUnsignedInt, Use::Indices);
}

std::size_t GlbBuffer::addTimes(const std::vector<float>& ascending) {
    const std::size_t index = addNumbers(ascending);
    _accessors[index]["min"] = {ascending.front()};
    _accessors[index]["max"] = {ascending.back()};
    return index;
}

std::size_t GlbBuffer::addNumbers(const std::vector<float>& numbers) {
    const std::size_t begin = size();
    for (const float number : numbers) _bytes.add(number);
    return addAccessor(begin, numbers.size(), "SCALAR", kFloat, Use::Data);
}

std::size_t GlbBuffer::addFile(const std::string& data) {
    const std::size_t begin = size();
    _bytes.data += data;
    const std::size_t view = addView(begin, Use::Data);
    pad(_bytes.data, '\0'); // numbers that follow are aligned
    return view;
}

void GlbBuffer::write(const std::string& file, nlohmann::json root) const {
    root["accessors"] = _accessors;
    root["bufferViews"] = _views;
    root["buffers"] = {{{"byteLength", size()}}};
    std::string json = root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    pad(json, ' ');
    Bytes out;
    out.data = "glTF";
    out.add(std::uint32_t(2));
    std::string binary = _bytes.data;
    pad(binary, '\0');
    const std::size_t total = 12 + 8 + json.size() + 8 + binary.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw osgSkin::Error(file + ": too large for a .glb file, expected fewer frames");
    out.add(static_cast<std::uint32_t>(total));
    out.add(static_cast<std::uint32_t>(json.size()));
    out.data += "JSON" + json;
    out.add(static_cast<std::uint32_t>(binary.size()));
    out.data += std::string("BIN\0", 4);
    out.data += binary;
    writeBytes(file, out.data);
}

} // namespace bake
