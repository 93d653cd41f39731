// SPDX-License-Identifier: MIT
#include "pictures/formats/PnmPicture.h"

#include <algorithm>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

namespace osgSkin {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";

/// The next line that is neither empty nor a comment, as a reader takes it that looks for one to
/// the end of the file.
std::string_view nextPnmLine(std::string_view& rest) {
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const std::size_t begin = line.find_first_not_of(kBlank);
        if (begin != std::string_view::npos && line[begin] != '#') return line;
    }
    return {};
}

} // namespace

PictureSize pnmSize(const PictureBytes& bytes) {
    std::string_view rest = bytes.all();
    const std::string_view kind = nextPnmLine(rest);
    bytes.require(kind.size() > 1 && (kind[0] == 'P' || kind[0] == 'p'), "no PNM picture");
    constexpr std::size_t kLongestLine = 300;
    const std::string_view line = nextPnmLine(rest);
    bytes.require(line.size() <= kLongestLine, "a PNM picture without a size");
    std::istringstream numbers{std::string(line)};
    numbers.imbue(std::locale::classic());
    std::int64_t width = 0, height = 0;
    numbers >> width >> height;
    // What a program's locale takes for a part of a number must not follow.
    const int next = numbers.peek();
    const bool isEnd = next == std::istringstream::traits_type::eof() ||
                       kBlank.find(static_cast<char>(next)) != std::string_view::npos;
    bytes.require(width > 0 && height > 0 && isEnd && width <= std::int64_t(kLongestSide) &&
                      height <= std::int64_t(kLongestSide),
                  "a PNM picture without a size");
    PictureSize size;
    size.width = static_cast<std::uint64_t>(width);
    size.height = static_cast<std::uint64_t>(height);
    size.bytesPerPixel = 6;
    return size;
}

} // namespace osgSkin
