// SPDX-License-Identifier: MIT
#include "text/FileText.h"

#include "text/SafeNames.h"

#include <osgSkin/Error>

#include <osg/Notify>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

namespace osgSkin {
namespace {

constexpr std::size_t kMegabyte = 1 << 20;

/// What is too long for a file's name is no more than quoted.
std::string shortened(const std::string& path) {
    constexpr std::size_t longest = 200;
    return path.size() > kLongestPath ? path.substr(0, longest) + "..." : path;
}

} // namespace

std::ifstream openFile(const std::string& path, std::size_t mostMegabytes, const char* raisedBy,
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
        failFile(path, "cannot open: it is no regular file, expected neither pipe nor device");
    size = static_cast<std::size_t>(std::filesystem::file_size(path, failure));
    if (failure) failFile(path, "cannot open: " + failure.message());
    if (size / kMegabyte >= mostMegabytes)
        failFile(path, std::to_string(size) + " bytes, expected less than " +
                           std::to_string(mostMegabytes) + " MB (option " + raisedBy + ")");
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

void tellOf(const std::string& path, const std::string& message) {
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

bool parseNumber(std::string_view token, double& value) {
    if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
    const char* const end = token.data() + token.size();
    const auto [stop, status] = std::from_chars(token.data(), end, value);
    if (token.empty() || stop != end) return false;
    if (status == std::errc::result_out_of_range) {
        // Too small for a double is zero; too large has no finite value.
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
    // A letter of several bytes stays whole.
    while (longest > 36 && longest < token.size() && (token[longest] & 0xc0) == 0x80) --longest;
    std::string text(token.substr(0, longest));
    if (token.size() > longest) text += "...";
    return '"' + onOneLine(text) + '"';
}

} // namespace osgSkin
