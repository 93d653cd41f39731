// SPDX-License-Identifier: MIT
#include "gltf/GltfDocument.h"

#include "files/FileText.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace osgSkin {
namespace {

using nlohmann::json;

enum ComponentType { kByte = 5120, kUByte, kShort, kUShort, kInt, kUInt, kFloat };

/// The size in bytes; 0 for an unknown component type.
std::size_t componentSize(int component) {
    if (component == kByte || component == kUByte) return 1;
    if (component == kShort || component == kUShort) return 2;
    return component == kUInt || component == kFloat ? 4 : 0;
}

std::size_t typeWidth(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

/// Reads a size or an offset; 0 if there is none.
std::size_t sizeOf(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) return 0;
    const auto value = found->is_number_unsigned() ? found->get<std::size_t>() : ~std::size_t(0);
    return std::min<std::size_t>(value, std::size_t(1) << 40); // far beyond any buffer
}

/// Converts the file's numbers; `bytes` is the stride between elements.
template <typename Number, typename Result>
void convert(const char* from, std::size_t bytes, std::size_t width, std::size_t count,
             Result* to) {
    for (std::size_t i = 0; i < count; ++i, from += bytes)
        for (std::size_t k = 0; k < width; ++k) {
            Number value;
            std::memcpy(&value, from + k * sizeof value, sizeof value);
            *to++ = static_cast<Result>(+value);
        }
}

/// Maps a type's largest number to 1.
float normalised(float value, int component) {
    const auto exact = static_cast<double>(value);
    switch (component) {
    case kByte:
        return static_cast<float>(std::max(exact / 127.0, -1.0));
    case kUByte:
        return static_cast<float>(exact / 255.0);
    case kShort:
        return static_cast<float>(std::max(exact / 32767.0, -1.0));
    case kUShort:
        return static_cast<float>(exact / 65535.0);
    default:
        return value;
    }
}

} // namespace

GltfAccessors::GltfAccessors(const GltfFile& file) : _file(file) {
    _views.reserve(file.size("bufferViews"));
    file.forEach("bufferViews", [&](const json& from, const std::string& where) {
        _views.push_back({file.indexOf(from.at("buffer"), "buffers", where + ".buffer"),
                          sizeOf(from, "byteOffset"), sizeOf(from, "byteLength"),
                          sizeOf(from, "byteStride")});
    });
    _accessors.reserve(file.size("accessors"));
    file.forEach("accessors", [&](const json& from, const std::string& where) {
        GltfAccessor known;
        known.count = sizeOf(from, "count");
        known.type = from.at("type").get<std::string>();
        known.width = typeWidth(known.type);
        const json& component = from.at("componentType");
        known.component =
            component.is_number_unsigned() && component.get<std::size_t>() < 5127
                ? component.get<int>()
                : static_cast<int>(file.index(component, 5127, where + ".componentType"));
        known.normalised = from.value("normalized", false);
        known.stored = from.contains("bufferView");
        known.sparse = from.contains("sparse");
        known.error = findError(from, known);
        _accessors.push_back(std::move(known));
    });
}

std::string GltfAccessors::viewError(const json& view, std::size_t offset, std::size_t elements,
                                     std::size_t bytes, bool packed) const {
    if (!view.is_number_unsigned() || view.get<std::size_t>() >= _views.size())
        return "an existing buffer view";
    const View& source = _views[view.get<std::size_t>()];
    const std::string* const content = _file.buffers[source.buffer].get();
    const std::size_t buffer = content == nullptr ? 0 : content->size();
    if (source.offset > buffer || source.length > buffer - source.offset)
        return "a buffer view within its buffer";
    const std::size_t given = packed ? 0 : source.stride;
    if (given != 0 && given < bytes) return "a stride of at least one element";
    const std::size_t stride = given == 0 ? bytes : given;
    if (elements == 0 || bytes == 0) return {};
    if (offset > source.length || bytes > source.length - offset ||
        (elements - 1) > (source.length - offset - bytes) / stride)
        return "elements within the buffer view";
    return {};
}

std::string_view GltfAccessors::bytesOf(std::size_t view) const {
    const View& source = _views[view];
    const std::string* const content = _file.buffers[source.buffer].get();
    if (content == nullptr) return {};
    return std::string_view(*content).substr(source.offset, source.length);
}

std::string GltfAccessors::findError(const json& from, GltfAccessor& known) const {
    const std::size_t component = componentSize(known.component), width = known.width;
    if (component == 0) return "a component type of 5120 to 5126";
    if (width == 0) return "a type SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4";
    if ((known.type == "MAT2" || known.type == "MAT3") && component < 4)
        return "matrices of floats";
    if (known.stored) {
        const json& view = from.at("bufferView");
        known.offset = sizeOf(from, "byteOffset");
        std::string error = viewError(view, known.offset, known.count, component * width, false);
        if (!error.empty()) return error;
        known.view = view.get<std::size_t>();
    } else if (known.count > 2 * _file.limits.samplesOf(_file.allBytes())) {
        return "fewer zeros for the file's size (option maxSamples)";
    }
    if (!known.sparse) return {};
    const json& sparse = from.at("sparse");
    const json &indices = sparse.at("indices"), &values = sparse.at("values");
    known.changes = sizeOf(sparse, "count");
    known.indexComponent = indices.at("componentType").get<int>();
    if (known.indexComponent != kUByte && known.indexComponent != kUShort &&
        known.indexComponent != kUInt)
        return "sparse indices of the component type 5121, 5123 or 5125";
    known.indexOffset = sizeOf(indices, "byteOffset");
    std::string error = viewError(indices.at("bufferView"), known.indexOffset, known.changes,
                                  componentSize(known.indexComponent), true);
    if (!error.empty()) return error;
    known.indexView = indices.at("bufferView").get<std::size_t>();
    known.changeOffset = sizeOf(values, "byteOffset");
    error = viewError(values.at("bufferView"), known.changeOffset, known.changes, component * width,
                      true);
    if (error.empty()) known.changeView = values.at("bufferView").get<std::size_t>();
    return error;
}

