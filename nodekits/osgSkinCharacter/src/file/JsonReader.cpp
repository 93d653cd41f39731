// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/JsonReader.h"

#include <osg/Notify>
#include <osgSkin/Error>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace osgSkin {
namespace {

/// A character's description is a page of text and a body's weights a few megabytes; anything far
/// larger is neither.
constexpr std::streamoff kLargestFile = 16 << 20;

} // namespace

nlohmann::json JsonReader::parseFile(const std::string& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = in ? static_cast<std::streamoff>(in.tellg()) : -1;
    if (size < 0) throw Error(file + ": cannot be opened, expected a readable file");
    if (size > kLargestFile)
        throw Error(file + ": larger than 16 MiB, expected a character's description");
    in.seekg(0);
    std::string text(static_cast<std::size_t>(size), '\0');
    in.read(text.data(), size);
    if (in.gcount() != size) throw Error(file + ": cannot be read, expected a readable file");
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        const std::size_t end = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
        const auto at = text.begin() + static_cast<std::ptrdiff_t>(end);
        const auto line = 1 + std::count(text.begin(), at, '\n');
        const std::size_t start = text.substr(0, end).rfind('\n');
        const std::size_t column = end - (start == std::string::npos ? 0 : start + 1) + 1;
        throw Error(file + ": line " + std::to_string(line) + ", column " + std::to_string(column) +
                    ": malformed JSON");
    }
}

JsonReader::JsonReader(const nlohmann::json& value, std::string file, std::string path)
    : _value(value), _file(std::move(file)), _path(std::move(path)) {}

void JsonReader::failWith(const std::string& message) const {
    throw Error(_file + ": " + (_path.empty() ? "" : _path + ": ") + message);
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
    if (!_value.is_number_unsigned()) failExpected("a whole number, 0 or more");
    return _value.get<std::size_t>();
}

glm::dvec3 JsonReader::vector() const {
    if (!_value.is_array() || _value.size() != 3) failExpected("a list of three numbers");
    const std::vector<JsonReader> numbers = items();
    return {numbers[0].number(), numbers[1].number(), numbers[2].number()};
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

void JsonReader::warnUnknown(std::initializer_list<const char*> known) const {
    forEachMember([&](const std::string& key, const JsonReader& member) {
        if (std::find(known.begin(), known.end(), key) == known.end())
            OSG_WARN << _file << ": " << member._path << ": not known, passed over" << std::endl;
    });
}

} // namespace osgSkin
