// SPDX-License-Identifier: MIT
#include <osgSkinImport/ReadLimits>

#include "text/FileText.h"

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
    // Below this no sum of limits overflows.
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

} // namespace

ReadLimits ReadLimits::of(const osgDB::Options* options) {
    ReadLimits limits;
    if (options == nullptr) return limits;
    const std::pair<const char*, std::size_t*> counts[] = {
        {"maxFileMB", &limits.fileMegabytes}, {"maxTextMB", &limits.textMegabytes},
        {"maxJoints", &limits.joints},        {"maxDepth", &limits.depth},
        {"maxSamples", &limits.samples},      {"maxUses", &limits.uses}};
    std::istringstream words(options->getOptionString());
    for (std::string word; words >> word;) {
        const std::size_t sign = word.find('=');
        if (sign == std::string::npos) continue;
        const std::string key = word.substr(0, sign), value = word.substr(sign + 1);
        for (const auto& [name, count] : counts)
            if (key == name) *count = countOf(key, value);
        if (key == "formats") limits.formats = listOf(key, osgDB::convertToLowerCase(value));
        if (key == "classes") limits.classes = listOf(key, value);
    }
    return limits;
}

void ReadLimits::checkFormat(const std::string& path) const {
    if (formats.empty()) return;
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (std::find(formats.begin(), formats.end(), extension) != formats.end()) return;
    std::string allowed;
    for (const std::string& format : formats) allowed += (allowed.empty() ? "" : ", ") + format;
    failFile(path, "the format " + inQuotes(extension) + " is not allowed, expected one of " +
                       allowed + " (option formats)");
}

std::string readWholeFile(const std::string& path, std::size_t mostMegabytes,
                          const char* raisedBy) {
    std::size_t size = 0;
    std::ifstream stream = openFile(path, mostMegabytes, raisedBy, size);
    std::string text(size, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(stream.gcount()) != size)
        failFile(path, "cannot be read to its end");
    return text;
}

} // namespace osgSkin
