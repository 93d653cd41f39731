// SPDX-License-Identifier: MIT
#pragma once

#include "Snapshots.h"

#include <vector>

namespace figures {

using Tile = osg::ref_ptr<osg::Image>;

/// Pictures of one size as one: rows of `columns`, the first at the upper left.
Tile tiled(const std::vector<Tile>& tiles, std::size_t columns);

Tile photograph(osg::Node* scene, const example::View& view, int width, int height);

/// \throw std::runtime_error where it cannot be written
void writePicture(const osg::Image& image, const std::string& file);

} // namespace figures
