// SPDX-License-Identifier: MIT
#include "gltf/plain/GltfParts.h"

#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using nlohmann::json;

constexpr std::size_t kEntriesOf = 20;     ///< samples that an entry counts for: a kilobyte or two
constexpr std::size_t kFarthest = 1 << 30; ///< offsets and sizes beyond are none
constexpr std::size_t kLongestNodeName = 500; ///< Assimp has room for 1023, and writes beyond it

std::size_t componentSize(int component) {
    if (component == 5120 || component == 5121) return 1;
    if (component == 5122 || component == 5123) return 2;
    return component == 5125 || component == 5126 ? 4 : 0;
}

std::size_t typeWidth(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

/// A size or an offset; 0 where there is none.
std::size_t sizeOf(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) return 0;
    const auto value = found->is_number_unsigned() ? found->get<std::size_t>() : ~std::size_t(0);
    return std::min<std::size_t>(value, std::size_t(1) << 40); // far beyond any buffer
}

bool isCoordinate(const json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= kLargestCoordinate; // not NaN
}

} // namespace

GltfParts::GltfParts(const GltfFile& file) : _file(file), _bytes(file.size + file.beside) {}

void GltfParts::fail(const std::string& where, const std::string& expected) const {
    failFile(_file.path, "malformed glTF: " + where + ": expected " + expected);
}

std::size_t GltfParts::size(const char* list) const {
    if (!has(list)) return 0;
    if (!at(list).is_array()) fail(list, "a list");
    return at(list).size();
}

void GltfParts::forEach(const char* list,
                        const std::function<void(const json&, const std::string&)>& visit) const {
    for (std::size_t i = 0; i < size(list); ++i) {
        const std::string where = std::string(list) + "[" + std::to_string(i) + "]";
        if (!at(list)[i].is_object()) fail(where, "an object");
        try {
            visit(at(list)[i], where);
        } catch (const json::exception& error) { // of a member that is not there, or another kind
            failFile(_file.path, "malformed glTF: " + where + ": " + reasonOf(error));
        }
    }
}

std::size_t GltfParts::index(const json& value, std::size_t size, const std::string& where) const {
    if (!value.is_number_unsigned() || value.get<std::size_t>() >= size)
        fail(where, "a whole number below " + std::to_string(size));
    return value.get<std::size_t>();
}

std::size_t GltfParts::indexOf(const json& value, const char* list,
                               const std::string& where) const {
    return index(value, size(list), where + " (one of " + list + ")");
}

void GltfParts::copyName(const json& from, json& to) {
    const auto found = from.find("name");
    if (found == from.end() || !found->is_string()) return;
    std::string name = found->get<std::string>();
    if (name.size() > kLongestNodeName) {
        std::size_t end = kLongestNodeName;
        while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end; // UTF-8
        name.resize(end);
    }
    std::replace(name.begin(), name.end(), '\0', '_'); // which would end it
    to["name"] = name;
}

void GltfParts::copyNumbers(const json& from, const char* key, std::size_t count,
                            const std::string& where, json& to) const {
    const auto found = from.find(key);
    if (found == from.end()) return;
    if (!found->is_array() || found->size() != count ||
        !std::all_of(found->begin(), found->end(), isCoordinate))
        fail(where + "." + key, std::to_string(count) + " numbers from -1e18 to 1e18");
    to[key] = *found;
}

void GltfParts::copyNumber(const json& from, const char* key, const std::string& where,
                           json& to) const {
    const auto found = from.find(key);
    if (found == from.end()) return;
    if (!isCoordinate(*found)) fail(where + "." + key, "a number from -1e18 to 1e18");
    to[key] = *found;
}

void GltfParts::copyWeights(const json& from, const std::string& where, json& to) const {
    const auto found = from.find("weights");
    if (found != from.end() && found->is_array())
        copyNumbers(from, "weights", found->size(), where, to);
}

