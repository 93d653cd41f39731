// SPDX-License-Identifier: MIT
#include "gltf/GltfFile.h"

#include "files/FileText.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

namespace osgSkin {
namespace {

using nlohmann::json;

// --- the text ---

/// Builds the JSON value, and refuses duplicate members of an object, which a parser would drop
/// silently.
class TextReader : public nlohmann::json_sax<json> {
public:
    TextReader(const std::string& path, const std::string& text) : _path(path), _text(text) {}

    json take() { return std::move(_root); }

    bool null() override { return put(nullptr) != nullptr; }
    bool boolean(bool value) override { return put(value) != nullptr; }
    bool number_integer(number_integer_t value) override { return put(value) != nullptr; }
    bool number_unsigned(number_unsigned_t value) override { return put(value) != nullptr; }
    bool number_float(number_float_t value, const string_t&) override {
        return put(value) != nullptr;
    }
    bool string(string_t& value) override { return put(std::move(value)) != nullptr; }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(json::object()); }
    bool start_array(std::size_t) override { return open(json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        Level& here = _open.back();
        const auto [member, isNew] =
            here.value->get_ref<json::object_t&>().emplace(std::move(name), nullptr);
        here.key = &member->first;
        here.member = &member->second;
        if (isNew) return true;
        failFile(_path, "malformed glTF: " + place() + " is a duplicate member");
    }

    bool parse_error(std::size_t byte, const std::string&, const json::exception& error) override {
        const std::size_t at = std::min(byte > 0 ? byte - 1 : 0, _text.size());
        const auto end = _text.begin() + static_cast<std::ptrdiff_t>(at);
        const auto line = std::size_t(std::count(_text.begin(), end, '\n'));
        const std::size_t before = at > 0 ? _text.rfind('\n', at - 1) : std::string::npos;
        const std::size_t column = before == std::string::npos ? at : at - before - 1;
        // 406: a number too large for a double.
        failFile(_path, "malformed glTF: line " + std::to_string(line + 1) + ", column " +
                            std::to_string(column + 1) +
                            (error.id == 406 ? ": expected a finite number" : ": expected JSON"));
    }

private:
    /// An object or list being read.
    struct Level {
        json* value;
        const std::string* key; ///< of the member being read
        json* member;
    };

    template <typename Value>
    json* put(Value&& value) {
        if (_open.empty()) {
            _root = json(std::forward<Value>(value));
            return &_root;
        }
        Level& here = _open.back();
        if (here.value->is_array()) {
            auto& list = here.value->get_ref<json::array_t&>();
            list.emplace_back(std::forward<Value>(value));
            return &list.back();
        }
        *here.member = json(std::forward<Value>(value));
        return here.member;
    }
    bool open(json value) {
        constexpr std::size_t kMaxDepth =
            64; // as in checkJsonDepth(), which would scan the text again
        if (_open.size() >= kMaxDepth)
            failFile(_path, "lists and objects are nested more than " + std::to_string(kMaxDepth) +
                                " deep");
        _open.push_back({put(std::move(value)), nullptr, nullptr});
        return true;
    }
    bool close() {
        _open.pop_back();
        return true;
    }

    /// The path of the current value, such as "meshes[0].name".
    std::string place() const {
        std::string result;
        for (const Level& level : _open) {
            if (level.value->is_array())
                result += "[" + std::to_string(level.value->size() - 1) + "]";
            else
                result += (result.empty() ? "" : ".") + level.key->substr(0, 40);
        }
        return result;
    }

    const std::string& _path;
    const std::string& _text;
    json _root;
    std::vector<Level> _open;
};

/// Exporters of binary files may pad the text with zeros.
json parseText(const std::string& path, std::string text) {
    while (!text.empty() && text.back() == '\0') text.pop_back();
    // The parser ends the text at a byte 0 and ignores the rest.
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        failFile(path, "malformed glTF: byte " + std::to_string(zero) +
                           " of its text is 0, expected JSON");
    TextReader reader(path, text);
    json::sax_parse(text, &reader);
    return reader.take();
}

constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::string_view kJson("JSON", 4), kBinary("BIN\0", 4);

/// Little-endian, like all numbers of a binary file.
std::uint32_t numberAt(std::string_view bytes, std::size_t offset) {
    std::uint32_t result = 0;
    for (std::size_t k = 4; k-- > 0;)
        result = result << 8 | static_cast<unsigned char>(bytes[offset + k]);
    return result;
}

bool isCoordinate(const json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= kLargestCoordinate; // not NaN
}

} // namespace

// --- buffers ---

/// Loads the buffers of a file: the binary chunk for the first buffer if that has no URI, data
/// URIs, and other files, each read once.
class BufferLoader {
public:
    /// \param file whose buffers are loaded
    /// \param binary the binary chunk; null if there is none
    BufferLoader(GltfFile& file, std::string* binary) : _file(file), _binary(binary) {}

