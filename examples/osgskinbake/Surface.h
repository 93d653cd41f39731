// SPDX-License-Identifier: MIT
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

/// The triangles of one material, from skins and rigid parts, in the order of the mesh's faces.
/// Vertices are in the mesh's order, and duplicated where normals, texture coordinates or colours
/// differ.
struct Surface {
    /// The drawable of a vertex, counting first skins and then rigid parts, and its index there.
    struct Drawn {
        std::uint32_t piece = 0, vertex = 0;
    };
    osg::ref_ptr<osg::StateSet> state;
    std::vector<std::uint32_t> sourceVertex; ///< the mesh's vertex, one per vertex
    std::vector<Drawn> drawn;                ///< one per vertex
    std::vector<glm::dvec3> restNormals;     ///< one per vertex, unit, in rest space
    std::vector<osg::Vec2> texCoords;        ///< one per vertex, from the lower left; or empty
    std::vector<osg::Vec4> colours;          ///< one per vertex, sRGB; or empty
    std::vector<std::uint32_t> triangles;    ///< three vertices each
    std::vector<std::uint32_t> sourceFace;   ///< the mesh's face, one per triangle

    /// Unit normals in the character's current pose, in rest space.
    std::vector<glm::dvec3> normals(const osgSkin::Character& character) const;
};

/// The surfaces of a character, one per material, in the order of the mesh's parts.
std::vector<Surface> surfacesOf(const osgSkin::Character& character);

/// A surface's material, read from its state set. Colours are sRGB.
struct SurfaceMaterial {
    enum class Alpha { Opaque, Mask, Blend };

    osg::Vec4 diffuse{0.8f, 0.8f, 0.8f, 1.0f}; ///< white if the vertices have colours
    osg::Vec4 specular{0.0f, 0.0f, 0.0f, 1.0f};
    osg::Vec4 emission{0.0f, 0.0f, 0.0f, 1.0f};
    float shininess = 0.0f;               ///< Blinn's exponent
    osg::ref_ptr<const osg::Image> image; ///< of texture unit 0, if it has texture coordinates
    osg::Texture::WrapMode wrapS = osg::Texture::REPEAT, wrapT = osg::Texture::REPEAT;
    bool twoSided = true;
    bool vertexColours = false; ///< uses Surface::colours
    Alpha alpha = Alpha::Opaque;
    float alphaCutOff = 0.5f; ///< with Alpha::Mask

    static SurfaceMaterial of(const Surface& surface);
};

/// The colours of the mesh's vertices, clamped to 0..1. White for surfaces without colours; empty
/// if no surface has any.
std::vector<osg::Vec4> vertexColoursOf(const std::vector<Surface>& surfaces,
                                       const osgSkin::SkinMesh& mesh);

/// Converts an sRGB colour to linear; alpha is unchanged.
osg::Vec4 linear(const osg::Vec4& srgb);

/// Name of the material library for OBJ files called `pattern`, without the number and the folder.
std::string libraryName(const std::string& pattern);

/// The name of a surface's material, in OBJ and glTF files.
std::string materialName(std::size_t surface);

/// Writes a material library (.mtl) with one material per surface. Textures from PNG or JPEG files
/// are referenced; others are written next to the library.
///
/// \param file path of the library
/// \param surfaces the surfaces
/// \param folder base of the images' relative file names
/// \throw osgSkin::Error if a file cannot be written
void writeLibrary(const std::string& file, const std::vector<Surface>& surfaces,
                  const std::string& folder);

} // namespace bake

#endif
