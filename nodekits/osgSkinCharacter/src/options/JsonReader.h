// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_OPTIONS_JSONREADER_H
#define OSGSKINCHARACTER_OPTIONS_JSONREADER_H

#include <osgSkin/GlmTypes>
#include <osgSkinImport/ReadLimits>

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// A JSON value with its file and its path in it, so that every error names both.
class JsonReader {
public:
    /// Parses the whole file.
    /// \throw Error where it cannot be read, is larger than allowed or is not JSON
    static nlohmann::json parseFile(const std::string& file, const ReadLimits& limits);

    JsonReader(const nlohmann::json& value, std::string file, std::string path = "");

    /// Throws Error "FILE: PATH: expected `expected`, found ...".
    [[noreturn]] void failExpected(const std::string& expected) const;
    /// Throws Error "FILE: PATH: `message`".
    [[noreturn]] void failWith(const std::string& message) const;

    /// The member `key` of an object; nothing where there is none.
    /// \throw Error where not an object
    std::optional<JsonReader> find(const std::string& key) const;
    /// The member `key`. Throws an Error that says what was expected where it is missing.
    JsonReader require(const std::string& key, const std::string& expected) const;

    bool isObject() const { return _value.is_object(); }
    bool isNumber() const { return _value.is_number(); }
    bool isString() const { return _value.is_string(); }
    std::string string() const;
    double number() const;
    bool boolean() const;
    glm::dvec3 vector() const; ///< of a list of three numbers
    std::size_t count() const; ///< a whole number, not negative

    bool isList() const { return _value.is_array(); }
    std::size_t size() const;              ///< of a list
    std::vector<JsonReader> items() const; ///< of a list
    void forEachItem(const std::function<void(const JsonReader&)>& visit) const;
    void
    forEachMember(const std::function<void(const std::string&, const JsonReader&)>& visit) const;

    /// Warns about members of an object that nobody will read, most often misspelt ones.
    void warnUnknown(const std::vector<std::string>& known) const;

private:
    const nlohmann::json& _value;
    std::string _file;
    std::string _path; ///< like motions[0].file
};

} // namespace osgSkin

#endif
