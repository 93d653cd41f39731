// SPDX-License-Identifier: MIT
#include "mesh/Material.h"

#include "files/FileText.h"

#include <osgSkin/Error>
#include <osgSkinImport/FindNamedFile>
#include <osgSkinRig/MeshPart>

#include <osg/AlphaFunc>
#include <osg/CullFace>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Program>
#include <osg/Shader>
#include <osg/Texture2D>
#include <osg/Uniform>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <mutex>

namespace osgSkin {

osg::ref_ptr<osg::Image> TextureReads::once(const std::string& name,
                                            const std::function<osg::ref_ptr<osg::Image>()>& read) {
    const auto [entry, isNew] = _images.emplace(name, nullptr);
    if (!isNew) return entry->second;
    try {
        entry->second = read();
    } catch (const Error& error) {
        _reasons[name] = error.what();
    }
    return entry->second;
}

TextureReads::~TextureReads() {
    std::size_t missing = 0;
    std::string first;
    for (const auto& [name, image] : _images) {
        if (image.valid()) continue;
        if (missing++ == 0) first = name;
    }
    if (missing == 0) return;
    std::string reason;
    if (!_reasons.empty()) {
        first = _reasons.begin()->first;
        reason = ": " + _reasons.begin()->second;
    }
    std::string what = "texture \"" + first + '"';
    if (missing > 1) what = std::to_string(missing) + " textures, \"" + first + "\" among them,";
    warn(_path, what + " cannot be read; drawn without" + reason);
}

namespace {

// A picture of neutral maps is that of the fixed pipeline, but for the highlight, which is computed
// in each pixel: light 0, without a spot, and a viewer at infinity.
const char* const kVertex = R"(
varying vec3 osgSkinPosition, osgSkinNormal;
varying vec4 osgSkinColour;
varying vec2 osgSkinTexture;
#ifdef OSGSKIN_NORMAL_MAP
attribute vec4 osgSkinTangent;
varying vec3 osgSkinAlongU, osgSkinAlongV;

vec3 osgSkin_direction(vec3 v) {
  vec3 moved = (gl_ModelViewMatrix * vec4(v, 0.0)).xyz;
  return moved / max(length(moved), 1e-30); // 0 in a mesh without tangents
}
#endif

void main() {
  osgSkinPosition = (gl_ModelViewMatrix * gl_Vertex).xyz;
  osgSkinNormal = normalize(gl_NormalMatrix * gl_Normal);
  osgSkinColour = gl_Color;
  osgSkinTexture = (gl_TextureMatrix[0] * gl_MultiTexCoord0).xy;
#ifdef OSGSKIN_NORMAL_MAP
  osgSkinAlongU = osgSkin_direction(osgSkinTangent.xyz);
  osgSkinAlongV = osgSkin_direction(cross(gl_Normal, osgSkinTangent.xyz) * osgSkinTangent.w);
#endif
  gl_Position = ftransform();
}
)";

const char* const kFragment = R"(
varying vec3 osgSkinPosition, osgSkinNormal;
varying vec4 osgSkinColour;
varying vec2 osgSkinTexture;
#ifdef OSGSKIN_DIFFUSE_MAP
uniform sampler2D osgSkinDiffuseMap;
#endif
#ifdef OSGSKIN_NORMAL_MAP
uniform sampler2D osgSkinNormalMap;
uniform float osgSkinNormalScale;
varying vec3 osgSkinAlongU, osgSkinAlongV;
#endif
#ifdef OSGSKIN_OCCLUSION_MAP
uniform sampler2D osgSkinOcclusionMap;
uniform float osgSkinOcclusionStrength;
#endif
#ifdef OSGSKIN_EMISSION_MAP
uniform sampler2D osgSkinEmissionMap;
uniform vec3 osgSkinEmission;
#endif

void main() {
  vec3 normal = normalize(osgSkinNormal);
#ifdef OSGSKIN_NORMAL_MAP
  vec3 bump = 2.0 * texture2D(osgSkinNormalMap, osgSkinTexture).xyz - 1.0;
  bump.xy *= osgSkinNormalScale;
  normal = normalize(bump.x * osgSkinAlongU + bump.y * osgSkinAlongV + bump.z * normal);
#endif
  if (!gl_FrontFacing) normal = -normal;

#ifdef OSGSKIN_VERTEX_COLOURS
  vec4 ambient = osgSkinColour, diffuse = osgSkinColour;
#else
  vec4 ambient = gl_FrontMaterial.ambient, diffuse = gl_FrontMaterial.diffuse;
#endif
  vec4 place = gl_LightSource[0].position;
  vec3 toLight = place.w == 0.0 ? place.xyz : place.xyz / place.w - osgSkinPosition;
  float span = length(toLight);
  float reach = place.w == 0.0 ? 1.0
                               : 1.0 / (gl_LightSource[0].constantAttenuation +
                                        span * (gl_LightSource[0].linearAttenuation +
                                                span * gl_LightSource[0].quadraticAttenuation));
  toLight /= span;
  float facing = max(dot(normal, toLight), 0.0);
  float shine = max(dot(normal, normalize(toLight + vec3(0.0, 0.0, 1.0))), 1e-6);
  vec3 direct = facing * diffuse.rgb * gl_LightSource[0].diffuse.rgb;
  if (facing > 0.0)
    direct += pow(shine, gl_FrontMaterial.shininess) * gl_FrontLightProduct[0].specular.rgb;
  vec3 indirect = gl_LightModel.ambient.rgb + reach * gl_LightSource[0].ambient.rgb;
#ifdef OSGSKIN_OCCLUSION_MAP
  float open = texture2D(osgSkinOcclusionMap, osgSkinTexture).r;
  indirect *= 1.0 + osgSkinOcclusionStrength * (open - 1.0);
#endif
  vec4 colour = vec4(min(ambient.rgb * indirect + reach * direct, 1.0), diffuse.a);
#ifdef OSGSKIN_DIFFUSE_MAP
  colour *= texture2D(osgSkinDiffuseMap, osgSkinTexture);
#endif
  vec3 glow = gl_FrontMaterial.emission.rgb;
#ifdef OSGSKIN_EMISSION_MAP
  glow += osgSkinEmission * texture2D(osgSkinEmissionMap, osgSkinTexture).rgb;
#endif
  gl_FragColor = vec4(colour.rgb + glow, colour.a);
}
)";

