// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_MATERIAL_H
#define OSGSKINIMPORT_MESH_MATERIAL_H

#include "mesh/Pictures.h"

#include <osg/Image>
#include <osg/StateSet>
#include <osg/Texture>
#include <osg/Vec4>
#include <osg/ref_ptr>
#include <osgDB/Options>

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
        : _path(std::move(path)), _pictures(options) {}
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
    PictureReader& pictures() { return _pictures; }

private:
    const std::string _path;
    PictureReader _pictures;
    std::map<std::string, osg::ref_ptr<osg::Image>> _images; ///< by name
    std::map<std::string, std::string> _reasons;             ///< why images are missing, if known
};

/// The properties of a part's material that the file formats share. Colours are in sRGB.
struct Material {
    enum class Alpha { ByOpacity, Opaque, Mask, Blend }; ///< ByOpacity: blended below 1

    osg::Vec4 diffuse{0.8f, 0.74f, 0.68f, 1.0f}; ///< neutral skin, for files without materials
    osg::Vec4 specular{0.1f, 0.1f, 0.1f, 1.0f};
    osg::Vec4 emission{0.0f, 0.0f, 0.0f, 1.0f};
    float shininess = 16.0f;        ///< 0..128
    osg::ref_ptr<osg::Image> image; ///< of the diffuse texture, if any
    osg::Texture::WrapMode wrapS = osg::Texture::REPEAT, wrapT = osg::Texture::REPEAT;
    std::optional<bool> twoSided; ///< if unset, both sides are drawn and lit
    Alpha alpha = Alpha::ByOpacity;
    float alphaCutOff = 0.5f;   ///< with Alpha::Mask
    bool vertexColours = false; ///< vertex colours replace `diffuse`
};

/// A component of a linear colour in sRGB.
float toSrgb(float linear);

/// Makes a state set with an osg::Material, the texture on unit 0, and blending or an alpha test if
/// it is transparent. Back faces are culled if the material is single-sided.
osg::ref_ptr<osg::StateSet> makeStateSet(const Material& material);

/// Reads a texture that the mesh file `meshPath` names; null if it cannot be read.
/// \param name of the texture
/// \param meshPath the mesh file
/// \param options may be null
/// \param reads of that file's textures
osg::ref_ptr<osg::Image> readTexture(const std::string& name, const std::string& meshPath,
                                     const osgDB::Options* options, TextureReads& reads);

} // namespace osgSkin

#endif