    void run() {
        const auto list = _file.json.find("buffers");
        if (list == _file.json.end()) return;
        if (!list->is_array()) _file.fail("buffers", "a list");
        for (const json& buffer : *list) {
            const std::string where = "buffers[" + std::to_string(_file.buffers.size()) + "]";
            if (!buffer.is_object()) _file.fail(where, "an object");
            _file.buffers.push_back(contentOf(buffer, where));
        }
    }

private:
    using Content = std::shared_ptr<const std::string>;

    Content contentOf(const json& buffer, const std::string& where) {
        const auto uri = buffer.find("uri");
        if (uri == buffer.end()) return _file.buffers.empty() ? ownChunk(buffer) : nullptr;
        if (!uri->is_string()) _file.fail(where + ".uri", "a string");
        const std::string& name = uri->get_ref<const std::string&>();
        if (!isDataUri(name)) return otherFile(name, where);
        try {
            return std::make_shared<const std::string>(dataOfUri(name));
        } catch (const Error& error) {
            failFile(_file.path, "malformed glTF: " + where + ".uri: " + error.what());
        }
    }

    /// The chunk may be padded.
    Content ownChunk(const json& buffer) {
        if (_binary == nullptr) return nullptr;
        const auto length = buffer.find("byteLength");
        std::size_t size = 0;
        if (length != buffer.end())
            size = length->is_number_unsigned() ? length->get<std::size_t>() : ~std::size_t(0);
        _binary->resize(std::min(_binary->size(), size));
        return std::make_shared<const std::string>(std::move(*_binary));
    }

    Content otherFile(const std::string& uri, const std::string& where) {
        if (osgDB::containsServerAddress(uri)) _file.fail(where + ".uri", "a file");
        const std::string path =
            osgDB::concatPaths(osgDB::getFilePath(_file.path), decodedUri(uri));
        std::error_code ignored; // a missing file is reported when it is read
        const std::string whole = std::filesystem::canonical(path, ignored).string();
        Content& content = _known[ignored ? path : whole];
        if (content == nullptr) {
            try {
                content = std::make_shared<const std::string>(readText(path, _file.limits));
            } catch (const Error& error) {
                failFile(_file.path, where + ": " + error.what());
            }
            _file._besideBytes += content->size();
        }
        // A file counts each time it is named.
        _named += content->size();
        if ((_file.ownBytes + _named) >> 20 >= _file.limits.fileMegabytes)
            _file.fail("buffers", "less than " + std::to_string(_file.limits.fileMegabytes) +
                                      " MB in all (option maxFileMB)");
        return content;
    }