constexpr const char* kDefines[] = {"OSGSKIN_DIFFUSE_MAP", "OSGSKIN_NORMAL_MAP",
                                    "OSGSKIN_OCCLUSION_MAP", "OSGSKIN_EMISSION_MAP",
                                    "OSGSKIN_VERTEX_COLOURS"};
constexpr const char* kSamplers[] = {"osgSkinDiffuseMap", "osgSkinNormalMap", "osgSkinOcclusionMap",
                                     "osgSkinEmissionMap"};

/// The program for materials with the same maps, which share it. (Defines of state sets would
/// select the same from one program, but OSG cannot read them in .osgx files.)
/// \param defined which of `kDefines`
osg::ref_ptr<osg::Program> mapProgram(std::bitset<std::size(kDefines)> defined) {
    static std::mutex mutex;
    // Never deleted: contexts may be gone when a process ends.
    static auto& programs = *new std::map<unsigned long, osg::ref_ptr<osg::Program>>;
    const std::lock_guard<std::mutex> lock(mutex);
    osg::ref_ptr<osg::Program>& program = programs[defined.to_ulong()];
    if (program) return program;
    std::string head = "#version 120\n";
    for (std::size_t d = 0; d < defined.size(); ++d)
        if (defined[d]) head += std::string("#define ") + kDefines[d] + "\n";
    program = new osg::Program;
    program->setName("osgSkin maps");
    program->addShader(new osg::Shader(osg::Shader::VERTEX, head + kVertex));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, head + kFragment));
    program->addBindAttribLocation("osgSkinTangent", MeshPart::kTangentAttribute);
    return program;
}

/// Adds the textures, and the program where one of them needs it.
void setTextures(osg::StateSet& state, const Material& material) {
    std::bitset<std::size(kDefines)> defined;
    for (unsigned int unit = 0; unit < Material::kMaps; ++unit) {
        const Material::Texture& from = material.textures[unit];
        if (!from.image) continue;
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(from.image);
        texture->setWrap(osg::Texture::WRAP_S, from.wrapS);
        texture->setWrap(osg::Texture::WRAP_T, from.wrapT);
        // The fixed pipeline would multiply all textures whose mode is on.
        if (unit == Material::Diffuse)
            state.setTextureAttributeAndModes(unit, texture);
        else
            state.setTextureAttribute(unit, texture);
        defined.set(unit);
    }
    if ((defined >> 1).none()) return;
    for (unsigned int unit = 0; unit < Material::kMaps; ++unit)
        if (defined[unit])
            state.addUniform(new osg::Uniform(kSamplers[unit], static_cast<int>(unit)));
    if (material.vertexColours) defined.set(Material::kMaps);
    state.setAttribute(mapProgram(defined));
    state.addUniform(new osg::Uniform("osgSkinNormalScale", material.normalScale));
    state.addUniform(new osg::Uniform("osgSkinOcclusionStrength", material.occlusionStrength));
    const osg::Vec4& glow = material.emission;
    state.addUniform(new osg::Uniform("osgSkinEmission", osg::Vec3(glow.r(), glow.g(), glow.b())));
}

