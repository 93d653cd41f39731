// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_IMAGES_H
#define OSGSKINIMPORT_IMAGES_H 1

#include <osgSkinImport/ReadLimits>

#include <osg/Image>
#include <osg/Object>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace osgSkin {

/// Images whose sizes count together, each read once; see shareImages().
class SharedImages : public osg::Object {
public:
    SharedImages() = default;
    SharedImages(const SharedImages& other, const osg::CopyOp& copy)
        : osg::Object(other, copy), pixels(other.pixels), bytes(other.bytes), _files(other._files) {
    }
    META_Object(osgSkin, SharedImages)

    /// The image of a file; null if it cannot be read.
    /// \param path of the file, in any spelling
    /// \param part name of an image within the file; empty for the whole file
    /// \param read is called once; an osgSkin::Error that it throws is thrown again by later calls
    osg::ref_ptr<osg::Image> once(const std::string& path, const std::string& part,
                                  const std::function<osg::ref_ptr<osg::Image>()>& read);

    double pixels = 0.0;   ///< of four bytes, in all images read
    std::size_t bytes = 0; ///< of their files

protected:
    ~SharedImages() override = default;

private:
    struct Read {
        osg::ref_ptr<osg::Image> image;
        std::string reason; ///< why there is none; empty if unknown
    };
    std::map<std::string, Read> _files;
};

/// Reads the images of one model.
///
/// Decodes PNG, JPEG, BMP and TGA by stb_image, with eight bits per channel, after checking their
/// sizes (ReadLimits::pixelsOf()). OpenSceneGraph reads other formats, from trusted files.
class ImageReader {
public:
    /// \param options with limits and possibly shared images; may be null
    explicit ImageReader(const osgDB::Options* options);

    /// Whether stb_image reads files with this extension, in any case.
    static bool decodes(const std::string& extension);

    /// Reads an embedded image, in a format of stb_image or of ReadLimits::images.
    /// \param name of the containing file, for errors
    /// \param extension of the image's format
    /// \param bytes encoded image
    /// \return null if it cannot be read for an unknown reason
    /// \throw osgSkin::Error with the reason
    osg::ref_ptr<osg::Image> read(const std::string& name, const std::string& extension,
                                  std::string_view bytes);

    /// Reads an image file.
    /// \param path of the file
    /// \param otherwise reads the formats that stb_image does not
    /// \return null if it cannot be read for an unknown reason
    /// \throw osgSkin::Error with the reason, also if ReadLimits::formats does not allow its format
    osg::ref_ptr<osg::Image> readFile(const std::string& path,
                                      const std::function<osg::ref_ptr<osg::Image>()>& otherwise);

    SharedImages& shared() { return *_shared; }

private:
    osg::ref_ptr<osg::Image> decode(const std::string& name, std::string_view bytes);

    const ReadLimits _limits;
    const osg::ref_ptr<SharedImages> _shared;
};

} // namespace osgSkin

#endif
