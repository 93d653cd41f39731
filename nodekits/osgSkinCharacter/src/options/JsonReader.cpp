// SPDX-License-Identifier: MIT
#include "options/JsonReader.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>

#include <nlohmann/json.hpp>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

/// A member that an object of a JSON text has twice; the parser keeps the last one.
struct RepeatedKey {
    std::string key;      ///< as the text spells it, without quotes
    std::size_t byte = 0; ///< where the second one begins
};

/// Index of the byte behind a string's closing quote.
/// \param at index of the opening quote
std::size_t endOfString(const std::string& text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return at + 1;
}

/// The same for all spellings of a key: "\u0061" is "a".
std::string meaning(const std::string& quoted) {
    const bool isPlain = quoted.find('\\') == std::string::npos;
    return isPlain ? quoted : nlohmann::json::parse(quoted).dump();
}

/// The first repeated key of a valid JSON text.
std::optional<RepeatedKey> findRepeatedKey(const std::string& text) {
    std::vector<std::set<std::string>> open; // keys so far; none in lists
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '{' || c == '[') open.emplace_back();
        if ((c == '}' || c == ']') && !open.empty()) open.pop_back();
        if (c != '"') {
            ++i;
            continue;
        }
        const std::size_t end = endOfString(text, i), next = text.find_first_not_of(" \t\r\n", end);
        if (next != std::string::npos && text[next] == ':' && !open.empty() &&
            !open.back().insert(meaning(text.substr(i, end - i))).second)
            return RepeatedKey{text.substr(i + 1, end - i - 2), i};
        i = end;
    }
    return std::nullopt;
}

/// The position of a byte as "line 3, column 7", counted from 1.
std::string placeOf(const std::string& text, std::size_t byte) {
    const std::size_t end = std::min(byte, text.size());
    const auto at = text.begin() + static_cast<std::ptrdiff_t>(end);
    const auto line = 1 + std::count(text.begin(), at, '\n');
    const std::size_t start = text.substr(0, end).rfind('\n');
    const std::size_t column = end - (start == std::string::npos ? 0 : start + 1) + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Shortens a quoted name of any length to its beginning and end.
std::string shortened(const std::string& text) {
    constexpr std::size_t part = 300;
    if (text.size() <= 3 * part) return text;
    return text.substr(0, part) + "..." + text.substr(text.size() - part);
}

} // namespace

nlohmann::json JsonReader::parseFile(const std::string& file, const ReadLimits& limits) {
    const std::string text = readWholeFile(file, limits.textMegabytes, "maxTextMB");
    checkJsonDepth(file, text);
    // The parser takes a byte 0 for the text's end and ignores the rest.
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        throw Error(file + ": " + placeOf(text, zero) + ": malformed JSON");
    nlohmann::json json;
    try {
        json = nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        throw Error(file + ": " + placeOf(text, error.byte > 0 ? error.byte - 1 : 0) +
                    ": malformed JSON");
    } catch (const nlohmann::json::exception& error) {
        // A number beyond any double; the message ends with it, in quotes.
        const std::string what = error.what();
        const std::size_t end = what.rfind('\''), begin = what.rfind('\'', end - 1);
        const std::string number = end == std::string::npos || begin == std::string::npos
                                       ? ""
                                       : what.substr(begin + 1, end - begin - 1);
        throw Error(file + ": " + placeOf(text, text.find(number)) + ": " +
                    (number.size() > 40 ? number.substr(0, 40) + "..." : number) +
                    ", expected a finite number");
    }
    if (const auto repeated = findRepeatedKey(text))
        throw Error(onOneLine(file + ": " + placeOf(text, repeated->byte) + ": \"" +
                              repeated->key.substr(0, 40) +
                              "\" is there twice, expected each member once"));
    return json;
}

JsonReader::JsonReader(const nlohmann::json& value, std::string file, std::string path)
    : _value(value), _file(std::move(file)), _path(std::move(path)) {}

