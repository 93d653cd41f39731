// SPDX-License-Identifier: MIT
#include "Tiles.h"

#include <iostream>

namespace figures {

Tile tiled(const std::vector<Tile>& tiles, std::size_t columns) {
    const int width = tiles.front()->s();
    const int height = tiles.front()->t();
    const std::size_t rows = (tiles.size() + columns - 1) / columns;
    Tile sheet = new osg::Image;
    sheet->allocateImage(width * int(columns), height * int(rows), 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (std::size_t i = 0; i < tiles.size(); ++i)
        sheet->copySubImage(width * int(i % columns), height * int(rows - 1 - i / columns), 0,
                            tiles[i]); // images have their origin at the lower left
    return sheet;
}

Tile photograph(osg::Node* scene, const example::View& view, int width, int height) {
    return example::Snapshots(scene, view, width, height).take(0.0);
}

void writePicture(const osg::Image& image, const std::string& file) {
    example::writePicture(image, file);
    std::cout << file << std::endl;
}

} // namespace figures
