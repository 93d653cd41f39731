// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SHAREDPICTURES_H
#define OSGSKINIMPORT_SHAREDPICTURES_H 1

#include <osg/Image>
#include <osg/Object>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <cstddef>
#include <functional>
#include <map>
#include <string>

namespace osgSkin {

/// Pictures whose sizes count together, and which are read once each; see sharePictures().
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

    double pixels = 0.0;   ///< of four bytes, of those that were taken
    std::size_t bytes = 0; ///< of their files

protected:
    ~SharedPictures() override = default;

private:
    struct Read {
        osg::ref_ptr<osg::Image> image;
        std::string reason; ///< why there is none; empty: no reader tells
    };
    std::map<std::string, Read> _files;
};

} // namespace osgSkin

#endif
