// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_MATERIAL_H
#define OSGSKINIMPORT_MESH_MATERIAL_H

#include "mesh/Images.h"

#include <osg/Image>
#include <osg/StateSet>
#include <osg/Texture>
#include <osg/Vec4>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace osgSkin {

/// The textures that a file names. Each is read once, however many materials share it. The
/// destructor reports all textures that could not be read in one notice.
class TextureReads {
public:
    /// \param path of the file that names the textures
    /// \param options with limits for all textures together; may be null
    TextureReads(std::string path, const osgDB::Options* options)
        : _path(std::move(path)), _imageReader(options) {}
    ~TextureReads();
    TextureReads(const TextureReads&) = delete;
    TextureReads& operator=(const TextureReads&) = delete;

    /// The texture called `name`; null if it cannot be read.
    /// \param name of the texture
    /// \param read is called once; returns null if it fails, or throws osgSkin::Error with the
    ///        reason
    osg::ref_ptr<osg::Image> once(const std::string& name,
                                  const std::function<osg::ref_ptr<osg::Image>()>& read);

    /// The reader for all of them.
    ImageReader& imageReader() { return _imageReader; }

private:
    const std::string _path;
    ImageReader _imageReader;
    std::map<std::string, osg::ref_ptr<osg::Image>> _images; ///< by name
    std::map<std::string, std::string> _reasons;             ///< why images are missing, if known
};

/// The properties of a part's material that the file formats share. Colours are in sRGB.
struct Material {
    enum class Alpha { ByOpacity, Opaque, Mask, Blend }; ///< ByOpacity: blended below 1
    /// The property that a texture gives; also its texture unit.
    enum Map : unsigned int { Diffuse, Normal, Occlusion, Emission };
    static constexpr std::size_t kMaps = 4;
    struct Texture {
        osg::ref_ptr<osg::Image> image; ///< null if there is none
        osg::Texture::WrapMode wrapS = osg::Texture::REPEAT, wrapT = osg::Texture::REPEAT;
    };

    osg::Vec4 diffuse{0.8f, 0.74f, 0.68f, 1.0f}; ///< neutral skin, for files without materials
    osg::Vec4 specular{0.1f, 0.1f, 0.1f, 1.0f};
    osg::Vec4 emission{0.0f, 0.0f, 0.0f, 1.0f};
    float shininess = 16.0f; ///< 0..128
    /// One for each kind of map. All use the same texture coordinates.
    std::array<Texture, kMaps> textures;
    float normalScale = 1.0f;       ///< of the normal map's x and y
    float occlusionStrength = 1.0f; ///< 0: no occlusion
    std::optional<bool> twoSided;   ///< if unset, both sides are drawn and lit
    Alpha alpha = Alpha::ByOpacity;
    float alphaCutOff = 0.5f;   ///< with Alpha::Mask
    bool vertexColours = false; ///< vertex colours replace `diffuse`
};

/// A component of a linear colour in sRGB.
float toSrgb(float linear);

/// Makes a state set with an osg::Material, the textures on the units of their maps, and blending
/// or an alpha test if it is transparent. Back faces are culled if the material is single-sided.
///
/// With a normal, occlusion or emission map it has a program in GLSL 1.20, which lights each pixel
/// from light 0 by OpenGL's fixed states. Tangents are the vertex attribute
/// MeshPart::kTangentAttribute; a normal map's green points along increasing v. Occlusion darkens
/// ambient light only. Without a program (or where a driver has none) the fixed pipeline draws the
/// diffuse texture.
osg::ref_ptr<osg::StateSet> makeStateSet(const Material& material);

/// Whether makeStateSet() has made this for a material with a normal map, also if it comes from a
/// saved scene.
bool hasNormalMap(const osg::StateSet& state);

/// Reports textures that are not drawn in one notice; none if `counts` is empty.
/// \param path of the file
/// \param counts number of textures by kind, in the file's own words
void warnUnusedTextures(const std::string& path, const std::map<std::string, std::size_t>& counts);

/// Reads a texture that the mesh file `meshPath` names; null if it cannot be read.
/// \param name of the texture
/// \param meshPath the mesh file
/// \param options may be null
/// \param reads of that file's textures
osg::ref_ptr<osg::Image> readTexture(const std::string& name, const std::string& meshPath,
                                     const osgDB::Options* options, TextureReads& reads);

} // namespace osgSkin

#endif
