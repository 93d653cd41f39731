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

/// A glTF 2 file in memory, text or binary (.gltf, .glb, .vrm, .vrma): its JSON, its buffers, and
/// how much more data it may declare.
///
/// Members throw osgSkin::Error with the file and the position in it; accessing the JSON throws
/// nlohmann::json::exception if a member is missing or has another type.
class GltfFile {
public:
    /// Reads a file and all of its buffers, each external file once.
    static GltfFile read(const std::string& path, const ReadLimits& limits);

    std::string path; ///< other files are named relative to its folder
    ReadLimits limits;
    nlohmann::json json;
    /// [buffer]; null if it has no content, such as a fallback buffer for compressed data.
    std::vector<std::shared_ptr<const std::string>> buffers;

    std::size_t diskBytes = 0; ///< of the file itself
    std::size_t ownBytes = 0;  ///< the same, and part of the decompressed size (unpackMeshopt())
    std::size_t allBytes() const { return ownBytes + _besideBytes; } ///< and of other files

    /// Adds a buffer; returns its index.
    std::size_t addBuffer(std::string bytes);

    /// Throws osgSkin::Error "FILE: malformed glTF: WHERE: expected EXPECTED".
    [[noreturn]] void fail(const std::string& where, const std::string& expected) const;

    /// The number of entries in a list of the file; 0 if there is no such list.
    std::size_t size(const char* list) const;

    /// Calls `visit` with each entry of a list and its path, such as "nodes[3]".
    void forEach(
        const char* list,
        const std::function<void(const nlohmann::json&, const std::string& where)>& visit) const;

    /// Reads an integer below `size`.
    std::size_t index(const nlohmann::json& value, std::size_t size,
                      const std::string& where) const;
    /// Reads the index of an entry in `list`.
    std::size_t indexOf(const nlohmann::json& value, const char* list,
                        const std::string& where) const;

    /// Reads a list of `count` finite numbers; empty if there is none.
    std::vector<double> numbers(const nlohmann::json& from, const char* key, std::size_t count,
                                const std::string& where) const;
    /// Reads a finite number; `otherwise` if there is none.
    double number(const nlohmann::json& from, const char* key, double otherwise,
                  const std::string& where) const;
    /// Reads the weights of morph targets; empty if there are none.
    std::vector<double> weights(const nlohmann::json& from, const std::string& where) const;

    // The amount of data is limited in proportion to the file's size (option maxSamples).

    /// Counts elements of about 64 bytes against the limit; throws if it is exceeded.
    void take(std::size_t elements, const std::string& where);
    /// Counts objects with a name or a list, which take some kilobytes each.
    void addEntries(std::size_t entries) { _entries += entries; }
    /// Throws if there are too many of them for the file's size, including the entries of lists.
    void checkEntries() const;

private:
    std::string readChunks(std::string_view all, std::string& binary, bool& hasBinary);
    void requireSecond() const;

    friend class BufferLoader;
    std::size_t _besideBytes = 0; ///< of other files with buffers
    std::size_t _elements = 0;    ///< counted by take()
    std::size_t _entries = 0;
};

/// An object's name, truncated to 500 bytes; empty if it has none.
std::string nameOf(const nlohmann::json& object);

/// The JSON library's error message, without its code.
std::string reasonOf(const nlohmann::json::exception& error);

/// Decodes a URI's percent escapes ("%20" for a space).
std::string decodedUri(std::string_view uri);

/// Whether a URI is a data URI: "data:application/octet-stream;base64,AAAA".
bool isDataUri(std::string_view uri);

/// The bytes of a data URI, in base64 or percent-encoded ("%2B").
/// \throw osgSkin::Error with the reason only, if it is not a data URI
std::string dataOfUri(std::string_view uri);

/// Decodes buffer views compressed by meshopt (EXT_meshopt_compression, and as much of
/// KHR_meshopt_compression as the library supports), and removes the extension from them. If the
/// file also contains a view's bytes uncompressed, only the extension is removed.
///
/// \param file whose buffers, views and size are changed
/// \throw osgSkin::Error with the file and the view, if the compressed data is malformed or would
///        exceed the limits, or with the compression's name if this build is without meshoptimizer
void unpackMeshopt(GltfFile& file);

} // namespace osgSkin

#endif
