// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PICTURES_H
#define OSGSKINIMPORT_PICTURES_H 1

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

/// Pictures whose sizes count together, and which are read once each; see shareImages().
class SharedPictures : public osg::Object {
public:
    SharedPictures() = default;
    SharedPictures(const SharedPictures& other, const osg::CopyOp& copy)
        : osg::Object(other, copy), pixels(other.pixels), bytes(other.bytes), _files(other._files) {
    }
    META_Object(osgSkin, SharedPictures)

    /// Those that options carry; null where these are null or carry none.
    static SharedPictures* of(const osgDB::Options* options);

    /// The picture of a file; null where it cannot be read.
    /// \param path of the file, however it is spelled
    /// \param part of the file that the picture is; empty: the whole
    /// \param read is called the first time; what osgSkin::Error it throws is thrown each time
    osg::ref_ptr<osg::Image> once(const std::string& path, const std::string& part,
                                  const std::function<osg::ref_ptr<osg::Image>()>& read);

    double pixels = 0.0;   ///< of four bytes, of those that were read
    std::size_t bytes = 0; ///< of their files

protected:
    ~SharedPictures() override = default;

private:
    struct Read {
        osg::ref_ptr<osg::Image> image;
        std::string reason; ///< why there is none; empty: no reader gave one
    };
    std::map<std::string, Read> _files;
};

/// Reads the pictures of one model.
///
/// stb_image reads PNG, JPEG, BMP and TGA, after their sizes are checked (ReadLimits::pixelsOf()),
/// with eight bits a channel. OpenSceneGraph reads other formats, from trusted files.
class PictureReader {
public:
    /// \param options with limits, and pictures to count together with; may be null
    explicit PictureReader(const osgDB::Options* options);

    /// Whether stb_image reads files with this extension, whatever its case.
    static bool decodes(const std::string& extension);

    /// A picture within another file, in a format that stb_image reads or that
    /// ReadLimits::images names.
    /// \param name of that file, for errors
    /// \param extension of the picture's format
    /// \return null where no reader gives a reason
    /// \throw osgSkin::Error
    osg::ref_ptr<osg::Image> read(const std::string& name, const std::string& extension,
                                  std::string_view bytes);

    /// The picture of a file.
    /// \param otherwise reads it where stb_image does not
    /// \return null where no reader gives a reason
    /// \throw osgSkin::Error also where ReadLimits::formats allows only other formats
    osg::ref_ptr<osg::Image> readFile(const std::string& path,
                                      const std::function<osg::ref_ptr<osg::Image>()>& otherwise);

    SharedPictures& shared() { return *_shared; }

private:
    osg::ref_ptr<osg::Image> decode(const std::string& name, std::string_view bytes);

    const ReadLimits _limits;
    const osg::ref_ptr<SharedPictures> _shared;
};

} // namespace osgSkin

#endif