    GltfFile& _file;
    std::string* _binary;
    std::map<std::string, Content> _known; ///< other files, by canonical path
    std::size_t _named = 0;                ///< bytes of other files
};

// --- the file ---

/// Splits the file into chunks; returns the JSON text. Anything may follow the length in the
/// header.
std::string GltfFile::readChunks(std::string_view all, std::string& binary, bool& hasBinary) {
    if (all.size() < kHeader)
        failFile(path, "malformed glTF: " + std::to_string(all.size()) +
                           " bytes, expected a header of " + std::to_string(kHeader));
    if (numberAt(all, 4) != 2)
        failFile(path, "not a glTF 2 file: binary version " + std::to_string(numberAt(all, 4)) +
                           ", expected 2");
    const std::size_t declared = numberAt(all, 8);
    std::string text;
    for (std::size_t at = kHeader; at + kChunkHeader <= all.size();) {
        const std::size_t size = numberAt(all, at);
        const std::string_view type = all.substr(at + 4, 4);
        if (size > all.size() - at - kChunkHeader) {
            if (at >= declared) break;
            failFile(path, "malformed glTF: the chunk at byte " + std::to_string(at) + " has " +
                               std::to_string(size) + " bytes, expected at most the " +
                               std::to_string(all.size() - at - kChunkHeader) +
                               " that the file has");
        }
        at += kChunkHeader;
        if (type == kJson && text.empty()) text = all.substr(at, size);
        if (type == kBinary && !hasBinary) {
            binary = all.substr(at, size);
            hasBinary = true;
        }
        at += size;
    }
    if (text.empty()) failFile(path, "malformed glTF: expected a chunk of JSON");
    return text;
}

/// Throws if the file is for readers of another version.
void GltfFile::requireSecond() const {
    const auto none = json.end();
    const auto asset = json.is_object() ? json.find("asset") : none;
    if (asset == none || !asset->is_object())
        failFile(path, "not a glTF 2 file: expected an object \"asset\"");
    for (const char* key : {"version", "minVersion"}) {
        const auto found = asset->find(key);
        const bool isThere = found != asset->end();
        if (!isThere && std::string_view(key) == "minVersion") continue;
        const std::string version = isThere && found->is_string() ? found->get<std::string>() : "";
        if (version.rfind('2', 0) != 0)
            failFile(path, std::string("not a glTF 2 file: asset.") + key + " is " +
                               inQuotes(version) + ", expected \"2.0\"");
    }
}

GltfFile GltfFile::read(const std::string& path, const ReadLimits& limits) {
    GltfFile file;
    file.path = path;
    file.limits = limits;
    std::string text = readText(path, limits), binary;
    bool hasBinary = false;
    file.ownBytes = file.diskBytes = text.size();
    if (text.compare(0, 4, "glTF") == 0) text = file.readChunks(text, binary, hasBinary);
    file.json = parseText(path, std::move(text));
    file.requireSecond();
    BufferLoader(file, hasBinary ? &binary : nullptr).run();
    return file;
}

std::size_t GltfFile::addBuffer(std::string bytes) {
    buffers.push_back(std::make_shared<const std::string>(std::move(bytes)));
    json["buffers"].push_back({{"byteLength", buffers.back()->size()}});
    return buffers.size() - 1;
}

// --- lists and numbers ---

void GltfFile::fail(const std::string& where, const std::string& expected) const {
    failFile(path, "malformed glTF: " + where + ": expected " + expected);
}

std::size_t GltfFile::size(const char* list) const {
    const auto found = json.find(list);
    if (found == json.end()) return 0;
    if (!found->is_array()) fail(list, "a list");
    return found->size();
}

void GltfFile::forEach(
    const char* list,
    const std::function<void(const nlohmann::json&, const std::string&)>& visit) const {
    const std::size_t count = size(list);
    if (count == 0) return;
    const nlohmann::json& entries = json.at(list);
    std::string where = std::string(list) + "[";
    const std::size_t start = where.size();
    for (std::size_t i = 0; i < count; ++i) {
        where.replace(start, std::string::npos, std::to_string(i) + "]");
        if (!entries[i].is_object()) fail(where, "an object");
        try {
            visit(entries[i], where);
        } catch (const nlohmann::json::exception& error) {
            failFile(path, "malformed glTF: " + where + ": " + reasonOf(error));
        }
    }
}

std::size_t GltfFile::index(const nlohmann::json& value, std::size_t size,
                            const std::string& where) const {
    if (!value.is_number_unsigned() || value.get<std::size_t>() >= size)
        fail(where, "a whole number below " + std::to_string(size));
    return value.get<std::size_t>();
}

std::size_t GltfFile::indexOf(const nlohmann::json& value, const char* list,
                              const std::string& where) const {
    const std::size_t count = size(list);
    if (value.is_number_unsigned() && value.get<std::size_t>() < count)
        return value.get<std::size_t>();
    return index(value, count, where + " (one of " + list + ")");
}

std::vector<double> GltfFile::numbers(const nlohmann::json& from, const char* key,
                                      std::size_t count, const std::string& where) const {
    const auto found = from.find(key);
    if (found == from.end()) return {};
    if (!found->is_array() || found->size() != count ||
        !std::all_of(found->begin(), found->end(), isCoordinate))
        fail(where + "." + key, std::to_string(count) + " numbers from -1e18 to 1e18");
    return found->get<std::vector<double>>();
}

double GltfFile::number(const nlohmann::json& from, const char* key, double otherwise,
                        const std::string& where) const {
    const auto found = from.find(key);
    if (found == from.end()) return otherwise;
    if (!isCoordinate(*found)) fail(where + "." + key, "a number from -1e18 to 1e18");
    return found->get<double>();
}

std::vector<double> GltfFile::weights(const nlohmann::json& from, const std::string& where) const {
    const auto found = from.find("weights");
    if (found == from.end() || !found->is_array()) return {};
    return numbers(from, "weights", found->size(), where);
}

void GltfFile::take(std::size_t elements, const std::string& where) {
    _elements += elements;
    if (_elements > 2 * limits.samplesOf(allBytes()))
        fail(
            where,
            "fewer vertices, corners and keys for the file's size, counted each time they are used "
            "(option maxSamples)");
}

void GltfFile::checkEntries() const {
    constexpr std::size_t kSamples = 20; // samples per entry
    const std::size_t limit = limits.samplesOf(allBytes()) / kSamples;
    std::size_t all = _entries;
    for (const char* list : {"nodes", "scenes", "materials", "textures", "images", "samplers"})
        all += size(list);
    if (all > limit)
        fail("nodes, bones, materials and channels", "at most " + std::to_string(limit) +
                                                         ", found " + std::to_string(all) +
                                                         " (option maxSamples)");
}

std::string nameOf(const nlohmann::json& object) {
    constexpr std::size_t kLongest = 500;
    const auto found = object.find("name");
    if (found == object.end() || !found->is_string()) return {};
    std::string name = found->get<std::string>();
    if (name.size() > kLongest) {
        std::size_t end = kLongest;
        while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end; // UTF-8
        name.resize(end);
    }
    std::replace(name.begin(), name.end(), '\0', '_');
    return name;
}

std::string reasonOf(const nlohmann::json::exception& error) {
    const std::string text = error.what(); // "[json.exception.KIND.NUMBER] REASON"
    const std::size_t end = text.find("] ");
    return end == std::string::npos ? text : text.substr(end + 2);
}

// --- URIs ---

std::string decodedUri(std::string_view uri) {
    std::string result;
    result.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const char* const digits = uri.data() + i + 1;
        const bool isCode = uri[i] == '%' && i + 2 < uri.size() &&
                            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
        result.push_back(isCode ? static_cast<char>(code) : uri[i]);
        if (isCode) i += 2;
    }
    return result;
}

