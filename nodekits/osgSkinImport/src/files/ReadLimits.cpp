// SPDX-License-Identifier: MIT
#include <osgSkinImport/ReadLimits>

#include "files/FileText.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>

namespace osgSkin {
namespace {

std::size_t countOf(const std::string& key, const std::string& value) {
    std::size_t count = 0;
    const char* const end = value.data() + value.size();
    const auto [stop, status] = std::from_chars(value.data(), end, count);
    // Limits up to this can be added without overflow.
    if (value.empty() || status != std::errc() || stop != end || count == 0 || count >> 40 != 0)
        throw Error("option " + key + "=" + value + ": expected a whole number from 1 to 2^40");
    return count;
}

std::vector<std::string> listOf(const std::string& key, const std::string& value) {
    std::vector<std::string> result;
    std::istringstream list(value);
    for (std::string name; std::getline(list, name, ',');)
        if (!name.empty()) result.push_back(name);
    if (result.empty()) throw Error("option " + key + ": expected names with commas between them");
    return result;
}

/// The maximum nesting of lists and objects in a JSON text; a `.skin` file has 4 levels, VRM 10.
constexpr std::size_t kMaxJsonDepth = 64;

bool isIn(const std::vector<std::string>& formats, const std::string& extension) {
    return std::any_of(formats.begin(), formats.end(), [&](const std::string& format) {
        return format == extension || format == "all";
    });
}

} // namespace

std::vector<std::pair<std::string, std::string>> optionValues(const std::string& text) {
    const char* const blank = " \t\r\n";
    std::vector<std::pair<std::string, std::string>> words;
    std::size_t at = 0;
    while ((at = text.find_first_not_of(blank, at)) != std::string::npos) {
        const std::size_t stop = std::min(text.find_first_of(" \t\r\n=", at), text.size());
        const std::string key = text.substr(at, stop - at);
        std::string value;
        at = stop;
        if (stop < text.size() && text[stop] == '=') {
            const bool isQuoted = stop + 1 < text.size() && text[stop + 1] == '"';
            const std::size_t first = stop + (isQuoted ? 2 : 1);
            const std::size_t end =
                std::min(text.find_first_of(isQuoted ? "\"" : blank, first), text.size());
            value = text.substr(first, end - first);
            at = std::min(end + (isQuoted ? 1 : 0), text.size());
        }
        words.emplace_back(key, value);
    }
    return words;
}

ReadLimits ReadLimits::of(const osgDB::Options* options) {
    ReadLimits limits;
    if (options == nullptr) return limits;
    const std::pair<const char*, std::size_t*> counts[] = {
        {"maxFileMB", &limits.fileMegabytes}, {"maxTextMB", &limits.textMegabytes},
        {"maxJoints", &limits.joints},        {"maxDepth", &limits.depth},
        {"maxSamples", &limits.samples},      {"maxUses", &limits.uses},
        {"maxRatios", &limits.ratios},        {"maxInfluences", &limits.influences},
        {"maxPixels", &limits.pixels}};
    for (const auto& [key, value] : optionValues(options->getOptionString())) {
        for (const auto& [name, count] : counts)
            if (key == name) *count = countOf(key, value);
        if (key == "formats") limits.formats = listOf(key, osgDB::convertToLowerCase(value));
        if (key == "colours") {
            if (value != "material" && value != "merged")
                throw Error("option colours=" + value + ": expected material or merged");
            limits.mergesColours = value == "merged";
        }
        if (key == "images") limits.images = listOf(key, osgDB::convertToLowerCase(value));
    }
    return limits;
}

void ReadLimits::checkFormat(const std::string& path) const {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (formats.empty() || isIn(formats, extension)) return;
    std::string allowed;
    for (const std::string& format : formats) allowed += (allowed.empty() ? "" : ", ") + format;
    failFile(path, "the format " + inQuotes(extension) + " is not allowed, expected one of " +
                       allowed + " (option formats)");
}

void ReadLimits::checkNamedFormat(const std::string& path) const {
    const std::string format = osgSceneFormat(path);
    if (!format.empty() && !isIn(formats, format))
        failFile(path, "OpenSceneGraph's own reader, which reads this scene, is for trusted files; "
                       "to trust it, name its format in the option formats (-O \"formats=skin," +
                           format + ",...\", or formats=all)");
}

std::string readWholeFile(const std::string& path, std::size_t maxMegabytes, const char* raisedBy) {
    std::size_t size = 0;
    std::ifstream stream = openFile(path, maxMegabytes, raisedBy, size);
    std::string text(size, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(stream.gcount()) != size)
        failFile(path, "cannot be read to its end");
    return text;
}

void checkJsonDepth(const std::string& path, std::string_view text) {
    std::size_t depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') inString = !inString;
        if (inString && c == '\\') ++i; // the next character is escaped
        if (inString) continue;
        if ((c == '[' || c == '{') && ++depth > kMaxJsonDepth)
            failFile(path, "lists and objects are nested more than " +
                               std::to_string(kMaxJsonDepth) + " deep");
        if ((c == ']' || c == '}') && depth > 0) --depth;
    }
}

} // namespace osgSkin
