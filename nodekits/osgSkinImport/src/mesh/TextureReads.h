// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_TEXTUREREADS_H
#define OSGSKINIMPORT_TEXTUREREADS_H 1

#include "pictures/PictureCheck.h"

#include <osg/Image>
#include <osg/ref_ptr>

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace osgSkin {

/// The textures that a file names: each is read once, however many materials share it, and those
/// that cannot be read are told of in one notice when this goes.
class TextureReads {
public:
    /// \param path of the file that names the textures
    /// \param options whose limits hold for all of them together; may be null
    TextureReads(std::string path, const osgDB::Options* options)
        : _path(std::move(path)), _pictures(options) {}
    ~TextureReads();
    TextureReads(const TextureReads&) = delete;
    TextureReads& operator=(const TextureReads&) = delete;

    /// The texture called `name`; null where it cannot be read.
    /// \param read is called the first time, and returns null where it fails, or throws
    ///        osgSkin::Error, whose reason is told
    osg::ref_ptr<osg::Image> once(const std::string& name,
                                  const std::function<osg::ref_ptr<osg::Image>()>& read);

    /// What looks at each before it is read.
    PictureCheck& pictures() { return _pictures; }

private:
    const std::string _path;
    PictureCheck _pictures;
    std::map<std::string, osg::ref_ptr<osg::Image>> _images; ///< by their names
    std::map<std::string, std::string> _reasons;             ///< of some that cannot be read
};

} // namespace osgSkin

#endif
