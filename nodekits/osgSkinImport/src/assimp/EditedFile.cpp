// SPDX-License-Identifier: MIT
#include "assimp/EditedFile.h"

#include "assimp/FbxDocument.h"
#include "files/FileText.h"

#include <osgDB/FileNameUtils>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace osgSkin {
namespace {

/// An attribute's value in an XML file, to read or to replace.
struct XmlValue {
    std::size_t begin = 0, size = 0;
};

/// Finds an attribute of the element whose start tag begins at `tag`.
std::optional<XmlValue> findAttribute(const std::string& xml, std::size_t tag,
                                      const std::string& name) {
    const std::size_t end = std::min(xml.find('>', tag), xml.size());
    for (auto at = xml.find(name, tag); at < end; at = xml.find(name, at + 1)) {
        const std::size_t sign = xml.find_first_not_of(" \t\r\n", at + name.size());
        if (sign >= end || xml[sign] != '=' ||
            std::isspace(static_cast<unsigned char>(xml[at - 1])) == 0)
            continue;
        const std::size_t quote = xml.find_first_not_of(" \t\r\n", sign + 1);
        if (quote >= end || (xml[quote] != '"' && xml[quote] != '\'')) continue;
        const std::size_t close = xml.find(xml[quote], quote + 1);
        if (close < end) return XmlValue{quote + 1, close - quote - 1};
    }
    return std::nullopt;
}

/// Removes Collada's morph controllers, on which Assimp's reader fails, so that their meshes stay
/// as they rest: a skin of a morph becomes one of the morph's own mesh, and where a morph is shown,
/// its skin or mesh is.
///
/// \param path of the file, for errors
/// \param xml the file, which is changed
/// \return the number of morph controllers
/// \throw osgSkin::Error if controllers refer to each other
std::size_t removeMorphs(const std::string& path, std::string& xml) {
    struct Controller {
        XmlValue whole, source;
        bool isSkin = false;
    };
    static const std::string close = "</controller>";
    std::map<std::string, Controller> controllers; // by "#id"
    for (auto tag = xml.find("<controller"); tag != std::string::npos;
         tag = xml.find("<controller", tag + 1)) {
        const std::size_t end = xml.find(close, tag);
        if (end == std::string::npos) break;
        const auto element = std::string_view(xml).substr(tag, end - tag);
        const std::size_t skin = element.find("<skin"),
                          inside = std::min(skin, element.find("<morph"));
        if (inside == std::string_view::npos) continue;
        const auto id = findAttribute(xml, tag, "id");
        const auto source = findAttribute(xml, tag + inside, "source");
        if (id && source)
            controllers['#' + xml.substr(id->begin, id->size)] = {
                {tag, end + close.size() - tag}, *source, inside == skin};
    }
    const auto textOf = [&xml](const XmlValue& value) {
        return xml.substr(value.begin, value.size);
    };
    const auto follow = [&](std::string url) {
        for (std::size_t steps = 0; steps < controllers.size(); ++steps) {
            const auto found = controllers.find(url);
            if (found == controllers.end() || found->second.isSkin) break;
            url = textOf(found->second.source);
        }
        return url;
    };
    std::map<std::size_t, std::pair<std::size_t, std::string>> edits; // by position; size and text
    std::size_t morphs = 0;
    for (const auto& [id, controller] : controllers) {
        std::string mesh = follow(textOf(controller.source));
        if (controllers.count(mesh) != 0 && controller.isSkin) // Assimp would not return
            failFile(path, "controller " + inQuotes(id) + " is a skin of controller " +
                               inQuotes(mesh) + ", expected one of a mesh");
        if (controller.isSkin)
            edits[controller.source.begin] = {controller.source.size, std::move(mesh)};
        else
            edits[controller.whole.begin] = {controller.whole.size, std::string()};
        morphs += !controller.isSkin;
    }
    if (morphs == 0) return 0;
    for (auto tag = xml.find("<instance_controller"); tag != std::string::npos;
         tag = xml.find("<instance_controller", tag + 1))
        if (const auto url = findAttribute(xml, tag, "url"))
            edits[url->begin] = {url->size, follow(textOf(*url))};
    for (auto at = edits.rbegin(); at != edits.rend(); ++at) // from the file's end
        xml.replace(at->first, at->second.first, at->second.second);
    return morphs;
}

/// Gives Assimp a file's bytes from memory, and the files beside it from disk.
class EditedFile : public Assimp::DefaultIOSystem {
public:
    EditedFile(std::string path, std::string bytes)
        : _path(std::move(path)), _bytes(std::move(bytes)) {}

    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (file != _path) return Assimp::DefaultIOSystem::Open(file, mode);
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(_bytes.data()),
                                          _bytes.size());
    }

private:
    const std::string _path, _bytes;
};

} // namespace

std::string editFile(const std::string& path, const ReadLimits& limits,
                     Assimp::Importer& importer) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension != "fbx" && extension != "dae") return {};
    std::string bytes = readText(path, limits), fbx;
    if (extension == "fbx") {
        renamePropertyConnections(bytes);
        fbx = bytes;
    } else {
        if (bytes.find("<authoring_tool>Assimp") != std::string::npos)
            warn(path, "written by Assimp, which loses keys of animations or writes their times in "
                       "milliseconds");
        if (const std::size_t morphs = removeMorphs(path, bytes))
            warn(path, std::to_string(morphs) + " morph controllers are not supported; ignored");
    }
    importer.SetIOHandler(new EditedFile(path, std::move(bytes)));
    return fbx;
}

} // namespace osgSkin