std::size_t GltfAccessors::indexOf(const json& value, const std::string& where) const {
    const bool isThere = value.is_number_unsigned() && value.get<std::size_t>() < _accessors.size();
    const std::size_t index =
        isThere ? value.get<std::size_t>() : _file.indexOf(value, "accessors", where);
    const std::string& error = _accessors[index].error;
    if (!error.empty()) _file.fail("accessors[" + std::to_string(index) + "], " + where, error);
    return index;
}

void GltfAccessors::requireType(std::size_t accessor, std::initializer_list<const char*> types,
                                const std::string& where) const {
    for (const char* type : types)
        if (_accessors[accessor].type == type) return;
    _file.fail(where, std::string("an accessor of ") + *types.begin());
}

void GltfAccessors::requireIndices(std::size_t accessor, bool wide,
                                   const std::string& where) const {
    const int component = _accessors[accessor].component;
    if (component != kUByte && component != kUShort && !(wide && component == kUInt))
        _file.fail(where, "unsigned whole numbers");
}

void GltfAccessors::requireValues(std::size_t accessor, const std::string& where) const {
    if (!_accessors[accessor].hasValues())
        _file.fail("accessors[" + std::to_string(accessor) + "], " + where, "a buffer view");
}

template <typename Result>
void GltfAccessors::read(std::size_t view, std::size_t offset, int component, std::size_t width,
                         std::size_t count, bool packed, std::vector<Result>& result) const {
    const std::string_view bytes = bytesOf(view);
    const std::size_t element = componentSize(component) * width;
    const std::size_t given = packed ? 0 : _views[view].stride;
    const std::size_t stride = given == 0 ? element : given;
    result.resize(count * width);
    if (result.empty()) return;
    const char* const from = bytes.data() + offset;
    Result* const to = result.data();
    switch (component) {
    case kByte:
        return convert<std::int8_t>(from, stride, width, count, to);
    case kUByte:
        return convert<std::uint8_t>(from, stride, width, count, to);
    case kShort:
        return convert<std::int16_t>(from, stride, width, count, to);
    case kUShort:
        return convert<std::uint16_t>(from, stride, width, count, to);
    case kUInt:
        return convert<std::uint32_t>(from, stride, width, count, to);
    default:
        return convert<float>(from, stride, width, count, to);
    }
}

/// Reads the elements that a sparse accessor replaces.
template <typename Result>
void GltfAccessors::readChanges(std::size_t index, std::vector<std::uint32_t>& indices,
                                std::vector<Result>& values) const {
    const GltfAccessor& source = _accessors[index];
    read(source.indexView, source.indexOffset, source.indexComponent, 1, source.changes, true,
         indices);
    read(source.changeView, source.changeOffset, source.component, source.width, source.changes,
         true, values);
    for (const std::uint32_t changed : indices)
        if (changed >= source.count)
            _file.fail("accessors[" + std::to_string(index) + "].sparse.indices",
                       "numbers below " + std::to_string(source.count));
}

template <typename Result>
std::vector<Result> GltfAccessors::all(std::size_t index) const {
    const GltfAccessor& source = _accessors[index];
    std::vector<Result> result;
    if (source.stored)
        read(source.view, source.offset, source.component, source.width, source.count, false,
             result);
    else
        result.assign(source.count * source.width, Result(0));
    if (!source.sparse) return result;
    std::vector<std::uint32_t> indices;
    std::vector<Result> values;
    readChanges(index, indices, values);
    for (std::size_t i = 0; i < indices.size(); ++i)
        std::copy_n(values.begin() + std::ptrdiff_t(i * source.width), source.width,
                    result.begin() + std::ptrdiff_t(indices[i] * source.width));
    return result;
}

std::vector<float> GltfAccessors::floats(std::size_t index) const {
    std::vector<float> result = all<float>(index);
    if (_accessors[index].normalised)
        for (float& value : result) value = normalised(value, _accessors[index].component);
    return result;
}

VertexOffsets GltfAccessors::offsets(std::size_t index) const {
    const GltfAccessor& source = _accessors[index];
    VertexOffsets result;
    const auto add = [&result](std::size_t vertex, const float* v) {
        if (v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f) return;
        result.vertices.push_back(static_cast<std::uint32_t>(vertex));
        result.offsets.emplace_back(v[0], v[1], v[2]);
    };
    if (source.stored) {
        const std::vector<float> all = floats(index);
        for (std::size_t v = 0; v < source.count; ++v) add(v, &all[3 * v]);
        return result;
    }
    if (!source.sparse) return result;
    std::vector<std::uint32_t> elements;
    std::vector<float> numbers;
    readChanges(index, elements, numbers);
    if (source.normalised)
        for (float& value : numbers) value = normalised(value, source.component);
    std::vector<std::size_t> order(elements.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto isBefore = [&](std::size_t a, std::size_t b) { return elements[a] < elements[b]; };
    if (!std::is_sorted(order.begin(), order.end(), isBefore))
        std::stable_sort(order.begin(), order.end(), isBefore);
    for (std::size_t k = 0; k < order.size(); ++k)
        if (k + 1 == order.size() || isBefore(order[k], order[k + 1])) // else replaced again
            add(elements[order[k]], &numbers[3 * order[k]]);
    return result;
}

std::vector<std::uint32_t> GltfAccessors::integers(std::size_t index) const {
    return all<std::uint32_t>(index);
}

} // namespace osgSkin
