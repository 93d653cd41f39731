// SPDX-License-Identifier: MIT
#include "assimp/EditedFile.h"

#include "assimp/ColladaCurves.h"
#include "assimp/FbxDocument.h"
#include "assimp/XmlText.h"
#include "files/FileText.h"

#include <osgDB/FileNameUtils>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// Collada's controllers, of which Assimp's reader fails on morphs.
class Controllers {
public:
    Controllers(const std::string& path, std::string_view xml) : _path(path), _xml(xml) {
        constexpr std::string_view kOpen = "<controller", kClose = "</controller>";
        std::size_t next = xml.find(kOpen);
        for (std::size_t tag = next; tag != xml.npos; tag = next) {
            next = xml.find(kOpen, tag + 1);
            std::string_view element = xml.substr(tag, next - tag);
            const std::size_t end = element.find(kClose);
            element = element.substr(0, end);
            const std::size_t skin = element.find("<skin"),
                              inside = std::min(skin, element.find("<morph"));
            if (end == element.npos || inside == element.npos) continue;
            const auto id = findAttribute(xml, tag, "id");
            const auto source = findAttribute(xml, tag + inside, "source");
            if (id && source)
                _known['#' + std::string(id->of(_xml))] = {{tag, end + kClose.size()},
                                                           *source,
                                                           inside == skin,
                                                           false,
                                                           std::string(source->of(_xml))};
        }
    }

    /// Removes morphs, so that their meshes stay as they rest: a skin of a morph becomes one of
    /// the morph's own mesh, and where a morph is shown, its skin or mesh is.
    /// \param[in,out] all of the file
    /// \return the number of morphs
    /// \throw osgSkin::Error if controllers refer to each other
    std::size_t removeMorphs(TextEdits& all) {
        TextEdits edits;
        std::size_t morphs = 0;
        for (auto& [id, controller] : _known) {
            std::string mesh = follow(std::string(controller.source.of(_xml)));
            if (_known.count(mesh) != 0 && controller.isSkin) // Assimp would not return
                failFile(_path, "controller " + inQuotes(id) + " is a skin of controller " +
                                    inQuotes(mesh) + ", expected one of a mesh");
            if (controller.isSkin)
                edits[controller.source.begin] = {controller.source.size, std::move(mesh)};
            else
                edits[controller.whole.begin] = {controller.whole.size, std::string()};
            morphs += !controller.isSkin;
        }
        if (morphs == 0) return 0;
        constexpr std::string_view kInstance = "<instance_controller";
        for (auto tag = _xml.find(kInstance); tag != _xml.npos; tag = _xml.find(kInstance, tag + 1))
            if (const auto url = findAttribute(_xml, tag, "url"))
                edits[url->begin] = {url->size, follow(std::string(url->of(_xml)))};
        all.merge(edits);
        return morphs;
    }

private:
    struct Controller {
        XmlValue whole, source;
        bool isSkin = false;
        bool isFollowed = false;
        std::string target; ///< of its morphs, where it is followed
    };

    /// The controller or geometry at the end of a chain of morphs.
    std::string follow(std::string url) {
        std::vector<Controller*> passed;
        for (auto at = _known.find(url); at != _known.end() && !at->second.isSkin;
             at = _known.find(url)) {
            url = at->second.target;
            if (std::exchange(at->second.isFollowed, true)) break;
            passed.push_back(&at->second);
        }
        for (Controller* const morph : passed) morph->target = url;
        return url;
    }

    const std::string& _path;
    const std::string_view _xml;
    std::map<std::string, Controller> _known; ///< by "#id"
};

/// Refuses depths at which Assimp exhausts the stack.
void checkDepth(const std::string& path, std::string_view xml, const ReadLimits& limits) {
    const std::size_t most = limits.depth + 64; // of nodes, and of what is above and in them
    std::size_t depth = 0, end = 0;             // end of a tag
    for (auto at = xml.find('<'); at < xml.size(); at = xml.find('<', end)) {
        end = at + 1;
        if (xml.compare(at, 4, "<!--") == 0) end = xml.find("-->", end);
        if (xml.compare(at, 9, "<![CDATA[") == 0) end = xml.find("]]>", end);
        for (end = xml.find_first_of("<>\"'", end); end < xml.size() && xml[end] != '<';
             end = xml.find_first_of("<>\"'", end + 1)) {
            if (xml[end] == '>') break;
            end = xml.find(xml[end], end + 1); // of a quoted value
        }
        if (end == xml.npos) return; // Assimp refuses it
        const char next = xml[at + 1];
        if (next == '/') depth -= depth > 0;
        if (next == '/' || next == '!' || next == '?' || xml[end - 1] == '/') continue;
        if (++depth > most)
            failFile(path, "elements are nested more than " + std::to_string(most) +
                               " deep (option maxDepth)");
    }
}

/// Gives Assimp a file's bytes from memory, and the files beside it from disk.
class EditedFile : public Assimp::IOSystem {
public:
    EditedFile(std::string path, std::string bytes)
        : _path(std::move(path)), _bytes(std::move(bytes)) {}

    const std::string& bytes() const { return _bytes; }
    bool Exists(const char* file) const override { return _disk.Exists(file); }
    char getOsSeparator() const override { return _disk.getOsSeparator(); }
    void Close(Assimp::IOStream* stream) override { _disk.Close(stream); }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (file != _path) return _disk.Open(file, mode);
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(_bytes.data()),
                                          _bytes.size());
    }

private:
    const std::string _path, _bytes;
    Assimp::DefaultIOSystem _disk; // a final class since Assimp 6
};

} // namespace

const std::string& editFile(const std::string& path, const ReadLimits& limits,
                            Assimp::Importer& importer) {
    static const std::string none;
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension != "fbx" && extension != "dae") return none;
    std::string bytes = readText(path, limits);
    if (extension == "fbx") {
        renamePropertyConnections(bytes);
    } else {
        checkDepth(path, bytes, limits);
        TextEdits edits = sampleCurves(path, bytes, limits);
        if (bytes.find("<authoring_tool>Assimp") != std::string::npos)
            warn(path, "written by Assimp, which loses keys of animations or writes their times in "
                       "milliseconds");
        if (const std::size_t morphs = Controllers(path, bytes).removeMorphs(edits))
            warn(path, std::to_string(morphs) + " morph controllers are not supported; ignored");
        if (!edits.empty()) applyEdits(edits, bytes);
    }
    auto* const file = new EditedFile(path, std::move(bytes));
    importer.SetIOHandler(file); // which owns it
    return extension == "fbx" ? file->bytes() : none;
}

} // namespace osgSkin