bool isDataUri(std::string_view uri) {
    return osgDB::convertToLowerCase(std::string(uri.substr(0, 5))) == "data:";
}

namespace {

constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The value of a base64 letter; an invalid value for other bytes.
std::size_t base64Value(char letter) {
    static const std::array<unsigned char, 256> values = [] {
        std::array<unsigned char, 256> result;
        result.fill(255);
        for (std::size_t i = 0; i < kBase64.size(); ++i)
            result[static_cast<unsigned char>(kBase64[i])] = static_cast<unsigned char>(i);
        return result;
    }();
    return values[static_cast<unsigned char>(letter)];
}

/// \throw osgSkin::Error with the reason only
std::string fromBase64(std::string_view text) {
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int count = 0;
    // Only padding may follow.
    const std::size_t end = text.find_last_not_of("= \t\r\n");
    for (std::size_t i = 0; end != std::string_view::npos && i <= end; ++i) {
        const std::size_t value = base64Value(text[i]);
        if (value >= kBase64.size()) {
            if (std::string_view(" \t\r\n").find(text[i]) != std::string_view::npos) continue;
            throw Error("letter " + std::to_string(i) + " is " + inQuotes(text.substr(i, 1)) +
                        ", expected base64 (A to Z, a to z, 0 to 9, + and /)");
        }
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<char>(bits >> count & 0xffu));
    }
    return bytes;
}

} // namespace

std::string dataOfUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) throw Error("no comma, expected data behind one");
    const std::string kind = osgDB::convertToLowerCase(std::string(uri.substr(0, comma)));
    const std::string_view data = uri.substr(comma + 1), base64 = ";base64";
    const bool isBase64 = kind.size() >= base64.size() &&
                          kind.compare(kind.size() - base64.size(), base64.size(), base64) == 0;
    if (!isBase64) return decodedUri(data);
    return fromBase64(
        data.find('%') == std::string_view::npos ? data : std::string_view(decodedUri(data)));
}

} // namespace osgSkin
