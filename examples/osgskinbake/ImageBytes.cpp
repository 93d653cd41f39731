// SPDX-License-Identifier: GPL-3.0-or-later
#include "ImageBytes.h"

#include <osg/Notify>
#include <osgDB/FileUtils>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace bake {
namespace {

bool begins(const std::string& data, const std::string& with) {
    return data.compare(0, with.size(), with) == 0;
}

std::optional<ImageBytes> readBytes(const osg::Image& image, const std::string& folder) {
    if (image.getFileName().empty()) return std::nullopt;
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_front(folder);
    ImageBytes result;
    result.file = osgDB::findDataFile(image.getFileName(), options);
    // A scene may call a picture that stands in it as it likes, as a pipe or a device, too.
    std::error_code failure;
    if (!std::filesystem::is_regular_file(result.file, failure)) return std::nullopt;
    std::ifstream in(result.file, std::ios::binary);
    result.data.assign(std::istreambuf_iterator<char>(in), {});
    result.isJpeg = begins(result.data, "\xff\xd8\xff");
    if (!result.isJpeg && !begins(result.data, "\x89PNG\r\n\x1a\n")) return std::nullopt;
    return result;
}

/// The image as rows of RGBA bytes from the lower left, which the PNG writer takes whatever the
/// image was.
osg::ref_ptr<osg::Image> plain(const osg::Image& image) {
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(image.s(), image.t(), 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const bool flip = image.getOrigin() == osg::Image::TOP_LEFT;
    const auto columns = static_cast<unsigned>(image.s()), rows = static_cast<unsigned>(image.t());
    for (unsigned t = 0; t < rows; ++t)
        for (unsigned s = 0; s < columns; ++s)
            result->setColor(image.getColor(s, flip ? rows - 1 - t : t), s, t);
    return result;
}

std::optional<ImageBytes> makePng(const osg::Image& image) {
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
    if (writer == nullptr || image.isCompressed() || image.s() < 1 || image.t() < 1)
        return std::nullopt;
    std::ostringstream out;
    if (!writer->writeImage(*plain(image), out).success()) return std::nullopt;
    return ImageBytes{out.str(), false, {}};
}

} // namespace

std::optional<ImageBytes> bytesOf(const osg::Image& image, const std::string& folder) {
    std::optional<ImageBytes> result = readBytes(image, folder);
    if (!result) result = makePng(image);
    if (!result)
        OSG_NOTICE << "texture \"" << image.getFileName()
                   << "\" cannot be written as PNG; baked without" << std::endl;
    return result;
}

} // namespace bake
