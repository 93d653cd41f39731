// SPDX-License-Identifier: MIT
#include "gltf/GltfFile.h"

#include "files/FileText.h"

#ifdef OSGSKIN_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include <algorithm>
#include <cstddef>
#include <utility>

namespace osgSkin {
namespace {

using nlohmann::json;

/// All names of this compression, old and new.
constexpr const char* kNames[] = {"EXT_meshopt_compression", "KHR_meshopt_compression",
                                  "MESHOPT_compression"};

/// The extension that compresses a view; null if there is none.
const char* packedBy(const json& view) {
    if (!view.is_object() || !view.contains("extensions")) return nullptr;
    for (const char* name : kNames)
        if (view.at("extensions").contains(name)) return name;
    return nullptr;
}

/// A compressed view may name a fallback buffer with the same bytes uncompressed, which may be
/// absent.
bool hasContent(const GltfFile& file, const json& view) {
    const auto buffer = view.at("buffer").get<std::size_t>();
    return buffer < file.buffers.size() && file.buffers[buffer] != nullptr;
}

#ifdef OSGSKIN_HAS_MESHOPTIMIZER

/// The maximum compression ratio. Version 0 of the vertex codec uses two bits per group of 16
/// bytes; version 1, which newer library versions read, uses a quarter byte per block of 256.
constexpr std::size_t kMaxFromOne = MESHOPTIMIZER_VERSION < 230 ? 64 : 1024;

/// Decompressed bytes allowed per sample of the file's limit: 16 MB, and 16 times the file's size.
constexpr std::size_t kFairShare = 32;
constexpr std::size_t kMaxCounted = 4; ///< times a file's size that count as its own when decoded

/// The extension's parameters for a view. They are checked before decoding, because the decoders
/// only assert.
struct Packed {
    std::size_t buffer, offset, length, stride, count;
    std::string mode, filter;

    explicit Packed(const json& from)
        : buffer(from.at("buffer").get<std::size_t>()),
          offset(from.value("byteOffset", std::size_t(0))),
          length(from.at("byteLength").get<std::size_t>()),
          stride(from.at("byteStride").get<std::size_t>()),
          count(from.at("count").get<std::size_t>()), mode(from.at("mode").get<std::string>()),
          filter(from.value("filter", "NONE")) {}

    bool hasMode() const {
        return mode == "ATTRIBUTES" || mode == "TRIANGLES" || mode == "INDICES";
    }
    bool hasStride() const {
        if (mode != "ATTRIBUTES") return stride == 2 || stride == 4;
        return stride > 0 && stride <= 256 && stride % 4 == 0;
    }
    bool hasFilter() const {
        if (filter == "NONE") return true;
        if (mode != "ATTRIBUTES") return false;
        if (filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
        if (filter == "QUATERNION") return stride == 8;
        return filter == "EXPONENTIAL";
    }
    bool decode(const unsigned char* bytes, std::string& to) const {
        if (mode == "ATTRIBUTES")
            return meshopt_decodeVertexBuffer(to.data(), count, stride, bytes, length) == 0;
        if (mode == "TRIANGLES")
            return meshopt_decodeIndexBuffer(to.data(), count, stride, bytes, length) == 0;
        return meshopt_decodeIndexSequence(to.data(), count, stride, bytes, length) == 0;
    }
    void unfilter(std::string& bytes) const {
        if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
        if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
        if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    }
};

class Unpacker {
public:
    explicit Unpacker(GltfFile& file)
        : _file(file), _room(file.limits.fileMegabytes << 20),
          _fair(kFairShare * file.limits.samplesOf(file.allBytes())),
          _counted(kMaxCounted * file.allBytes()) {}

