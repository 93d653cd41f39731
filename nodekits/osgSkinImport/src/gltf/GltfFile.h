// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTF_GLTFFILE_H
#define OSGSKINIMPORT_GLTF_GLTFFILE_H

#include <osgSkinImport/ReadLimits>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

/// A glTF 2 file in memory, text or binary (.gltf, .glb, .vrm): its JSON, what its buffers hold,
/// and how much of what it asks for is still allowed.
///
/// What its members throw are osgSkin::Error with the file and the place in it; lists and objects
/// of JSON throw nlohmann::json::exception where a member is missing or of another type.
class GltfFile {
public:
    /// Reads a file with all of its buffers, each file once.
    static GltfFile read(const std::string& path, const ReadLimits& limits);

    std::string path; ///< other files are named relative to its folder
    ReadLimits limits;
    nlohmann::json json;
    /// [buffer]; null where there is no content, as for what stands in for compressed data.
    std::vector<std::shared_ptr<const std::string>> buffers;

    std::size_t diskBytes = 0; ///< of the file itself
    std::size_t ownBytes = 0;  ///< the same, and a share of what was unpacked (unpackMeshopt())
    std::size_t allBytes() const { return ownBytes + _besideBytes; } ///< with other files

    /// Adds a buffer; returns its index.
    std::size_t addBuffer(std::string bytes);

    /// Throws osgSkin::Error "FILE: malformed glTF: WHERE: expected EXPECTED".
    [[noreturn]] void fail(const std::string& where, const std::string& expected) const;

    /// How many entries a list of the file has; none where it is not there.
    std::size_t size(const char* list) const;

    /// Calls `visit` with each entry of a list and its place, as "nodes[3]".
    void forEach(
        const char* list,
        const std::function<void(const nlohmann::json&, const std::string& where)>& visit) const;

    /// A whole number below `size`.
    std::size_t index(const nlohmann::json& value, std::size_t size,
                      const std::string& where) const;
    /// The index of an entry of a list.
    std::size_t indexOf(const nlohmann::json& value, const char* list,
                        const std::string& where) const;

    /// A list of so many finite numbers; an empty one where it is not there.
    std::vector<double> numbers(const nlohmann::json& from, const char* key, std::size_t count,
                                const std::string& where) const;
    /// One finite number, `otherwise` where it is not there.
    double number(const nlohmann::json& from, const char* key, double otherwise,
                  const std::string& where) const;
    /// The weights of morph targets; none where they are not there.
    std::vector<double> weights(const nlohmann::json& from, const std::string& where) const;

    // What a few hundred bytes may ask for is in proportion to the file's size (option maxSamples).

    /// Takes elements of about 64 bytes off what the file's size allows.
    void take(std::size_t elements, const std::string& where);
    /// Counts things with a name or a list: some kilobytes each.
    void addEntries(std::size_t entries) { _entries += entries; }
    /// Refuses more of them than the file's size allows: those added, and what lists are long of.
    void checkEntries() const;

private:
    std::string readChunks(std::string_view all, std::string& binary, bool& hasBinary);
    void requireSecond() const;

    friend class BufferLoader;
    std::size_t _besideBytes = 0; ///< of other files that buffers hold
    std::size_t _elements = 0;    ///< that were taken
    std::size_t _entries = 0;
};

/// A name, cut to 500 bytes; empty where there is none.
std::string nameOf(const nlohmann::json& object);

/// What the JSON library says of a member that is not there or of another kind, without its number.
std::string reasonOf(const nlohmann::json::exception& error);

/// A file's name as a URI has it, with "%20" for a space and the like, in plain characters.
std::string decodedUri(std::string_view uri);

/// Whether a URI holds what it stands for: "data:application/octet-stream;base64,AAAA".
bool isDataUri(std::string_view uri);

/// The bytes that a data URI holds, in base64 or as they stand, with "%2B" and the like.
/// \throw osgSkin::Error with the reason alone where it is none
std::string dataOfUri(std::string_view uri);

/// Unpacks buffer views that are compressed by meshopt (EXT_meshopt_compression, and what of
/// KHR_meshopt_compression the library at hand reads), so that no extension is left at them. Views
/// whose bytes the file holds unpacked, too, lose the extension alone.
///
/// \param file whose buffers, views and size are changed
/// \throw osgSkin::Error with the file and the view where what is compressed is malformed or would
///        be larger than the limits; and by the compression's name in a build without
///        meshoptimizer
void unpackMeshopt(GltfFile& file);

} // namespace osgSkin

#endif
