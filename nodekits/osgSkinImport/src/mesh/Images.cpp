// SPDX-License-Identifier: MIT
#include "mesh/Images.h"

#include "files/FileText.h"
#include "files/SharedByOptions.h"

#include <osgSkin/Error>
#include <osgSkinImport/ShareImages>

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <sstream>
#include <system_error>

// Zeroed memory, because stb_image 2.27 reads Huffman tables that a file does not define.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_BMP
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_ONLY_TGA
#include <stb_image.h>

namespace osgSkin {
namespace {

constexpr int kMaxSide = 1 << 16; ///< in pixels

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether the Huffman tables of a JPEG image have at most 256 entries, which stb_image 2.27 does
/// not check. True for other images.
bool hasShortTables(std::string_view bytes) {
    constexpr unsigned tables = 0xc4, firstRestart = 0xd0, imageEnd = 0xd9;
    const auto byte = [&](std::size_t at) {
        return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0u;
    };
    if (bytes.substr(0, 2) != "\xff\xd8") return true;
    for (std::size_t at = 2; at + 4 <= bytes.size();) {
        const unsigned marker = byte(at + 1);
        if (byte(at) != 0xff || marker <= 1 || marker == 0xff ||
            (marker >= firstRestart && marker <= imageEnd)) { // not the start of a segment
            ++at;
            continue;
        }
        const std::size_t end = at + 2 + std::max(2u, byte(at + 2) << 8 | byte(at + 3));
        for (std::size_t table = at + 4; marker == tables && table < end;) {
            std::size_t entries = 0;
            for (std::size_t length = 1; length <= 16; ++length) entries += byte(table + length);
            if (entries > 256) return false;
            table += 17 + entries;
        }
        at = end;
    }
    return true;
}

} // namespace

osg::ref_ptr<osg::Image> SharedImages::once(const std::string& path, const std::string& part,
                                            const std::function<osg::ref_ptr<osg::Image>()>& read) {
    std::error_code failure;
    const std::string file = std::filesystem::weakly_canonical(path, failure).string();
    const auto [entry, isNew] = _files.emplace((failure ? path : file) + '\n' + part, Read());
    Read& known = entry->second;
    try {
        if (isNew) known.image = read();
    } catch (const Error& error) {
        known.reason = error.what();
    }
    if (!known.reason.empty()) throw Error(known.reason);
    return known.image;
}

osg::ref_ptr<osgDB::Options> shareImages(const osgDB::Options* options) {
    return share<SharedImages>(options);
}

ImageReader::ImageReader(const osgDB::Options* options)
    : _limits(ReadLimits::of(options)),
      _shared(sharedBy<SharedImages>(options) != nullptr ? sharedBy<SharedImages>(options)
                                                         : new SharedImages) {}

bool ImageReader::decodes(const std::string& extension) {
    static const char* const formats[] = {"bmp", "jpeg", "jpg", "png", "tga"};
    return std::find(std::begin(formats), std::end(formats),
                     osgDB::convertToLowerCase(extension)) != std::end(formats);
}

osg::ref_ptr<osg::Image> ImageReader::decode(const std::string& name, std::string_view bytes) {
    if (bytes.size() > std::size_t(std::numeric_limits<int>::max()))
        failFile(name,
                 "an image of " + std::to_string(bytes.size()) + " bytes, expected less than 2 GB");
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    if (!hasShortTables(bytes))
        failFile(name, "a JPEG image with a Huffman table of more than 256 entries");
    int width = 0, height = 0, channels = 0;
    const auto fail = [&] {
        failFile(name, std::string("cannot be decoded as an image: ") + stbi_failure_reason());
    };
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) fail();
    const std::string sides = std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        failFile(name, "an image of " + sides + " pixels, expected 1 to " +
                           std::to_string(kMaxSide) + " each way");
    const double pixels = double(width) * height;
    const double limit =
        std::max(0.0, double(_limits.pixelsOf(_shared->bytes + bytes.size())) - _shared->pixels);
    if (pixels > limit)
        failFile(name, "an image of " + sides + " pixels, expected at most " +
                           std::to_string(static_cast<std::size_t>(limit)) + " of four bytes" +
                           (_shared->bytes > 0 ? " beside those before it" : "") +
                           " (option maxPixels)");
    _shared->pixels += pixels;
    _shared->bytes += bytes.size();
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> decoded(
        stbi_load_from_memory(data, size, &width, &height, &channels, 0), stbi_image_free);
    if (!decoded) fail();
    const GLenum formats[] = {GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_RGB, GL_RGBA};
    const GLenum format = formats[std::clamp(channels, 1, 4) - 1];
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, GL_UNSIGNED_BYTE);
    const auto rowBytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    for (int y = 0; y < height; ++y) // OpenSceneGraph's rows start at the bottom
        std::copy_n(decoded.get() + rowBytes * static_cast<std::size_t>(height - 1 - y), rowBytes,
                    image->data(0, static_cast<unsigned>(y)));
    return image;
}

osg::ref_ptr<osg::Image> ImageReader::read(const std::string& name, const std::string& extension,
                                           std::string_view bytes) {
    if (decodes(extension)) return decode(name, bytes);
    if (!contains(_limits.images, osgDB::convertToLowerCase(extension)))
        failFile(name, "an embedded image in the format " + inQuotes(extension) +
                           ", expected PNG, JPEG, BMP or TGA (option images)");
    osgDB::ReaderWriter* reader =
        osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (reader == nullptr) return nullptr;
    std::istringstream stream{std::string(bytes)};
    return reader->readImage(stream).getImage();
}

osg::ref_ptr<osg::Image>
ImageReader::readFile(const std::string& path,
                      const std::function<osg::ref_ptr<osg::Image>()>& otherwise) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (decodes(extension))
        return decode(path, readWholeFile(path, _limits.fileMegabytes, "maxFileMB"));
    if (!contains(_limits.images, extension)) _limits.checkFormat(path);
    requireReadable(path, _limits);
    return otherwise();
}

} // namespace osgSkin
