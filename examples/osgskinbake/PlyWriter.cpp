// SPDX-License-Identifier: GPL-3.0-or-later
#include "PlyWriter.h"

#include "Bytes.h"

namespace bake {

void writePly(const std::string& file, const osgSkin::SkinMesh& mesh, const PosedMesh& posed) {
    Bytes bytes;
    bytes.data = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                 std::to_string(posed.positions.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
        bytes.data += std::string("property float ") + name + "\n";
    bytes.data += "element face " + std::to_string(mesh.faceSizes.size()) +
                  "\nproperty list uint uint vertex_indices\nend_header\n";
    for (std::size_t v = 0; v < posed.positions.size(); ++v) {
        bytes.add(posed.positions[v]);
        bytes.add(posed.normals[v]);
    }
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        bytes.add(size);
        for (std::uint32_t k = 0; k < size; ++k) bytes.add(mesh.faceVertices[corner++]);
    }
    writeBytes(file, bytes.data);
}

} // namespace bake
