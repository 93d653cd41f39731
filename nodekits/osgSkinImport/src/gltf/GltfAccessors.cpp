// SPDX-License-Identifier: MIT
#include "gltf/GltfAccessors.h"

#include "text/FileText.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

namespace osgSkin {
namespace {

enum ComponentType { kByte = 5120, kUByte, kShort, kUShort, kInt, kUInt, kFloat };

std::size_t sizeOf(int type) {
    if (type == kByte || type == kUByte) return 1;
    return type == kShort || type == kUShort ? 2 : 4;
}

std::size_t widthOf(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    return type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

template <typename Number>
double numberFrom(const char* at) {
    Number value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

double component(const char* at, int type) {
    switch (type) {
    case kByte:
        return numberFrom<std::int8_t>(at);
    case kUByte:
        return numberFrom<std::uint8_t>(at);
    case kShort:
        return numberFrom<std::int16_t>(at);
    case kUShort:
        return numberFrom<std::uint16_t>(at);
    case kInt:
        return numberFrom<std::int32_t>(at);
    case kUInt:
        return numberFrom<std::uint32_t>(at);
    default:
        return numberFrom<float>(at);
    }
}

/// What the largest number of a type stands for is 1.
double normalised(double value, int type) {
    switch (type) {
    case kByte:
        return std::max(value / 127.0, -1.0);
    case kUByte:
        return value / 255.0;
    case kShort:
        return std::max(value / 32767.0, -1.0);
    case kUShort:
        return value / 65535.0;
    default:
        return value;
    }
}

template <typename Number>
std::string bytesOf(const std::vector<double>& values) {
    std::string bytes;
    bytes.reserve(values.size() * sizeof(Number));
    for (const double value : values) {
        const auto stored = static_cast<Number>(value);
        char raw[sizeof stored];
        std::memcpy(raw, &stored, sizeof stored);
        bytes.append(raw, sizeof stored);
    }
    return bytes;
}

std::size_t sizeAt(const nlohmann::json& object, const char* key) {
    return object.value(key, std::size_t(0));
}

} // namespace

const nlohmann::json& GltfAccessors::accessor(std::size_t index) const {
    return _file.json.at("accessors").at(index);
}

std::size_t GltfAccessors::count(std::size_t index) const {
    return accessor(index).at("count").get<std::size_t>();
}

std::size_t GltfAccessors::width(std::size_t index) const {
    return widthOf(accessor(index).at("type").get<std::string>());
}

std::size_t GltfAccessors::componentBytes(std::size_t index) const {
    return sizeOf(accessor(index).at("componentType").get<int>());
}

bool GltfAccessors::isWhole(std::size_t index) const {
    const nlohmann::json& source = accessor(index);
    if (!source.contains("bufferView") || source.contains("sparse")) return false;
    const nlohmann::json& view =
        _file.json.at("bufferViews").at(source.at("bufferView").get<std::size_t>());
    const std::size_t stride = sizeAt(view, "byteStride");
    return stride == 0 || count(index) <= sizeAt(view, "byteLength") / stride;
}

bool GltfAccessors::isPlain(std::size_t index) const {
    return accessor(index).at("componentType") == int(kFloat) && isWhole(index);
}

bool GltfAccessors::hasValues(std::size_t index) const {
    return accessor(index).contains("bufferView") || accessor(index).contains("sparse");
}

const std::string& GltfAccessors::buffer(std::size_t index) const {
    if (!_file.buffers.isThere(index))
        failFile(_file.path, "buffer " + std::to_string(index) + " has no content");
    return _file.buffers[index];
}

void GltfAccessors::read(std::size_t view, std::size_t offset, int type, std::size_t wide,
                         std::size_t many, std::vector<double>& result) {
    const nlohmann::json& source = _file.json.at("bufferViews").at(view);
    const std::string& bytes = buffer(source.at("buffer").get<std::size_t>());
    const std::size_t size = sizeOf(type);
    // Columns of small matrices begin at multiples of four bytes.
    const bool padded = wide == 9 && size < 4;
    const std::size_t columns = padded ? 3 : 1;
    const std::size_t rows = wide / columns;
    const std::size_t column = padded ? (rows * size + 3) / 4 * 4 : rows * size;
    const std::size_t stride = std::max(sizeAt(source, "byteStride"), columns * column);
    const std::size_t begin = sizeAt(source, "byteOffset") + offset;
    if (many > 0 && (begin > bytes.size() || (bytes.size() - begin) / stride + 1 < many ||
                     begin + stride * (many - 1) + columns * column > bytes.size()))
        failFile(_file.path, "buffer view " + std::to_string(view) + " ends beyond its buffer");
    result.reserve(result.size() + many * wide);
    for (std::size_t i = 0; i < many; ++i)
        for (std::size_t c = 0; c < columns; ++c)
            for (std::size_t r = 0; r < rows; ++r)
                result.push_back(
                    component(bytes.data() + begin + i * stride + c * column + r * size, type));
}

std::vector<double> GltfAccessors::values(std::size_t index) {
    std::vector<double> result = stored(index);
    const nlohmann::json& source = accessor(index);
    if (source.value("normalized", false))
        for (double& value : result)
            value = normalised(value, source.at("componentType").get<int>());
    return result;
}

std::vector<double> GltfAccessors::stored(std::size_t index) {
    const nlohmann::json& source = accessor(index);
    const int type = source.at("componentType").get<int>();
    const std::size_t wide = width(index), many = count(index);
    std::vector<double> result;
    if (source.contains("bufferView"))
        read(source.at("bufferView").get<std::size_t>(), sizeAt(source, "byteOffset"), type, wide,
             many, result);
    else if (many < std::numeric_limits<std::uint32_t>::max() / 16)
        result.assign(many * wide, 0.0);
    if (source.contains("sparse")) {
        const nlohmann::json& sparse = source.at("sparse");
        const auto changes = sparse.at("count").get<std::size_t>();
        const nlohmann::json& places = sparse.at("indices");
        const nlohmann::json& changed = sparse.at("values");
        std::vector<double> indices, numbers;
        read(places.at("bufferView").get<std::size_t>(), sizeAt(places, "byteOffset"),
             places.at("componentType").get<int>(), 1, changes, indices);
        read(changed.at("bufferView").get<std::size_t>(), sizeAt(changed, "byteOffset"), type, wide,
             changes, numbers);
        const bool fits = std::all_of(indices.begin(), indices.end(),
                                      [&](double place) { return place < double(many); });
        if (!fits)
            failFile(_file.path, "malformed glTF: accessors[" + std::to_string(index) +
                                     "].sparse.indices: expected numbers below " +
                                     std::to_string(many));
        for (std::size_t i = 0; i < changes; ++i)
            for (std::size_t k = 0; k < wide; ++k)
                result.at(static_cast<std::size_t>(indices[i]) * wide + k) = numbers[i * wide + k];
    }
    return result;
}

std::size_t GltfAccessors::addBytes(const std::string& type, int component, std::size_t numbers,
                                    std::string bytes) {
    nlohmann::json& views = _file.json["bufferViews"];
    nlohmann::json& accessors = _file.json["accessors"];
    const std::size_t length = bytes.size();
    views.push_back({{"buffer", _file.addBuffer(std::move(bytes))}, {"byteLength", length}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", component},
                         {"count", numbers / widthOf(type)},
                         {"type", type}});
    return accessors.size() - 1;
}

std::size_t GltfAccessors::add(const std::string& type, const std::vector<double>& values) {
    return addBytes(type, kFloat, values.size(), bytesOf<float>(values));
}

std::size_t GltfAccessors::addShorts(const std::string& type, const std::vector<double>& values) {
    return addBytes(type, kUShort, values.size(), bytesOf<std::uint16_t>(values));
}

std::size_t GltfAccessors::addInts(const std::string& type, const std::vector<double>& values) {
    return addBytes(type, kUInt, values.size(), bytesOf<std::uint32_t>(values));
}

} // namespace osgSkin
