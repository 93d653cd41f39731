// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBAKE_SURFACE_H
#define OSGSKINBAKE_SURFACE_H

#include <osgSkinCharacter/Character>

#include <glm/vec3.hpp>
#include <osg/Image>
#include <osg/StateSet>
#include <osg/Texture>
#include <osg/Vec2>
#include <osg/Vec4>

#include <cstddef>
#include <cstdint>
#include <string>
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

/// A surface's material, as its state set has it. Colours are sRGB.
struct SurfaceMaterial {
    enum class Alpha { Opaque, Mask, Blend };

    osg::Vec4 diffuse{0.8f, 0.8f, 0.8f, 1.0f}; ///< white where the vertices have colours
    osg::Vec4 specular{0.0f, 0.0f, 0.0f, 1.0f};
    osg::Vec4 emission{0.0f, 0.0f, 0.0f, 1.0f};
    float shininess = 0.0f;               ///< Blinn's exponent
    osg::ref_ptr<const osg::Image> image; ///< of texture unit 0, where there are coordinates for it
    osg::Texture::WrapMode wrapS = osg::Texture::REPEAT, wrapT = osg::Texture::REPEAT;
    bool twoSided = true;
    bool vertexColours = false; ///< the surface's are to be used
    Alpha alpha = Alpha::Opaque;
    float alphaCutOff = 0.5f; ///< with Alpha::Mask

    static SurfaceMaterial of(const Surface& surface);
};

/// The colours of the mesh's vertices, white where a surface has none, clamped to 0..1; empty where
/// no surface uses any.
std::vector<osg::Vec4> vertexColoursOf(const std::vector<Surface>& surfaces,
                                       const osgSkin::SkinMesh& mesh);

/// An sRGB colour made linear; alpha is kept.
osg::Vec4 linear(const osg::Vec4& srgb);

/// The material library that goes with OBJ files called `pattern`: without their number and their
/// folder.
std::string libraryName(const std::string& pattern);

/// The name of a surface's material, in OBJ and glTF files.
std::string materialName(std::size_t surface);

/// Writes a material for each surface (.mtl). A texture that was read from a PNG or JPEG file is
/// named from where it is, others are written beside the library.
///
/// \param folder where file names of images are relative to
/// \throw osgSkin::Error where it cannot be written
void writeLibrary(const std::string& file, const std::vector<Surface>& surfaces,
                  const std::string& folder);

} // namespace bake

#endif
