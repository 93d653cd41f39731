// SPDX-License-Identifier: MIT
#include "gltf/LoadBuffers.h"

#include "gltf/Uri.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

namespace osgSkin {
namespace {

using nlohmann::json;

class BufferLoader {
public:
    explicit BufferLoader(GltfFile& file) : _file(file) {}

    void run() {
        const auto list = _file.json.find("buffers");
        if (list == _file.json.end()) return;
        if (!list->is_array()) fail("buffers", "a list");
        for (const json& buffer : *list) {
            const std::string where = "buffers[" + std::to_string(_file.buffers.count()) + "]";
            if (!buffer.is_object()) fail(where, "an object");
            _file.buffers.add(contentOf(buffer, where));
        }
        _file.binary.reset();
    }

private:
    [[noreturn]] void fail(const std::string& where, const std::string& expected) const {
        failFile(_file.path, "malformed glTF: " + where + ": expected " + expected);
    }

    GltfBuffers::Content contentOf(const json& buffer, const std::string& where) {
        const auto uri = buffer.find("uri");
        if (uri == buffer.end()) return _file.buffers.count() == 0 ? ownChunk(buffer) : nullptr;
        if (!uri->is_string()) fail(where + ".uri", "a string");
        const std::string& name = uri->get_ref<const std::string&>();
        if (!isDataUri(name)) return otherFile(name, where);
        try {
            return std::make_shared<const std::string>(dataOfUri(name));
        } catch (const Error& error) {
            failFile(_file.path, "malformed glTF: " + where + ".uri: " + error.what());
        }
    }

    /// The chunk may be padded.
    GltfBuffers::Content ownChunk(const json& buffer) {
        if (!_file.binary) return nullptr;
        const auto length = buffer.find("byteLength");
        std::size_t size = 0;
        if (length != buffer.end())
            size = length->is_number_unsigned() ? length->get<std::size_t>() : ~std::size_t(0);
        _file.binary->resize(std::min(_file.binary->size(), size));
        return std::make_shared<const std::string>(*std::move(_file.binary));
    }

    GltfBuffers::Content otherFile(const std::string& uri, const std::string& where) {
        if (osgDB::containsServerAddress(uri)) fail(where + ".uri", "a file");
        const std::string path =
            osgDB::concatPaths(osgDB::getFilePath(_file.path), decodedUri(uri));
        std::error_code ignored; // what is not there is told when it is read
        const std::string whole = std::filesystem::canonical(path, ignored).string();
        GltfBuffers::Content& content = _known[ignored ? path : whole];
        if (content == nullptr) {
            try {
                content = std::make_shared<const std::string>(readText(path, _file.limits));
            } catch (const Error& error) {
                failFile(_file.path, where + ": " + error.what());
            }
            _file.beside += content->size();
        }
        // Each counts, as often as it is named.
        _named += content->size();
        if ((_file.size + _named) >> 20 >= _file.limits.fileMegabytes)
            fail("buffers", "less than " + std::to_string(_file.limits.fileMegabytes) +
                                " MB in all (option maxFileMB)");
        return content;
    }

    GltfFile& _file;
    std::map<std::string, GltfBuffers::Content> _known; ///< other files, however they are spelled
    std::size_t _named = 0;                             ///< bytes of other files
};

} // namespace

void loadBuffers(GltfFile& file) {
    BufferLoader(file).run();
}

} // namespace osgSkin
