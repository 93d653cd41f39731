// SPDX-License-Identifier: MIT
#include "saved/SavedImage.h"

#include "saved/SavedInput.h"
#include "text/FileText.h"

#include <osg/Image>
#include <osgDB/DataTypes>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cctype>
#include <set>

namespace osgSkin {
namespace {

enum Place : std::size_t {
    kKind = 1,
    kWidth = 3,
    kHeight,
    kDepth,
    kInternal,
    kFormat,
    kType,
    kPacking,
    kMemory,
    kBytes,
    kLevels
};
constexpr std::int64_t kWidest = 1 << 16;
constexpr std::int64_t kMostLevels = 32;

/// Readers of pictures; any other reads a scene from what stands in this one.
bool isPicture(const std::string& name) {
    static const std::set<std::string> extensions = {
        "",    "bmp", "dds", "exr", "gif", "hdr",  "jpeg", "jpg", "ktx", "pbm",
        "pgm", "png", "pnm", "ppm", "rgb", "rgba", "sgi",  "tga", "tif", "tiff"};
    return extensions.count(osgDB::getLowerCaseFileExtension(name)) > 0;
}

} // namespace

void SavedImage::tookProperty(const std::string& name) {
    _named = name == "ClassName" || (_named && name == "UniqueID");
    _fileName = name == "FileName";
    if (name != "WriteHint") return;
    _open = true;
    _numbers.clear();
    _texts = 0;
}

void SavedImage::checkSize(SavedInput& input, std::uint64_t level, double bytes) const {
    const auto side = [&](std::size_t place) {
        return std::max<std::int64_t>(1, level < 62 ? _numbers[place] >> level : 0);
    };
    for (const std::size_t place : {kWidth, kHeight, kDepth})
        if (_numbers[place] < 0 || _numbers[place] > kWidest)
            input.refuse("a picture " + std::to_string(_numbers[place]) +
                         " pixels long, expected 0 to 65536");
    const double pixels = double(side(kWidth)) * double(side(kHeight)) * double(side(kDepth));
    const auto format = static_cast<GLenum>(_numbers[kFormat]);
    double needed = pixels / 16.0; // at least
    if (needed <= bytes)
        needed = osg::Image::computeImageSizeInBytes(
            int(side(kWidth)), int(side(kHeight)), int(side(kDepth)), format,
            static_cast<GLenum>(_numbers[kType]), std::max(1, int(_numbers[kPacking])));
    const double bits = osg::Image::computePixelSizeInBits(format, GLenum(_numbers[kType]));
    if (needed <= bytes && pixels * bits / 8.0 <= bytes && needed > 0.0) return;
    input.refuse("a picture whose size is not that of its data");
}

std::int64_t SavedImage::tookNumber(std::int64_t number, std::string_view rest, SavedInput& input) {
    if (!_open) return number;
    _numbers.push_back(number);
    const std::size_t place = _numbers.size() - 1;
    const bool inFile = place > kKind && _numbers[kKind] == osgDB::IMAGE_INLINE_DATA;
    if (place == kKind &&
        (number == osgDB::IMAGE_INLINE_DATA || number == osgDB::IMAGE_INLINE_FILE))
        return number;
    if (place < kKind) return number;
    if (!inFile) { // a whole file of a picture, or only the name of one
        if (place > kKind && number > std::int64_t(rest.size()))
            input.refuse("a picture with more bytes than the file");
        if (place > kKind && input.isBinary()) checkFile(rest.substr(0, std::size_t(number)));
        _open = false;
        return number;
    }
    if (place == kPacking && (number < 0 || number > 8))
        input.refuse("a picture with a packing of " + std::to_string(number) + ", expected 1 to 8");
    if (place == kMemory) return osg::Image::USE_NEW_DELETE; // that is how OSG's reader takes it
    if (place < kBytes) return number;
    if (!input.isBinary()) {
        if (number < 1 || number > kMostLevels)
            input.refuse(std::to_string(number) + " levels of a picture, expected 1 to 32");
        return number;
    }
    if (place == kBytes) {
        if (number > std::int64_t(rest.size()))
            input.refuse("a picture with more bytes than the file");
        else if (number > 0)
            checkSize(input, 0, double(number));
    } else if (place == kLevels && number > kMostLevels) {
        input.refuse(std::to_string(number) + " levels of a picture, expected at most 32");
    } else if (place > kLevels) {
        checkSize(input, place - kLevels, double(_numbers[kBytes] - number));
    }
    if (place >= kLevels && std::int64_t(place) == std::int64_t(kLevels) + _numbers[kLevels])
        _open = false;
    return number;
}

void SavedImage::tookText(const std::string& text, SavedInput& input) {
    if (_fileName) {
        _fileName = _named = false;
        _name = text;
        if (!isPicture(text))
            input.refuse("a picture called " + inQuotes(text) + ", expected a picture's extension");
    } else if (_open && _numbers.size() == kBytes + 1) {
        const auto isDigit = [](unsigned char c) {
            return std::isalnum(c) || c == '+' || c == '/';
        };
        const auto digits = std::count_if(text.begin(), text.end(), isDigit);
        checkSize(input, _texts, double(digits) * 6.0 / 8.0);
        if (++_texts == std::uint64_t(_numbers[kBytes])) _open = false;
    }
}

void SavedImage::checkFile(std::string_view bytes) {
    const std::string extension = osgDB::getFileExtension(_name);
    if (!extension.empty()) _pictures.take("the picture " + inQuotes(_name), extension, bytes);
}

} // namespace osgSkin