void GltfParts::checkBuffers(json& result) {
    for (std::size_t i = 0; i < _file.buffers.count(); ++i)
        result["buffers"].push_back({{"byteLength", _file.buffers.sizeOf(i)}});
    forEach("bufferViews", [&](const json& from, const std::string& where) {
        json view = {{"buffer", indexOf(from.at("buffer"), "buffers", where + ".buffer")},
                     {"byteOffset", sizeOf(from, "byteOffset")},
                     {"byteLength", sizeOf(from, "byteLength")}};
        if (sizeOf(from, "byteStride") > 0) view["byteStride"] = sizeOf(from, "byteStride");
        result["bufferViews"].push_back(view);
    });
}

std::string GltfParts::beyondView(const json& view, std::size_t offset, std::size_t elements,
                                  std::size_t bytes, bool packed) const {
    if (!view.is_number_unsigned() || view.get<std::size_t>() >= size("bufferViews"))
        return "a buffer view that is there";
    const json& source = at("bufferViews")[view.get<std::size_t>()];
    const std::size_t begin = sizeOf(source, "byteOffset"), length = sizeOf(source, "byteLength");
    const std::size_t buffer = _file.buffers.sizeOf(source.at("buffer").get<std::size_t>());
    if (begin > buffer || length > buffer - begin) return "a buffer view within its buffer";
    const std::size_t given = packed ? 0 : sizeOf(source, "byteStride");
    if (given != 0 && given < bytes) return "a stride of an element at least";
    const std::size_t stride = given == 0 ? bytes : given;
    if (elements == 0 || bytes == 0) return {};
    if (offset > length || bytes > length - offset ||
        (elements - 1) > (length - offset - bytes) / stride)
        return "elements within the buffer view";
    return {};
}

std::string_view GltfParts::bytesOf(const json& view) const {
    const json& source = at("bufferViews")[view.get<std::size_t>()];
    const auto buffer = source.at("buffer").get<std::size_t>();
    if (!_file.buffers.isThere(buffer)) return {};
    return std::string_view(_file.buffers[buffer])
        .substr(sizeOf(source, "byteOffset"), sizeOf(source, "byteLength"));
}

std::string GltfParts::wrongWith(const json& accessor, const Accessor& known) const {
    const std::size_t component = componentSize(known.component), width = typeWidth(known.type);
    if (component == 0) return "a component type of 5120 to 5126";
    if (width == 0) return "a type SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4";
    if ((known.type == "MAT2" || known.type == "MAT3") && component < 4)
        return "matrices of floats";
    if (accessor.contains("bufferView")) {
        std::string wrong = beyondView(accessor.at("bufferView"), sizeOf(accessor, "byteOffset"),
                                       known.count, component * width, false);
        if (!wrong.empty()) return wrong;
    } else if (known.count > 2 * limits().samplesOf(_bytes)) {
        return "no more zeros than the file has room for (option maxSamples)";
    }
    if (!known.sparse) return {};
    const json& sparse = accessor.at("sparse");
    const json &places = sparse.at("indices"), &values = sparse.at("values");
    const std::size_t changes = sizeOf(sparse, "count");
    const int kind = places.at("componentType").get<int>();
    const std::size_t place = componentSize(kind);
    if (kind != 5121 && kind != 5123 && kind != 5125)
        return "sparse indices of the component type 5121, 5123 or 5125";
    std::string wrong =
        beyondView(places.at("bufferView"), sizeOf(places, "byteOffset"), changes, place, true);
    if (!wrong.empty()) return wrong;
    return beyondView(values.at("bufferView"), sizeOf(values, "byteOffset"), changes,
                      component * width, true);
}

