// SPDX-License-Identifier: MIT
#ifndef COMMON_SNAPSHOTS_H
#define COMMON_SNAPSHOTS_H

#include <osg/BoundingBox>
#include <osg/Image>
#include <osg/Node>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <memory>
#include <string>
#include <vector>

namespace example {

/// The camera of a picture.
struct View {
    osg::Vec3d eye;
    osg::Vec3d centre;
    osg::Vec3d up{0, 0, 1};
    double fieldOfView = 30.0; ///< vertical, degrees
};

/// Takes pictures of a scene at given simulation times, so they do not depend on the speed of
/// rendering. Needs an X display; Xvfb works.
class Snapshots {
public:
    /// \throw std::runtime_error if no graphics context can be created
    Snapshots(osg::Node* scene, const View& view, int width, int height);
    ~Snapshots();
    Snapshots(const Snapshots&) = delete;
    Snapshots& operator=(const Snapshots&) = delete;

    /// Takes a picture at `time`, in seconds. Times must not decrease.
    osg::ref_ptr<osg::Image> take(double time);

    /// Takes a picture and writes it to a file.
    /// \throw std::runtime_error if the file cannot be written
    void write(double time, const std::string& file);

private:
    struct Impl;
    std::unique_ptr<Impl> _impl;
};

/// Writes a picture. Creates its folder if necessary, and leaves no partial file.
/// \throw std::runtime_error if the file cannot be written, or its extension is not supported
void writePicture(const osg::Image& image, const std::string& file);

/// PREFIX_00.png, PREFIX_01.png, ... in `folder`, which is created if necessary.
std::string pictureName(const std::string& folder, const std::string& prefix, unsigned int index);

/// The closest view from a given direction that shows a whole box, with a margin of a tenth. Z is
/// up.
///
/// \param box not empty
/// \param side direction from the box to the camera; any length, not vertical
/// \param aspect width / height of the picture
View framed(const osg::BoundingBoxd& box, const osg::Vec3d& side, double aspect);

} // namespace example

namespace figures {

using Tile = osg::ref_ptr<osg::Image>;

/// Joins pictures of equal size into a grid with `columns` columns, starting at the upper left.
Tile tiled(const std::vector<Tile>& tiles, std::size_t columns);

Tile photograph(osg::Node* scene, const example::View& view, int width, int height);

/// \throw std::runtime_error if the file cannot be written
void writePicture(const osg::Image& image, const std::string& file);

} // namespace figures

#endif
