// SPDX-License-Identifier: MIT
#include "pictures/formats/PnmPicture.h"

#include <locale>
#include <sstream>
#include <string>

namespace osgSkin {
namespace {

/// The next line that is neither empty nor a comment.
std::string nextPnmLine(std::istringstream& text) {
    std::string line;
    while (std::getline(text, line)) {
        const std::size_t begin = line.find_first_not_of(" \t\r\n\v\f");
        if (begin != std::string::npos && line[begin] != '#') return line;
    }
    return {};
}

} // namespace

PictureSize pnmSize(const PictureBytes& bytes) {
    constexpr std::size_t kPnmHeader = 4096;
    std::istringstream text(std::string(bytes.all().substr(0, kPnmHeader)));
    text.imbue(std::locale::classic());
    const std::string kind = nextPnmLine(text);
    bytes.require(kind.size() > 1 && (kind[0] == 'P' || kind[0] == 'p'), "no PNM picture");
    std::istringstream numbers(nextPnmLine(text));
    numbers.imbue(std::locale::classic());
    std::int64_t width = 0, height = 0;
    numbers >> width >> height;
    bytes.require(width > 0 && height > 0 && width <= std::int64_t(kLongestSide) &&
                      height <= std::int64_t(kLongestSide),
                  "a PNM picture without a size");
    PictureSize size;
    size.width = static_cast<std::uint64_t>(width);
    size.height = static_cast<std::uint64_t>(height);
    size.bytesPerPixel = 6;
    return size;
}

} // namespace osgSkin
