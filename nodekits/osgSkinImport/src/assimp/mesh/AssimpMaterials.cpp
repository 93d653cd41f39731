// SPDX-License-Identifier: MIT
#include "assimp/mesh/AssimpMaterials.h"
#include "text/FileText.h"

#include <assimp/GltfMaterial.h>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Whether a material's colours are linear, as in glTF; other formats hold sRGB.
bool isLinear(const aiMaterial& material) {
    aiString mode;
    return material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == AI_SUCCESS;
}

/// A linear colour in sRGB; alpha is kept.
glm::vec4 toSrgb(const glm::vec4& linear) {
    glm::vec4 result = linear;
    for (int k = 0; k < 3; ++k) {
        const float value = linear[k];
        result[k] =
            value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
    }
    return result;
}

osg::Vec4 colour(const aiMaterial& material, const char* key, unsigned type, unsigned index,
                 const osg::Vec4& otherwise) {
    aiColor4D value;
    if (material.Get(key, type, index, value) != AI_SUCCESS) return otherwise;
    glm::vec4 result(value.r, value.g, value.b, otherwise.a());
    if (isLinear(material)) result = toSrgb(result);
    return {result.r, result.g, result.b, result.a};
}

/// A texture that stands in the scene texel by texel, from the upper left, as in .mdl.
osg::ref_ptr<osg::Image> rawImage(const aiTexture& texture) {
    constexpr unsigned most = 1u << 14;
    if (texture.mWidth == 0 || texture.mWidth > most || texture.mHeight > most) return nullptr;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), 1,
                         GL_RGBA, GL_UNSIGNED_BYTE);
    const aiTexel* texel = texture.pcData;
    for (unsigned row = texture.mHeight; row > 0; --row) {
        unsigned char* to = image->data(0, row - 1);
        for (unsigned column = 0; column < texture.mWidth; ++column, ++texel)
            for (const unsigned char part : {texel->r, texel->g, texel->b, texel->a}) *to++ = part;
    }
    return image;
}

/// A texture that is packed into the scene's own file, as in .glb; null where it cannot be decoded.
osg::ref_ptr<osg::Image> embeddedImage(const aiTexture& texture, const std::string& path,
                                       PictureReader& pictures) {
    if (texture.mHeight != 0) return rawImage(texture);
    return pictures.read(path, texture.achFormatHint,
                         {reinterpret_cast<const char*>(texture.pcData), texture.mWidth});
}

osg::Texture::WrapMode wrapOf(const aiMaterial& material, const char* key) {
    int mode = aiTextureMapMode_Wrap;
    material.Get(key, aiTextureType_DIFFUSE, 0, mode);
    if (mode == aiTextureMapMode_Clamp) return osg::Texture::CLAMP_TO_EDGE;
    return mode == aiTextureMapMode_Mirror ? osg::Texture::MIRROR : osg::Texture::REPEAT;
}

/// What glTF says beyond the other formats.
void addGltf(const aiMaterial& source, Material& material) {
    aiString mode;
    source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
    const std::string alpha = mode.C_Str();
    material.alpha = alpha == "BLEND"  ? Material::Alpha::Blend
                     : alpha == "MASK" ? Material::Alpha::Mask
                                       : Material::Alpha::Opaque;
    source.Get(AI_MATKEY_GLTF_ALPHACUTOFF, material.alphaCutOff);
    aiColor4D base;
    if (source.Get(AI_MATKEY_BASE_COLOR, base) == AI_SUCCESS) material.diffuse.a() = base.a;
    bool twoSided = false;
    source.Get(AI_MATKEY_TWOSIDED, twoSided);
    material.twoSided = twoSided;
    float roughness = 1.0f;
    // The exponent of a highlight as wide; a rough surface has none.
    if (source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == AI_SUCCESS)
        material.shininess = 2.0f / std::max(1e-6f, std::pow(roughness, 4.0f)) - 2.0f;
    if (roughness >= 1.0f) material.specular = {0.0f, 0.0f, 0.0f, 1.0f};
}

