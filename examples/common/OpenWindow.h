// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/Viewer>

namespace example {

/// Opens a viewer's window. OpenSceneGraph's own run() takes none for one that has been closed.
/// \throw std::runtime_error where none can be opened
void openWindow(osgViewer::Viewer& viewer);

} // namespace example
