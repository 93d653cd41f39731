// SPDX-License-Identifier: MIT
#pragma once

#include <osg/ArgumentParser>
#include <osgViewer/Viewer>

namespace example {

/// For the end of a program's help.
constexpr char kWindowHelp[] =
    "osgviewer's options work, too: --window X Y WIDTH HEIGHT (pixels, also of pictures), --screen "
    "N,\n--SingleThreaded and the other threading models, --run-on-demand, ...: see osgviewer "
    "--help.";

/// Place and size of a window or a picture, by osgviewer's options `--window` and `--screen`.
///
/// A program makes it of an osg::ArgumentParser first, then an osgViewer::Viewer of the same, which
/// takes the other options of osgviewer; CLI11 reads what is left.
class WindowOptions {
public:
    /// \param words both options are removed
    /// \param width pixels, without `--window`
    /// \param height pixels, without `--window`
    /// \throw UsageError where the window has no size
    WindowOptions(osg::ArgumentParser& words, int width, int height);

    int width() const { return _width; }
    int height() const { return _height; }

    /// Opens the window. Without one, osgViewer's run() would return as if the user had closed it.
    ///
    /// \param viewer made of the same arguments: it may have a window already
    /// \throw std::runtime_error if no window can be opened
    void open(osgViewer::Viewer& viewer) const;

private:
    int _x = 100, _y = 100, _width, _height;
    int _screen = -1;
    bool _isGiven = false;
};

/// Whether `-O` was given, which osgViewer has passed to osgDB. Programs that read no files by
/// osgDB must refuse it.
bool hasOsgOptionString();

} // namespace example
