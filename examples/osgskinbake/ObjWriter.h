// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "PosedMesh.h"
#include "Surface.h"

#include <osgSkinCharacter/Character>

#include <osg/Vec2>
#include <osg/Vec4>

#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

namespace bake {

/// Writes OBJ files of one body in its poses, with the mesh's own vertices and faces; texture
/// coordinates stand at the faces' corners. All share one material library.
class ObjWriter {
public:
    /// \param name of the OBJ files, with or without a place for a number: without it and with
    ///        .mtl at its end it is the library's, beside them
    ObjWriter(const osgSkin::Character& character, const std::string& name);

    /// Writes the posed vertices, and after the first ones of a folder the library, with textures
    /// beside it that are in no file of their own.
    /// \throw osgSkin::Error where it cannot
    void write(const std::string& file, const PosedMesh& posed);

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    void addSurface(const Surface& surface, std::uint32_t material);
    void writeFaces(std::FILE* out) const;

    const osgSkin::Character& _character;
    const osgSkin::SkinMesh& _mesh;
    std::string _library;
    std::set<std::string> _libraries; ///< that are written
    std::vector<Surface> _surfaces;
    std::vector<std::uint32_t> _materials; ///< one a face
    std::vector<osg::Vec2> _texCoords;
    std::vector<std::uint32_t> _texCoordOf; ///< one a corner: index in _texCoords, or kNone
    std::vector<std::size_t> _firstCorner;  ///< one a face
    std::vector<osg::Vec4> _colours;        ///< one a vertex of the mesh, or none
};

} // namespace bake
