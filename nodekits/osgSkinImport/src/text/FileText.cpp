// SPDX-License-Identifier: MIT
#include "text/FileText.h"

#include <osgSkin/Error>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace osgSkin {
namespace {

std::string onOneLine(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
        text.pop_back();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return text;
}

std::ifstream open(const std::string& path) {
    std::error_code ignored;
    // A directory opens as a stream on Linux and only fails once it is read.
    if (std::filesystem::is_directory(path, ignored))
        failFile(path, "cannot open: it is a directory");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        failFile(path, std::string("cannot open: ") +
                           (errno != 0 ? std::strerror(errno) : "unknown reason"));
    return stream;
}

} // namespace

void failFile(const std::string& path, const std::string& message) {
    throw Error(onOneLine(path + ": " + message));
}

void failLine(const std::string& path, std::size_t line, const std::string& message) {
    failFile(path, "line " + std::to_string(line) + ": " + message);
}

void requireReadable(const std::string& path) {
    open(path);
}

std::string readText(const std::string& path) {
    std::ifstream stream = open(path);
    std::ostringstream content;
    if (stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
    if (stream.bad()) failFile(path, "cannot be read to its end");
    return std::move(content).str();
}

bool parseNumber(std::string_view token, double& value) {
    if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
    const char* const end = token.data() + token.size();
    const auto [stop, status] = std::from_chars(token.data(), end, value);
    if (token.empty() || stop != end) return false;
    if (status == std::errc::result_out_of_range) {
        // Too small for a double is zero; too large has no finite value.
        const std::size_t exponent = token.find_first_of("eE");
        const bool tiny = exponent != std::string_view::npos && exponent + 1 < token.size() &&
                          token[exponent + 1] == '-';
        value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
        return true;
    }
    return status == std::errc();
}

std::string inQuotes(std::string_view token) {
    constexpr std::size_t longest = 40;
    std::string text(token.substr(0, longest));
    if (token.size() > longest) text += "...";
    return '"' + onOneLine(text) + '"';
}

} // namespace osgSkin