/// Of a texture of emission the colour alone would make all of the surface glow.
bool glowsByTexture(const aiMaterial& source) {
    return source.GetTextureCount(aiTextureType_EMISSIVE) > 0 ||
           source.GetTextureCount(aiTextureType_EMISSION_COLOR) > 0;
}

Material readMaterial(const aiScene& scene, const aiMaterial& source, const std::string& path,
                      const osgDB::Options* options, TextureReads& reads) {
    Material material;
    material.diffuse = colour(source, AI_MATKEY_COLOR_DIFFUSE, material.diffuse);
    material.specular = colour(source, AI_MATKEY_COLOR_SPECULAR, material.specular);
    if (!glowsByTexture(source))
        material.emission = colour(source, AI_MATKEY_COLOR_EMISSIVE, material.emission);
    float opacity = 1.0f;
    if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS) material.diffuse.a() = opacity;
    source.Get(AI_MATKEY_SHININESS, material.shininess);
    if (isLinear(source)) addGltf(source, material);
    aiString name;
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &name) != AI_SUCCESS) return material;
    const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str());
    material.image = embedded == nullptr
                         ? readTexture(name.C_Str(), path, options, reads)
                         : reads.once(name.C_Str(), [&] {
                               return reads.pictures().shared().once(path, name.C_Str(), [&] {
                                   return embeddedImage(*embedded, path, reads.pictures());
                               });
                           });
    material.wrapS = wrapOf(source, _AI_MATKEY_MAPPINGMODE_U_BASE);
    material.wrapT = wrapOf(source, _AI_MATKEY_MAPPINGMODE_V_BASE);
    return material;
}

} // namespace

AssimpMaterials::AssimpMaterials(const aiScene& scene, const std::string& path,
                                 const osgDB::Options* options) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        _hasColours = _hasColours || scene.mMeshes[m]->HasVertexColors(0);
    TextureReads reads(path, options);
    std::size_t glowing = 0;
    for (unsigned m = 0; m < scene.mNumMaterials; ++m) {
        if (glowsByTexture(*scene.mMaterials[m])) ++glowing;
        _materials.push_back(readMaterial(scene, *scene.mMaterials[m], path, options, reads));
        _isLinear.push_back(isLinear(*scene.mMaterials[m]));
        int set = 0;
        scene.mMaterials[m]->Get(AI_MATKEY_UVWSRC_DIFFUSE(0), set);
        _texCoords.push_back(static_cast<unsigned>(std::max(set, 0)));
    }
    if (glowing > 0)
        tellOf(path, "textures of emission: " + std::to_string(glowing) +
                         ", left out, and that surfaces glow with them");
    _materials.emplace_back();
    _isLinear.push_back(false);
    _texCoords.push_back(0);
    for (Material& material : _materials) {
        material.vertexColours = _hasColours;
        _stateSets.push_back(makeStateSet(material));
    }
}

std::uint32_t AssimpMaterials::indexOf(const aiMesh& mesh) const {
    return static_cast<std::uint32_t>(
        std::min<std::size_t>(mesh.mMaterialIndex, _materials.size() - 1));
}

unsigned AssimpMaterials::texCoordsOf(const aiMesh& mesh) const {
    const unsigned set = _texCoords[indexOf(mesh)];
    return set < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.HasTextureCoords(set) ? set : 0;
}

glm::vec4 AssimpMaterials::colour(const aiMesh& mesh, unsigned vertex) const {
    const std::uint32_t index = indexOf(mesh);
    const osg::Vec4& diffuse = _materials[index].diffuse;
    const glm::vec4 plain(diffuse.r(), diffuse.g(), diffuse.b(), diffuse.a());
    if (!mesh.HasVertexColors(0)) return plain;
    const aiColor4D& c = mesh.mColors[0][vertex];
    const glm::vec4 own(c.r, c.g, c.b, c.a);
    if (_isLinear[index]) return toSrgb(own) * plain;
    return own * glm::vec4(1.0f, 1.0f, 1.0f, plain.a);
}

} // namespace osgSkin
