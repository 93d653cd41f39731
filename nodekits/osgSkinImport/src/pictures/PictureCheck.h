// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PICTURECHECK_H
#define OSGSKINIMPORT_PICTURECHECK_H 1

#include "pictures/SharedPictures.h"

#include <osgSkinImport/ReadLimits>

#include <string>
#include <string_view>
#include <utility>

namespace osgSkin {

/// Looks at the pictures of one model before OpenSceneGraph's readers do.
///
/// They are refused, by osgSkin::Error, where a reader would read or write beyond what there is,
/// not come to an end, or take more memory for all of them than their files are worth
/// (ReadLimits::pixelsOf()); and in formats that nothing looks at, unless ReadLimits::pictures
/// names them.
class PictureCheck {
public:
    /// \param limits for its pictures
    /// \param shared what they count together with; null: with none
    PictureCheck(ReadLimits limits, SharedPictures* shared)
        : _limits(std::move(limits)), _shared(shared != nullptr ? shared : new SharedPictures) {}
    explicit PictureCheck(const osgDB::Options* options)
        : PictureCheck(ReadLimits::of(options), SharedPictures::of(options)) {}

    /// \param name of the picture, for errors
    /// \param extension of the format, as the reader is found by
    /// \param bytes of the whole file
    void take(const std::string& name, const std::string& extension, std::string_view bytes);

    /// The same of a file.
    void takeFile(const std::string& path);

    SharedPictures& shared() { return *_shared; }

private:
    const ReadLimits _limits;
    const osg::ref_ptr<SharedPictures> _shared;
};

} // namespace osgSkin

#endif
