// SPDX-License-Identifier: MIT
#include "gltf/text/GltfJson.h"

#include "text/FileText.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

/// Goes through a text before anything of it is kept.
class TextCheck : public nlohmann::json_sax<json> {
public:
    TextCheck(const std::string& path, const std::string& text) : _path(path), _text(text) {}

    bool null() override { return took(); }
    bool boolean(bool) override { return took(); }
    bool number_integer(number_integer_t) override { return took(); }
    bool number_unsigned(number_unsigned_t) override { return took(); }
    bool number_float(number_float_t, const string_t&) override { return took(); }
    bool string(string_t&) override { return took(); }
    bool binary(binary_t&) override { return took(); }
    bool start_object(std::size_t) override { return open(false); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        Level& here = _open.back();
        here.key = name;
        if (here.known.insert(name).second) return true;
        failFile(_path,
                 "malformed glTF: " + place() + " is there twice, expected each member once");
    }

    bool parse_error(std::size_t byte, const std::string&, const json::exception& error) override {
        const std::size_t at = std::min(byte > 0 ? byte - 1 : 0, _text.size());
        const std::size_t line = std::size_t(std::count(_text.begin(), iterator(at), '\n'));
        const std::size_t before = at > 0 ? _text.rfind('\n', at - 1) : std::string::npos;
        const std::size_t column = before == std::string::npos ? at : at - before - 1;
        // 406: a number beyond any double.
        failFile(_path, "malformed glTF: line " + std::to_string(line + 1) + ", column " +
                            std::to_string(column + 1) +
                            (error.id == 406 ? ": expected a finite number" : ": expected JSON"));
    }

private:
    /// An object or list that is being read.
    struct Level {
        bool isList;
        std::size_t index = 0;       ///< of the entry that is being read
        std::string key;             ///< of the member
        std::set<std::string> known; ///< members so far
    };

    std::string::const_iterator iterator(std::size_t at) const {
        return _text.begin() + static_cast<std::ptrdiff_t>(at);
    }
    bool took() {
        if (!_open.empty()) ++_open.back().index;
        return true;
    }
    bool open(bool isList) {
        _open.push_back({isList, 0, {}, {}});
        return true;
    }
    bool close() {
        _open.pop_back();
        return took();
    }

    /// As "meshes[0].name".
    std::string place() const {
        std::string result;
        for (const Level& level : _open) {
            if (level.isList)
                result += "[" + std::to_string(level.index) + "]";
            else
                result += (result.empty() ? "" : ".") + level.key.substr(0, 40);
        }
        return result;
    }

    const std::string& _path;
    const std::string& _text;
    std::vector<Level> _open;
};

} // namespace

json parseGltf(const std::string& path, std::string text) {
    while (!text.empty() && text.back() == '\0') text.pop_back();
    // The parser takes a byte 0 for the text's end, and passes over what follows.
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        failFile(path, "malformed glTF: byte " + std::to_string(zero) +
                           " of its text is 0, expected JSON");
    checkJsonDepth(path, text);
    TextCheck check(path, text);
    json::sax_parse(text, &check);
    return json::parse(text);
}

} // namespace osgSkin
