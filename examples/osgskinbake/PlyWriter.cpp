// SPDX-License-Identifier: GPL-3.0-or-later
#include "PlyWriter.h"

#include "Bytes.h"
#include "SurfaceMaterial.h"

#include <cmath>

namespace bake {

PlyWriter::PlyWriter(const osgSkin::Character& character)
    : _mesh(character.body.mesh), _colours(vertexColoursOf(surfacesOf(character), _mesh)) {}

void PlyWriter::write(const std::string& file, const PosedMesh& posed) const {
    Bytes bytes;
    bytes.data = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                 std::to_string(posed.positions.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
        bytes.data += std::string("property float ") + name + "\n";
    if (!_colours.empty())
        for (const char* name : {"red", "green", "blue", "alpha"})
            bytes.data += std::string("property uchar ") + name + "\n";
    bytes.data += "element face " + std::to_string(_mesh.faceSizes.size()) +
                  "\nproperty list uint uint vertex_indices\nend_header\n";
    for (std::size_t v = 0; v < posed.positions.size(); ++v) {
        bytes.add(posed.positions[v]);
        bytes.add(posed.normals[v]);
        for (unsigned k = 0; k < 4 && !_colours.empty(); ++k)
            bytes.add(static_cast<std::uint8_t>(std::lround(_colours[v][k] * 255.0f)));
    }
    std::size_t corner = 0;
    for (const std::uint32_t size : _mesh.faceSizes) {
        bytes.add(size);
        for (std::uint32_t k = 0; k < size; ++k) bytes.add(_mesh.faceVertices[corner++]);
    }
    writeBytes(file, bytes.data);
}

} // namespace bake
