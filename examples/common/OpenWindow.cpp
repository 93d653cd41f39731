// SPDX-License-Identifier: MIT
#include "OpenWindow.h"

#include <stdexcept>

namespace example {

void openWindow(osgViewer::Viewer& viewer) {
    viewer.realize();
    if (!viewer.isRealized()) throw std::runtime_error("no window can be opened; is DISPLAY set?");
}

} // namespace example
