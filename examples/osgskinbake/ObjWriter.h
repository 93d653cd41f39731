// SPDX-License-Identifier: MIT
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

/// Writes OBJ files of a body's poses, with the mesh's own vertices and faces, and texture
/// coordinates per corner. All files share one material library.
class ObjWriter {
public:
    /// \param character the body; must outlive the writer
    /// \param name of the OBJ files, with or without a placeholder for a number; the library's name
    ///        is derived from it, see libraryName()
    ObjWriter(const osgSkin::Character& character, const std::string& name);

    /// Writes a file. After the first file in a folder, also writes the library, and the textures
    /// that have no file of their own.
    /// \throw osgSkin::Error if a file cannot be written
    void write(const std::string& file, const PosedMesh& posed);

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    void addSurface(const Surface& surface, std::uint32_t material);
    void writeFaces(std::FILE* out) const;

    const osgSkin::Character& _character;
    const osgSkin::SkinMesh& _mesh;
    std::string _library;
    std::set<std::string> _libraries; ///< already written
    std::vector<Surface> _surfaces;
    std::vector<std::uint32_t> _materials; ///< one per face
    std::vector<osg::Vec2> _texCoords;
    std::vector<std::uint32_t> _texCoordOf; ///< one per corner: index in _texCoords, or kNone
    std::vector<std::size_t> _firstCorner;  ///< one per face
    std::vector<osg::Vec4> _colours;        ///< one per vertex of the mesh, or empty
};

} // namespace bake