    /// \param view to decode in place
    /// \param name of the extension
    /// \param number of the view
    void unpackAt(json& view, const std::string& name, std::size_t number) {
        _where = "bufferViews[" + std::to_string(number) + "]." + name;
        try {
            unpack(view, name);
        } catch (const json::exception& error) { // missing member, or wrong type
            failFile(_file.path, "malformed glTF: " + _where + ": " + reasonOf(error));
        }
    }

private:
    void unpack(json& view, const std::string& name) {
        const Packed packed(view.at("extensions").at(name));
        if (!packed.hasMode()) fail("a mode ATTRIBUTES, TRIANGLES or INDICES");
        if (!packed.hasStride()) fail("a stride that its mode can have");
        if (!packed.hasFilter()) fail("a filter that is known, and fits the stride");
        if (packed.mode == "TRIANGLES" && packed.count % 3 != 0) fail("three indices a triangle");
        if (packed.buffer >= _file.buffers.size() || _file.buffers[packed.buffer] == nullptr)
            failFile(_file.path, "buffer " + std::to_string(packed.buffer) + " has no content");
        const std::string& from = *_file.buffers[packed.buffer];
        if (packed.offset > from.size() || packed.length > from.size() - packed.offset)
            fail("bytes within their buffer");
        if (packed.count > _room / packed.stride)
            fail("at most " + std::to_string(_file.limits.fileMegabytes) +
                 " MB unpacked in all (option maxFileMB)");
        if (packed.count * packed.stride > _fair)
            fail("no more unpacked in all than the file has room for (option maxSamples)");
        if (packed.count * packed.stride / kMaxFromOne > packed.length)
            fail("as many bytes as it says");
        std::string bytes(packed.count * packed.stride, '\0');
        const char* const begin = from.data() + packed.offset;
        if (!packed.decode(reinterpret_cast<const unsigned char*>(begin), bytes))
            fail("bytes that can be unpacked by this build's meshoptimizer (" +
                 std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." +
                 std::to_string(MESHOPTIMIZER_VERSION % 1000 / 10) + ")" +
                 (hasNewCodec(packed, begin)
                      ? "; its codec is newer, and read by meshoptimizer 1.0 and later: pack it "
                        "without (gltfpack -cc in place of -cz)"
                      : ""));
        packed.unfilter(bytes);
        replace(view, packed, std::move(bytes));
    }

    /// Whether vertices are packed by version 1 of their codec, which meshoptimizer 0.22 does not
    /// read.
    static bool hasNewCodec(const Packed& packed, const char* bytes) {
        constexpr unsigned char kVersion1 = 0xa1;
        return packed.mode == "ATTRIBUTES" && packed.length > 0 &&
               static_cast<unsigned char>(*bytes) == kVersion1;
    }

    void replace(json& view, const Packed& packed, std::string bytes) {
        const std::size_t length = bytes.size();
        _room -= length;
        _fair -= length;
        // The file's other limits are relative to its uncompressed size, up to the usual
        // compression ratio.
        const std::size_t counted = std::min(length, _counted);
        _counted -= counted;
        _file.ownBytes += counted;
        view = {{"buffer", _file.addBuffer(std::move(bytes))}, {"byteLength", length}};
        if (packed.mode == "ATTRIBUTES") view["byteStride"] = packed.stride;
    }

    [[noreturn]] void fail(const std::string& expected) const {
        failFile(_file.path, "malformed meshopt compression: " + _where + ": expected " + expected);
    }

    GltfFile& _file;
    std::size_t _room;    ///< bytes that may still be decompressed
    std::size_t _fair;    ///< the same, relative to the file's size
    std::size_t _counted; ///< bytes that may still count as the file's own
    std::string _where;
};

#else

class Unpacker {
public:
    explicit Unpacker(GltfFile& file) : _file(file) {}

    [[noreturn]] void unpackAt(json&, const std::string& name, std::size_t) {
        failFile(_file.path, "meshopt compression (" + name +
                                 ") is not read by this build; save the file without it");
    }

private:
    GltfFile& _file;
};

#endif

} // namespace

void unpackMeshopt(GltfFile& file) {
    if (!file.json.contains("bufferViews")) return;
    Unpacker unpacker(file);
    json& views = file.json.at("bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        const char* const name = packedBy(views[i]);
        if (name == nullptr) continue;
        if (hasContent(file, views[i]))
            views[i].erase("extensions");
        else
            unpacker.unpackAt(views[i], name, i);
    }
}

} // namespace osgSkin
