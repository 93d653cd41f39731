// SPDX-License-Identifier: MIT
#include "gltf/GltfFile.h"

#include "gltf/text/GltfJson.h"
#include "text/FileText.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::string_view kJson("JSON", 4), kBinary("BIN\0", 4);

/// Little-endian, as all numbers of a binary file.
std::uint32_t numberAt(std::string_view bytes, std::size_t offset) {
    std::uint32_t result = 0;
    for (std::size_t k = 4; k-- > 0;)
        result = result << 8 | static_cast<unsigned char>(bytes[offset + k]);
    return result;
}

void addNumber(std::string& bytes, std::size_t number) {
    for (std::size_t k = 0; k < 4; ++k) bytes.push_back(static_cast<char>(number >> 8 * k & 0xff));
}

/// Takes the chunks apart; returns the text. What follows the length that the header tells may be
/// anything.
std::string readChunks(std::string_view all, GltfFile& file) {
    const std::size_t told = numberAt(all, 8);
    std::string text;
    for (std::size_t at = kHeader; at + kChunkHeader <= all.size();) {
        const std::size_t size = numberAt(all, at);
        const std::string_view type = all.substr(at + 4, 4);
        if (size > all.size() - at - kChunkHeader) {
            if (at >= told) break;
            failFile(file.path,
                     "malformed glTF: the chunk at byte " + std::to_string(at) + " has " +
                         std::to_string(size) + " bytes, expected at most the " +
                         std::to_string(all.size() - at - kChunkHeader) + " that the file has");
        }
        at += kChunkHeader;
        if (type == kJson && text.empty()) text = all.substr(at, size);
        if (type == kBinary && !file.binary) file.binary = all.substr(at, size);
        at += size;
    }
    if (text.empty()) failFile(file.path, "malformed glTF: expected a chunk of JSON");
    return text;
}

/// Refuses a file that says to be for readers of another version.
void requireSecond(const GltfFile& file) {
    const auto none = file.json.end();
    const auto asset = file.json.is_object() ? file.json.find("asset") : none;
    if (asset == none || !asset->is_object())
        failFile(file.path, "no glTF 2 file: expected an object \"asset\"");
    for (const char* key : {"version", "minVersion"}) {
        const auto found = asset->find(key);
        const bool isThere = found != asset->end();
        if (!isThere && std::string_view(key) == "minVersion") continue;
        const std::string told = isThere && found->is_string() ? found->get<std::string>() : "";
        if (told.rfind('2', 0) != 0)
            failFile(file.path, std::string("no glTF 2 file: asset.") + key + " is " +
                                    inQuotes(told) + ", expected \"2.0\"");
    }
}

} // namespace

GltfFile GltfFile::read(const std::string& path, const ReadLimits& limits) {
    GltfFile file;
    file.path = path;
    file.limits = limits;
    std::string all = readText(path, limits);
    file.size = all.size();
    if (all.compare(0, 4, "glTF") == 0) {
        if (all.size() < kHeader)
            failFile(path, "malformed glTF: " + std::to_string(all.size()) +
                               " bytes, expected a header of " + std::to_string(kHeader));
        if (numberAt(all, 4) != 2)
            failFile(path, "no glTF 2 file: a binary one of version " +
                               std::to_string(numberAt(all, 4)) + ", expected 2");
        all = readChunks(all, file);
    }
    file.json = parseGltf(path, std::move(all));
    requireSecond(file);
    return file;
}

std::size_t GltfFile::addBuffer(std::string bytes) {
    nlohmann::json& list = json["buffers"];
    list.push_back({{"byteLength", bytes.size()}});
    buffers.add(std::make_shared<const std::string>(std::move(bytes)));
    return list.size() - 1;
}

std::string GltfFile::bytes() {
    const GltfBuffers::Layout layout = buffers.layout();
    if (json.contains("bufferViews"))
        for (nlohmann::json& view : json.at("bufferViews")) {
            const auto buffer = view.at("buffer").get<std::size_t>();
            view["byteOffset"] = view.value("byteOffset", std::size_t(0)) + layout.begins[buffer];
            view["buffer"] = 0;
        }
    if (buffers.count() > 0)
        json["buffers"] = nlohmann::json::array({{{"byteLength", layout.size}}});
    std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t chunk = layout.size > 0 ? kChunkHeader + layout.size : 0;
    const std::size_t all = kHeader + kChunkHeader + text.size() + chunk;
    if (all > std::numeric_limits<std::uint32_t>::max())
        failFile(path, std::to_string(all) + " bytes with its buffers, expected less than 4 GB");
    std::string result = "glTF";
    result.reserve(all);
    addNumber(result, 2);
    addNumber(result, all);
    addNumber(result, text.size());
    result += kJson;
    result += text;
    if (chunk == 0) return result;
    addNumber(result, layout.size);
    result += kBinary;
    buffers.append(result);
    return result;
}

std::string reasonOf(const nlohmann::json::exception& error) {
    const std::string text = error.what(); // "[json.exception.KIND.NUMBER] REASON"
    const std::size_t end = text.find("] ");
    return end == std::string::npos ? text : text.substr(end + 2);
}

} // namespace osgSkin
