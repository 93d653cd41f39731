// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinCharacter/Character>

#include <osg/StateSet>
#include <osg/Vec2>
#include <osg/Vec4>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace bake {

/// What is drawn with one material: the skins' and the rigid parts' triangles together, in the
/// order of the mesh's faces. Vertices are the mesh's, in its order, with a copy wherever normals,
/// texture coordinates or colours differ.
struct Surface {
    /// Where a vertex is drawn: among the skins and then the rigid parts, and there.
    struct Drawn {
        std::uint32_t piece = 0, vertex = 0;
    };
    osg::ref_ptr<osg::StateSet> state;
    std::vector<std::uint32_t> sourceVertex; ///< of the mesh, one a vertex
    std::vector<Drawn> drawn;                ///< one a vertex
    std::vector<osg::Vec2> texCoords;        ///< one a vertex, from the lower left; or none
    std::vector<osg::Vec4> colours;          ///< one a vertex, sRGB; or none
    std::vector<std::uint32_t> triangles;    ///< three vertices each
    std::vector<std::uint32_t> sourceFace;   ///< of the mesh, one a triangle

    /// Unit normals in the pose that the character is in now, rest space.
    std::vector<glm::dvec3> normals(const osgSkin::Character& character) const;
};

/// One for each material, in the order of the mesh's parts.
std::vector<Surface> surfacesOf(const osgSkin::Character& character);

} // namespace bake
