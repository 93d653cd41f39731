// SPDX-License-Identifier: MIT
#include "pictures/PictureCheck.h"

#include "pictures/formats/BmpPicture.h"
#include "pictures/formats/DdsPicture.h"
#include "pictures/formats/GifPicture.h"
#include "pictures/formats/PnmPicture.h"
#include "pictures/formats/SgiPicture.h"
#include "pictures/formats/TgaPicture.h"
#include "pictures/formats/TiffPicture.h"
#include "pictures/formats/WebPicture.h"
#include "pictures/pixels/GifPixels.h"
#include "pictures/pixels/PngPixels.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

using SizeOf = PictureSize (*)(const PictureBytes&);

const std::map<std::string, SizeOf>& formats() {
    static const std::map<std::string, SizeOf> all = {
        {"bmp", bmpSize}, {"bw", sgiSize},   {"dds", ddsSize},   {"gif", gifSize},
        {"int", sgiSize}, {"inta", sgiSize}, {"jpeg", jpegSize}, {"jpg", jpegSize},
        {"pbm", pnmSize}, {"pgm", pnmSize},  {"png", pngSize},   {"pnm", pnmSize},
        {"ppm", pnmSize}, {"rgb", sgiSize},  {"rgba", sgiSize},  {"sgi", sgiSize},
        {"tga", tgaSize}, {"tif", tiffSize}, {"tiff", tiffSize}};
    return all;
}

/// Beyond this readers count bytes past 31 bits.
constexpr std::uint64_t kMostBytes = (std::uint64_t{1} << 31) - 1;

} // namespace

void PictureCheck::take(const std::string& name, const std::string& extension,
                        std::string_view bytes) {
    const std::string format = osgDB::convertToLowerCase(extension);
    const auto& others = _limits.pictures;
    if (std::find(others.begin(), others.end(), format) != others.end()) return;
    const auto known = formats().find(format);
    if (known == formats().end()) {
        std::string expected;
        for (const auto& [each, sizeOf] : formats())
            expected += (expected.empty() ? "" : ", ") + each;
        failFile(name, "a picture in the format " + inQuotes(extension) + ", expected one of " +
                           expected + " (option pictures)");
    }
    const PictureBytes picture(name, bytes);
    const PictureSize size = known->second(picture);
    const std::string sides = std::to_string(size.width) + " x " + std::to_string(size.height);
    if (size.width == 0 || size.height == 0 || size.width > kLongestSide ||
        size.height > kLongestSide)
        picture.fail("a picture of " + sides + " pixels, expected 1 to " +
                     std::to_string(kLongestSide) + " each way");
    // Sides are below 2^17 and images fewer than bytes, but for what is far beyond any limit.
    const double needed = double(size.width) * double(size.height) * double(size.images) *
                          double(size.bytesPerPixel) / 4.0;
    const double most =
        std::max(0.0, double(_limits.pixelsOf(_shared->bytes + bytes.size())) - _shared->pixels);
    if (needed > most)
        picture.fail("a picture of " + sides + " pixels" +
                     (size.images > 1 ? ", " + std::to_string(size.images) + " times" : "") +
                     ", expected at most " + std::to_string(static_cast<std::size_t>(most)) +
                     " of four bytes" + (_shared->bytes > 0 ? " beside those before it" : "") +
                     " (option maxPixels)");
    if (size.width * size.height * size.bytesPerPixel > kMostBytes)
        picture.fail("a picture of " + sides + " pixels, expected at most 2 GB when unpacked");
    _shared->pixels += needed;
    _shared->bytes += bytes.size();
    if (known->second == sgiSize) requireSgiRows(picture);
    if (format == "png") unpackPng(picture);
    if (format == "gif") unpackGif(picture);
}

void PictureCheck::takeFile(const std::string& path) {
    take(path, osgDB::getFileExtension(path),
         readWholeFile(path, _limits.fileMegabytes, "maxFileMB"));
}

} // namespace osgSkin