void setSides(osg::StateSet& state, bool two) {
    if (two) {
        const osg::ref_ptr<osg::LightModel> light = new osg::LightModel;
        light->setTwoSided(true);
        state.setAttributeAndModes(light);
    } else {
        state.setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
    }
}

void setAlpha(osg::StateSet& state, const Material& material) {
    if (material.alpha == Material::Alpha::Mask)
        state.setAttributeAndModes(
            new osg::AlphaFunc(osg::AlphaFunc::GEQUAL, material.alphaCutOff));
    const bool transparent =
        material.alpha == Material::Alpha::ByOpacity && material.diffuse.a() < 1.0f;
    if (!transparent && material.alpha != Material::Alpha::Blend) return;
    state.setMode(GL_BLEND, osg::StateAttribute::ON);
    state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
}

/// Searches for an image relative to the mesh's folder, then as OSG does, then by its base name in
/// the mesh's folder, because names often contain folders of another machine.
std::string findImage(const std::string& name, const std::string& folder,
                      const osgDB::Options* options) {
    std::string beside = osgDB::concatPaths(folder, name);
    if (!osgDB::isAbsolutePath(name) && osgDB::fileExists(beside)) return beside;
    std::string found = findNamedFile(name, options);
    if (!found.empty()) return found;
    std::string last = osgDB::concatPaths(folder, osgDB::getSimpleFileName(name));
    return osgDB::fileExists(last) ? last : std::string();
}

osg::ref_ptr<osg::Image> readImageFile(const std::string& name, const std::string& meshPath,
                                       const osgDB::Options* options, ImageReader& imageReader) {
    osg::ref_ptr<osgDB::Options> local =
        options != nullptr ? options->cloneOptions() : new osgDB::Options;
    local->getDatabasePathList().push_front(osgDB::getFilePath(meshPath));
    const std::string fileName = osgDB::convertFileNameToNativeStyle(name);
    // Fetch nothing from a network, run nothing, and open regular files only: others may block
    // forever.
    if (osgDB::containsServerAddress(fileName) || !isOnlyRead(fileName)) return nullptr;
    const std::string found = findImage(fileName, osgDB::getFilePath(meshPath), local);
    if (!isRegularFile(found)) return nullptr;
    return imageReader.shared().once(found, {}, [&] {
        const osg::ref_ptr<osg::Image> image =
            imageReader.readFile(found, [&]() -> osg::ref_ptr<osg::Image> {
                // osgDB::readImageFile() would print a warning for each.
                return osgDB::Registry::instance()->readImage(found, local).getImage();
            });
        if (image) image->setFileName(fileName); // for writers
        return image;
    });
}

} // namespace

float toSrgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

osg::ref_ptr<osg::StateSet> makeStateSet(const Material& material) {
    osg::ref_ptr<osg::StateSet> result = new osg::StateSet;
    osg::ref_ptr<osg::Material> attribute = new osg::Material;
    attribute->setAmbient(osg::Material::FRONT_AND_BACK, material.diffuse);
    attribute->setDiffuse(osg::Material::FRONT_AND_BACK, material.diffuse);
    attribute->setSpecular(osg::Material::FRONT_AND_BACK, material.specular);
    // With a map, the colour alone would make the whole surface glow: the program has it.
    const bool glowsByMap = material.textures[Material::Emission].image.valid();
    attribute->setEmission(osg::Material::FRONT_AND_BACK,
                           glowsByMap ? Material().emission : material.emission);
    attribute->setShininess(osg::Material::FRONT_AND_BACK,
                            std::clamp(material.shininess, 0.0f, 128.0f));
    if (material.vertexColours) attribute->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    result->setAttributeAndModes(attribute);
    setTextures(*result, material);
    setSides(*result, material.twoSided.value_or(true));
    setAlpha(*result, material);
    return result;
}

bool hasNormalMap(const osg::StateSet& state) {
    return state.getUniform(kSamplers[Material::Normal]) != nullptr;
}

void warnUnusedTextures(const std::string& path, const std::map<std::string, std::size_t>& counts) {
    constexpr std::size_t kMaxKinds = 20, kMaxLength = 60;
    std::string list;
    std::size_t kinds = 0;
    for (const auto& [kind, count] : counts) {
        if (kinds++ == kMaxKinds) {
            list += " and others";
            break;
        }
        list += (list.empty() ? "" : ", ") + kind.substr(0, kMaxLength) + " (" +
                std::to_string(count) + ")";
    }
    if (!list.empty()) warn(path, "textures left out: " + list);
}

osg::ref_ptr<osg::Image> readTexture(const std::string& name, const std::string& meshPath,
                                     const osgDB::Options* options, TextureReads& reads) {
    if (name.empty()) return nullptr;
    return reads.once(name,
                      [&] { return readImageFile(name, meshPath, options, reads.imageReader()); });
}

} // namespace osgSkin
