// SPDX-License-Identifier: MIT
#include "files/FileText.h"

#include <osgSkin/Error>
#include <osgSkinImport/FindNamedFile>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <sstream>
#include <system_error>

namespace osgSkin {

namespace {

template <typename Names>
bool has(const Names& names, const std::string& extension) {
    return std::find(std::begin(names), std::end(names), extension) != std::end(names);
}

bool isArchive(const std::string& name) {
    static const char* const archives[] = {"7z",     "bz2",  "gz",     "ivez", "osga",
                                           "osgtgz", "osgz", "osgxgz", "ozg",  "rar",
                                           "tar",    "tgz",  "xgz",    "xz",   "zip"};
    return has(archives, osgDB::getLowerCaseFileExtension(name));
}

/// Whether OSG would open an archive in the path to a file. Folders may have any name.
bool leadsThroughArchive(const std::string& path) {
    std::size_t first = 0;
    for (std::size_t end = 0; (end = path.find_first_of("/\\", first)) != std::string::npos;
         first = end + 1) {
        if (!isArchive(path.substr(first, end - first))) continue;
        std::error_code ignored;
        if (!std::filesystem::is_directory(path.substr(0, end), ignored)) return true;
    }
    return false;
}

/// Whether the extension is that of a scene that only OSG reads.
bool isOsgScene(const std::string& extension) {
    static const char* const scenes[] = {"ive", "osg", "osg2", "osgb", "osgt", "osgx"};
    return has(scenes, extension);
}

constexpr std::size_t kMegabyte = 1 << 20;

/// A path for messages, truncated if it is too long for a file name.
std::string shortened(const std::string& path) {
    constexpr std::size_t longest = 200;
    return path.size() > kMaxPath ? path.substr(0, longest) + "..." : path;
}

} // namespace

void requireName(const std::string& path) {
    if (path.size() > kMaxPath)
        failFile(path, "the file's name has " + std::to_string(path.size()) +
                           " bytes, expected at most " + std::to_string(kMaxPath));
    if (path.find('\0') != std::string::npos)
        failFile(path, "the file's name contains a zero byte");
}

bool isOnlyRead(const std::string& path) {
    static const char* const scripts[] = {"js", "lua", "py", "pyc", "python", "v8"};
    // These name more files to read or run, or load the file named before them without our checks.
    static const char* const lists[] = {"ffmpeg",    "logo",  "normals",  "p3d",
                                        "present3d", "pview", "revisions"};
    static const char* const networks[] = {"curl", "gdal", "net", "ogr", "osc", "vnc"};
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return !isArchive(path) && !has(scripts, extension) && !has(lists, extension) &&
           !has(networks, extension) && !leadsThroughArchive(path);
}

void requireOnlyRead(const std::string& path) {
    requireName(path);
    if (isOnlyRead(path)) return;
    failFile(path, "archives, scripts and network formats are not read");
}

bool isPseudoLoader(const std::string& name) {
    static const char* const all[] = {"gles",  "osgjs", "osgshadow", "rot",
                                      "scale", "skin",  "trans"};
    return has(all, osgDB::getLowerCaseFileExtension(name));
}

std::string osgSceneFormat(const std::string& path) {
    const bool isWrapped = isPseudoLoader(path); // its arguments precede it, and may contain dots
    std::string name = osgDB::getSimpleFileName(path);
    for (std::size_t dot = name.rfind('.'); dot != std::string::npos; dot = name.rfind('.')) {
        std::string extension = osgDB::convertToLowerCase(name.substr(dot + 1));
        if (isOsgScene(extension)) return extension;
        if (!isWrapped) break;
        name.resize(dot);
    }
    return {};
}

std::string findNamedFile(const std::string& name, const osgDB::Options* options) {
    osgDB::Registry& registry = *osgDB::Registry::instance();
    const bool hasCallback = (options != nullptr && options->getFindFileCallback() != nullptr) ||
                             registry.getFindFileCallback() != nullptr;
    if (hasCallback) return osgDB::findDataFile(name, options);
    if (name.empty() || osgDB::fileExists(name)) return name;
    std::string found;
    if (options != nullptr) found = osgDB::findFileInPath(name, options->getDatabasePathList());
    return found.empty() ? osgDB::findFileInPath(name, registry.getDataFilePathList()) : found;
}

std::ifstream openFile(const std::string& path, std::size_t maxMegabytes, const char* raisedBy,
                       std::size_t& size) {
    requireName(path);
    std::error_code failure;
    const std::filesystem::file_status status = std::filesystem::status(path, failure);
    if (status.type() == std::filesystem::file_type::directory)
        failFile(path, "cannot open: it is a directory");
    if (failure || status.type() == std::filesystem::file_type::not_found)
        failFile(path, "cannot open: " +
                           (failure ? failure.message() : std::string(std::strerror(ENOENT))));
    if (status.type() != std::filesystem::file_type::regular)
        failFile(path, "cannot open: not a regular file");
    size = static_cast<std::size_t>(std::filesystem::file_size(path, failure));
    if (failure) failFile(path, "cannot open: " + failure.message());
    if (size / kMegabyte >= maxMegabytes)
        failFile(path, std::to_string(size) + " bytes, expected less than " +
                           std::to_string(maxMegabytes) + " MB (option " + raisedBy + ")");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        failFile(path, std::string("cannot open: ") +
                           (errno != 0 ? std::strerror(errno) : "unknown reason"));
    return stream;
}

void failFile(const std::string& path, const std::string& message) {
    throw Error(shortened(path) + ": " + message);
}

void warn(const std::string& path, const std::string& message) {
    OSG_NOTICE << onOneLine(shortened(path) + ": " + message) << std::endl;
}

void failLine(const std::string& path, std::size_t line, const std::string& message) {
    failFile(path, "line " + std::to_string(line) + ": " + message);
}

std::size_t requireReadable(const std::string& path, const ReadLimits& limits) {
    requireOnlyRead(path);
    std::size_t size = 0;
    openFile(path, limits.fileMegabytes, "maxFileMB", size);
    return size;
}

bool isRegularFile(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

std::string readText(const std::string& path, const ReadLimits& limits) {
    return readWholeFile(path, limits.fileMegabytes, "maxFileMB");
}

namespace {

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 200000
/// std::from_chars() for doubles without "inf" and "nan", which Clang's library lacks before
/// LLVM 20.
std::from_chars_result fromChars(const char* first, const char* last, double& value) {
    const std::string_view text(first, static_cast<std::size_t>(last - first));
    const std::string number(text.substr(0, text.find_first_not_of("+-.0123456789eE")));
    std::istringstream in(number);
    in.imbue(std::locale::classic());
    in >> value;
    const std::string mantissa = number.substr(0, number.find_first_of("eE"));
    if (!in.eof() || number.size() != text.size() || text[0] == '+' ||
        mantissa.find_first_of("0123456789") == std::string::npos ||
        text.find_last_of("eE+-") == text.size() - 1)
        return {first, std::errc::invalid_argument};
    return {last, in && std::isfinite(value) ? std::errc() : std::errc::result_out_of_range};
}
#else
std::from_chars_result fromChars(const char* first, const char* last, double& value) {
    return std::from_chars(first, last, value);
}
#endif

} // namespace

bool parseNumber(std::string_view token, double& value) {
    if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
    const char* const end = token.data() + token.size();
    const auto [stop, status] = fromChars(token.data(), end, value);
    if (token.empty() || stop != end) return false;
    if (status == std::errc::result_out_of_range) {
        // A number too small for a double is 0, a number too large infinity.
        const std::size_t exponent = token.find_first_of("eE");
        const bool tiny = exponent == std::string_view::npos
                              ? token.find_first_of("123456789") > token.find('.')
                              : exponent + 1 < token.size() && token[exponent + 1] == '-';
        value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
        return true;
    }
    return status == std::errc();
}

std::string inQuotes(std::string_view token) {
    std::size_t longest = 40;
    // Do not split a multi-byte character.
    while (longest > 36 && longest < token.size() && (token[longest] & 0xc0) == 0x80) --longest;
    std::string text(token.substr(0, longest));
    if (token.size() > longest) text += "...";
    return '"' + onOneLine(text) + '"';
}

} // namespace osgSkin
