// SPDX-License-Identifier: MIT
#include "WindowOptions.h"

#include "CommandLine.h"

#include <osgDB/Registry>

#include <algorithm>
#include <stdexcept>

namespace example {

WindowOptions::WindowOptions(osg::ArgumentParser& words, int width, int height)
    : _width(width), _height(height) {
    while (words.read("--window", _x, _y, _width, _height)) _isGiven = true;
    while (words.read("--screen", _screen)) {
    }
    if (std::min(_width, _height) < 1 || std::max(_width, _height) > 8000)
        throw UsageError("--window: expected a width and a height of 1 to 8000 pixels");
}

void WindowOptions::open(osgViewer::Viewer& viewer) const {
    const bool hasWindow = viewer.getCamera()->getGraphicsContext() || viewer.getNumSlaves() > 0;
    if (!hasWindow && (_isGiven || _screen < 0))
        viewer.setUpViewInWindow(_x, _y, _width, _height,
                                 static_cast<unsigned int>(std::max(0, _screen)));
    else if (!hasWindow)
        viewer.setUpViewOnSingleScreen(static_cast<unsigned int>(_screen));
    viewer.realize();
    osgViewer::Viewer::Windows windows;
    viewer.getWindows(windows);
    if (windows.empty()) throw std::runtime_error("no window can be opened; is DISPLAY set?");
}

bool hasOsgOptionString() {
    const osgDB::Options* const options = osgDB::Registry::instance()->getOptions();
    return options && !options->getOptionString().empty();
}

} // namespace example