void JsonReader::failWith(const std::string& message) const {
    std::string text =
        _file + ": " + (_path.empty() ? "" : shortened(_path) + ": ") + shortened(message);
    for (char& c : text) // keys may contain terminal escape sequences
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    throw Error(text);
}

void JsonReader::failExpected(const std::string& expected) const {
    failWith("expected " + expected + ", found " + _value.type_name());
}

std::optional<JsonReader> JsonReader::find(const std::string& key) const {
    if (!_value.is_object()) failExpected("an object");
    const auto found = _value.find(key);
    if (found == _value.end()) return std::nullopt;
    return JsonReader(*found, _file, _path.empty() ? key : _path + "." + key);
}

JsonReader JsonReader::require(const std::string& key, const std::string& expected) const {
    if (auto member = find(key)) return *member;
    failWith("\"" + key + "\" is missing, expected " + expected);
}

std::string JsonReader::string() const {
    if (!_value.is_string()) failExpected("a string");
    return _value.get<std::string>();
}

double JsonReader::number() const {
    if (!_value.is_number()) failExpected("a number");
    const double number = _value.get<double>();
    if (!std::isfinite(number)) failExpected("a finite number");
    return number;
}

bool JsonReader::boolean() const {
    if (!_value.is_boolean()) failExpected("true or false");
    return _value.get<bool>();
}

std::size_t JsonReader::count() const {
    // JSON does not distinguish 1 from 1.0 and 1e0, which some programs write.
    if (_value.is_number()) {
        constexpr double kMax = 1e15; // all whole numbers below are doubles
        const double number = _value.get<double>();
        if (number >= 0.0 && number <= kMax && std::floor(number) == number)
            return static_cast<std::size_t>(number);
    }
    if (!_value.is_number_unsigned()) failExpected("a whole number, 0 or more");
    return _value.get<std::size_t>();
}

glm::dvec3 JsonReader::vector() const {
    if (!_value.is_array() || _value.size() != 3) failExpected("a list of three numbers");
    const std::vector<JsonReader> numbers = items();
    return {numbers[0].number(), numbers[1].number(), numbers[2].number()};
}

std::size_t JsonReader::size() const {
    if (!_value.is_array()) failExpected("a list");
    return _value.size();
}

std::vector<JsonReader> JsonReader::items() const {
    std::vector<JsonReader> result;
    forEachItem([&](const JsonReader& item) { result.push_back(item); });
    return result;
}

void JsonReader::forEachItem(const std::function<void(const JsonReader&)>& visit) const {
    if (!_value.is_array()) failExpected("a list");
    std::size_t i = 0;
    for (const nlohmann::json& item : _value)
        visit(JsonReader(item, _file, _path + "[" + std::to_string(i++) + "]"));
}

void JsonReader::forEachMember(
    const std::function<void(const std::string&, const JsonReader&)>& visit) const {
    if (!_value.is_object()) failExpected("an object");
    for (const auto& [key, member] : _value.items())
        visit(key, JsonReader(member, _file, _path.empty() ? key : _path + "." + key));
}

void JsonReader::warnUnknown(const std::vector<std::string>& known) const {
    constexpr std::size_t mostLines = 10;
    std::size_t unknown = 0;
    forEachMember([&](const std::string& key, const JsonReader& member) {
        if (std::find(known.begin(), known.end(), key) != known.end()) return;
        if (++unknown > mostLines) return;
        const std::string meant = nearestName(key, known);
        OSG_WARN << onOneLine(_file + ": " + shortened(member._path) + ": unknown member ignored" +
                              (meant.empty() ? expectedNames(key, known)
                                             : "; did you mean \"" + meant + "\"?"))
                 << std::endl;
    });
    if (unknown > mostLines)
        OSG_WARN << onOneLine(_file + ": " + std::to_string(unknown - mostLines) +
                              " more unknown members ignored")
                 << std::endl;
}

} // namespace osgSkin
