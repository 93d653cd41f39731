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
#include <vector>

namespace osgSkin {
namespace {

/// An attribute's value in an XML file, to read or to replace.
struct XmlValue {
    std::size_t begin = 0, size = 0;
};

/// Finds an attribute of the element whose start tag begins at `tag`.
std::optional<XmlValue> findAttribute(std::string_view xml, std::size_t tag,
                                      std::string_view name) {
    const std::string_view start = xml.substr(0, xml.find_first_of("<>", tag + 1));
    for (auto at = start.find(name, tag); at != start.npos; at = start.find(name, at + 1)) {
        const std::size_t sign = start.find_first_not_of(" \t\r\n", at + name.size());
        if (sign == start.npos || start[sign] != '=' ||
            std::isspace(static_cast<unsigned char>(start[at - 1])) == 0)
            continue;
        const std::size_t quote = start.find_first_not_of(" \t\r\n", sign + 1);
        if (quote == start.npos || (start[quote] != '"' && start[quote] != '\'')) continue;
        const std::size_t close = start.find(start[quote], quote + 1);
        if (close != start.npos) return XmlValue{quote + 1, close - quote - 1};
    }
    return std::nullopt;
}

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
                _known['#' + std::string(textOf(*id))] = {{tag, end + kClose.size()},
                                                          *source,
                                                          inside == skin,
                                                          false,
                                                          std::string(textOf(*source))};
        }
    }

    /// Removes morphs, so that their meshes stay as they rest: a skin of a morph becomes one of
    /// the morph's own mesh, and where a morph is shown, its skin or mesh is.
    /// \param[out] result the file's new text, if there are morphs
    /// \return the number of morphs
    /// \throw osgSkin::Error if controllers refer to each other
    std::size_t removeMorphs(std::string& result) {
        std::map<std::size_t, std::pair<std::size_t, std::string>> edits; // by place; size, text
        std::size_t morphs = 0;
        for (auto& [id, controller] : _known) {
            std::string mesh = follow(std::string(textOf(controller.source)));
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
                edits[url->begin] = {url->size, follow(std::string(textOf(*url)))};
        std::size_t copied = 0;
        for (const auto& [at, edit] : edits) {
            if (at < copied) continue; // within what is removed
            result.append(_xml.substr(copied, at - copied)).append(edit.second);
            copied = at + edit.first;
        }
        result.append(_xml.substr(copied));
        return morphs;
    }

private:
    struct Controller {
        XmlValue whole, source;
        bool isSkin = false;
        bool isFollowed = false;
        std::string target; ///< of its morphs, where it is followed
    };

    std::string_view textOf(const XmlValue& value) const {
        return _xml.substr(value.begin, value.size);
    }

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

/// Whether an array of times has keys so far apart that it matters what is between them.
bool isSparse(std::string_view numbers) {
    constexpr double kDense = 1.0 / 23.0; // seconds
    std::optional<double> last;
    for (std::size_t at = 0; (at = numbers.find_first_not_of(" \t\r\n", at)) != numbers.npos;) {
        const std::size_t end = std::min(numbers.find_first_of(" \t\r\n", at), numbers.size());
        double time = 0.0;
        if (!parseNumber(numbers.substr(at, end - at), time)) return false;
        if (last && time - *last > kDense) return true;
        last = time;
        at = end;
    }
    return false;
}

/// Reports what Assimp does not read of a Collada file's animations.
void warnCurves(const std::string& path, std::string_view xml) {
    constexpr std::string_view kSource = "<source", kInput = "<input", kArray = "<float_array";
    constexpr std::size_t kNear = 1000; ///< characters from a source to its array
    std::map<std::string_view, std::size_t> sources;
    const auto textOf = [&](std::size_t tag, const char* name) {
        const auto value = findAttribute(xml, tag, name);
        return value ? xml.substr(value->begin, value->size) : std::string_view();
    };
    for (auto tag = xml.find(kSource); tag != xml.npos; tag = xml.find(kSource, tag + 1))
        sources.emplace(textOf(tag, "id"), tag);
    bool isAnySparse = false;
    for (auto tag = xml.find(kInput); tag != xml.npos && !isAnySparse;
         tag = xml.find(kInput, tag + 1)) {
        const std::string_view source = textOf(tag, "source");
        if (textOf(tag, "semantic") != "INPUT" || source.empty()) continue;
        const auto times = sources.find(source.substr(1));
        if (times == sources.end()) continue;
        const std::size_t array = xml.substr(times->second, kNear).find(kArray);
        const std::size_t begin =
            array == xml.npos ? array : xml.find('>', times->second + array) + 1;
        if (begin < xml.size())
            isAnySparse = isSparse(xml.substr(begin, xml.find('<', begin) - begin));
        sources.erase(times); // is looked at once
    }
    if (!isAnySparse) return;
    const auto has = [xml](const char* part) { return xml.find(part) != xml.npos; };
    if (has("BEZIER") || has("HERMITE") || has("CARDINAL") || has("BSPLINE"))
        warn(path, "curves with tangents are read as straight lines between their keys: export a "
                   "key for each frame");
    if (has(".ANGLE"))
        warn(path, "turns about several axes are read as the shortest rotations between their "
                   "keys: export a key for each frame");
}

/// Gives Assimp a file's bytes from memory, and the files beside it from disk.
class EditedFile : public Assimp::IOSystem {
public:
    EditedFile(std::string path, std::string bytes)
        : _path(std::move(path)), _bytes(std::move(bytes)) {}

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

std::string editFile(const std::string& path, const ReadLimits& limits,
                     Assimp::Importer& importer) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension != "fbx" && extension != "dae") return {};
    std::string bytes = readText(path, limits), fbx, edited;
    if (extension == "fbx") {
        renamePropertyConnections(bytes);
        fbx = bytes;
    } else {
        checkDepth(path, bytes, limits);
        warnCurves(path, bytes);
        if (bytes.find("<authoring_tool>Assimp") != std::string::npos)
            warn(path, "written by Assimp, which loses keys of animations or writes their times in "
                       "milliseconds");
        if (const std::size_t morphs = Controllers(path, bytes).removeMorphs(edited)) {
            warn(path, std::to_string(morphs) + " morph controllers are not supported; ignored");
            bytes = std::move(edited);
        }
    }
    importer.SetIOHandler(new EditedFile(path, std::move(bytes)));
    return fbx;
}

} // namespace osgSkin