void GltfParts::checkAccessors(json& result) {
    forEach("accessors", [&](const json& from, const std::string& where) {
        Accessor known;
        known.count = sizeOf(from, "count");
        known.type = from.at("type").get<std::string>();
        const json& component = from.at("componentType");
        known.component = static_cast<int>(index(component, 5127, where + ".componentType"));
        known.sparse = from.contains("sparse");
        known.stored = from.contains("bufferView");
        known.wrong = wrongWith(from, known);
        _accessors.push_back(known);
        json accessor = {{"count", known.count},
                         {"type", known.type},
                         {"componentType", known.component},
                         {"normalized", from.value("normalized", false)}};
        // What nothing names need not be right; what is wrong is refused where it is named.
        if (known.wrong.empty()) {
            if (from.contains("bufferView")) accessor["bufferView"] = from.at("bufferView");
            if (sizeOf(from, "byteOffset") > 0) accessor["byteOffset"] = sizeOf(from, "byteOffset");
            if (known.sparse) {
                json& sparse = accessor["sparse"];
                sparse["count"] = from.at("sparse").at("count");
                for (const char* part : {"indices", "values"})
                    for (const char* key : {"bufferView", "byteOffset", "componentType"})
                        if (from.at("sparse").at(part).contains(key))
                            sparse[part][key] = from.at("sparse").at(part).at(key);
            }
        }
        result["accessors"].push_back(accessor);
    });
}

std::size_t GltfParts::accessor(const json& value, const std::string& where) const {
    const std::size_t index = indexOf(value, "accessors", where);
    const std::string& wrong = _accessors[index].wrong;
    if (!wrong.empty()) fail("accessors[" + std::to_string(index) + "], " + where, wrong);
    return index;
}

std::size_t GltfParts::bytesOfComponent(std::size_t accessor) const {
    return componentSize(_accessors[accessor].component);
}

void GltfParts::requireType(std::size_t accessor, std::initializer_list<const char*> types,
                            const std::string& where) const {
    for (const char* type : types)
        if (_accessors[accessor].type == type) return;
    fail(where, std::string("an accessor of ") + *types.begin());
}

void GltfParts::requireIndices(std::size_t accessor, bool wide, const std::string& where) const {
    const Accessor& known = _accessors[accessor];
    const bool fits =
        known.component == 5121 || known.component == 5123 || (wide && known.component == 5125);
    if (!fits) fail(where, "unsigned whole numbers");
}

void GltfParts::requireValues(std::size_t accessor, const std::string& where) const {
    if (!_accessors[accessor].stored && !_accessors[accessor].sparse)
        fail("accessors[" + std::to_string(accessor) + "], " + where, "a buffer view");
}

void GltfParts::take(std::size_t elements, const std::string& where) {
    _elements += elements;
    if (_elements > 2 * limits().samplesOf(_bytes))
        fail(where,
             "no more vertices, corners and keys than the file's size allows, each as often as "
             "it is named (option maxSamples)");
}

void GltfParts::takeZeros(std::size_t accessor, const std::string& where) {
    const Accessor& known = _accessors[accessor];
    if (!known.stored) take(typeWidth(known.type) * known.count, where);
}

void GltfParts::checkEntries() const {
    const std::size_t most = limits().samplesOf(_bytes) / kEntriesOf;
    std::size_t all = _entries;
    for (const char* list : {"nodes", "scenes", "materials", "textures", "images", "samplers"})
        all += size(list);
    if (all > most)
        fail("nodes, bones, materials and channels", "at most " + std::to_string(most) +
                                                         ", found " + std::to_string(all) +
                                                         " (option maxSamples)");
}

void GltfParts::addDraco(const json& from, const std::string& where, json& primitive) const {
    const json none = json::object();
    const json extensions = from.value("extensions", none);
    const auto found = extensions.find("KHR_draco_mesh_compression");
    if (found == extensions.end()) return;
    json draco = {{"attributes", json::object()},
                  {"bufferView", indexOf(found->at("bufferView"), "bufferViews", where)}};
    const std::string wrong = beyondView(found->at("bufferView"), 0, 0, 0, true);
    if (!wrong.empty()) fail(where + ".extensions", wrong);
    for (const auto& [name, id] : found->at("attributes").items())
        if (primitive.at("attributes").contains(name))
            draco["attributes"][name] = index(id, kFarthest, where + ".extensions");
    primitive["extensions"]["KHR_draco_mesh_compression"] = draco;
}

} // namespace osgSkin
