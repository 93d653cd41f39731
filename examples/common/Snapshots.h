// SPDX-License-Identifier: MIT
#ifndef COMMON_SNAPSHOTS_H
#define COMMON_SNAPSHOTS_H

#include <osg/BoundingBox>
#include <osg/Image>
#include <osg/Node>
#include <osg/Vec3d>
#include <osg/ref_ptr>
#include <osgViewer/Viewer>

#include <memory>
#include <string>
#include <vector>

namespace example {

/// Where the camera of a picture stands.
struct View {
    osg::Vec3d eye;
    osg::Vec3d centre;
    osg::Vec3d up{0, 0, 1};
    double fieldOfView = 30.0; ///< degrees, of the picture's height
};

/// Takes pictures of a scene at given times of its own clock, so that they do not depend on how
/// fast the machine draws. Needs an X display (Xvfb will do).
class Snapshots {
public:
    /// \throw std::runtime_error where no picture can be drawn
    Snapshots(osg::Node* scene, const View& view, int width, int height);
    ~Snapshots();
    Snapshots(const Snapshots&) = delete;
    Snapshots& operator=(const Snapshots&) = delete;

    /// The scene at `time`, in seconds; times must not go back.
    osg::ref_ptr<osg::Image> take(double time);

    /// The same, written to a file.
    /// \throw std::runtime_error where it cannot be written
    void write(double time, const std::string& file);

private:
    struct Impl;
    std::unique_ptr<Impl> _impl;
};

/// Writes a picture whole or not at all; its folder is made if need be.
/// \throw std::runtime_error where it cannot be written, or where no writer knows its extension
void writePicture(const osg::Image& image, const std::string& file);

/// PREFIX_00.png, PREFIX_01.png, ... in `folder`, which is made if need be.
std::string pictureName(const std::string& folder, const std::string& prefix, unsigned int index);

/// The nearest view from a side that shows all of a box, with a margin of a tenth around it. Up is
/// z.
///
/// \param box not empty
/// \param side where the camera stands, from the box; any length, not straight up
/// \param aspect the picture's width to its height
View framed(const osg::BoundingBoxd& box, const osg::Vec3d& side, double aspect);

} // namespace example

namespace figures {

using Tile = osg::ref_ptr<osg::Image>;

/// Pictures of one size as one: rows of `columns`, the first at the upper left.
Tile tiled(const std::vector<Tile>& tiles, std::size_t columns);

Tile photograph(osg::Node* scene, const example::View& view, int width, int height);

/// \throw std::runtime_error where it cannot be written
void writePicture(const osg::Image& image, const std::string& file);

} // namespace figures

namespace example {

/// Opens a viewer's window. OpenSceneGraph's own run() takes none for one that has been closed.
/// \throw std::runtime_error where none can be opened
void openWindow(osgViewer::Viewer& viewer);

} // namespace example

#endif
