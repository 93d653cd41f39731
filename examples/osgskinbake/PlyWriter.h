// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "PosedMesh.h"

#include <osgSkinCharacter/Character>

#include <osg/Vec4>

#include <string>
#include <vector>

namespace bake {

/// Writes PLY files of one body in its poses, as bytes: vertices, normals, colours where the body
/// has them, and the mesh's own faces.
class PlyWriter {
public:
    explicit PlyWriter(const osgSkin::Character& character);

    /// Writes the posed vertices.
    /// \throw osgSkin::Error where it cannot
    void write(const std::string& file, const PosedMesh& posed) const;

private:
    const osgSkin::SkinMesh& _mesh;
    std::vector<osg::Vec4> _colours; ///< one a vertex of the mesh, or none
};

} // namespace bake
