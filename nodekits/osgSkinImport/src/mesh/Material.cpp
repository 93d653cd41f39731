// SPDX-License-Identifier: MIT
#include "mesh/Material.h"

#include "text/FileText.h"

#include <osgSkin/Error>
#include <osgSkinImport/FindNamedFile>

#include <osg/AlphaFunc>
#include <osg/CullFace>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <cstddef>

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
    tellOf(_path, what + " cannot be read; drawn without" + reason);
}

namespace {

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
std::string findPicture(const std::string& name, const std::string& folder,
                        const osgDB::Options* options) {
    std::string beside = osgDB::concatPaths(folder, name);
    if (!osgDB::isAbsolutePath(name) && osgDB::fileExists(beside)) return beside;
    std::string found = findNamedFile(name, options);
    if (!found.empty()) return found;
    std::string last = osgDB::concatPaths(folder, osgDB::getSimpleFileName(name));
    return osgDB::fileExists(last) ? last : std::string();
}

osg::ref_ptr<osg::Image> readImageFile(const std::string& name, const std::string& meshPath,
                                       const osgDB::Options* options, PictureReader& pictures) {
    osg::ref_ptr<osgDB::Options> local =
        options != nullptr ? options->cloneOptions() : new osgDB::Options;
    local->getDatabasePathList().push_front(osgDB::getFilePath(meshPath));
    const std::string fileName = osgDB::convertFileNameToNativeStyle(name);
    // Fetch nothing from a network, run nothing, and open regular files only: others may block
    // forever.
    if (osgDB::containsServerAddress(fileName) || !isOnlyRead(fileName)) return nullptr;
    const std::string found = findPicture(fileName, osgDB::getFilePath(meshPath), local);
    if (!isRegularFile(found)) return nullptr;
    return pictures.shared().once(found, {}, [&] {
        const osg::ref_ptr<osg::Image> image =
            pictures.readFile(found, [&]() -> osg::ref_ptr<osg::Image> {
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
    attribute->setEmission(osg::Material::FRONT_AND_BACK, material.emission);
    attribute->setShininess(osg::Material::FRONT_AND_BACK,
                            std::clamp(material.shininess, 0.0f, 128.0f));
    if (material.vertexColours) attribute->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    result->setAttributeAndModes(attribute);
    if (material.image.valid()) {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(material.image);
        texture->setWrap(osg::Texture::WRAP_S, material.wrapS);
        texture->setWrap(osg::Texture::WRAP_T, material.wrapT);
        result->setTextureAttributeAndModes(0, texture);
    }
    setSides(*result, material.twoSided.value_or(true));
    setAlpha(*result, material);
    return result;
}

osg::ref_ptr<osg::Image> readTexture(const std::string& name, const std::string& meshPath,
                                     const osgDB::Options* options, TextureReads& reads) {
    if (name.empty()) return nullptr;
    return reads.once(name,
                      [&] { return readImageFile(name, meshPath, options, reads.pictures()); });
}

} // namespace osgSkin
