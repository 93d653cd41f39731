// SPDX-License-Identifier: MIT
#include "mesh/Materials.h"

#include <osg/AlphaFunc>
#include <osg/CullFace>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Notify>
#include <osg/Texture2D>

#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>

namespace osgSkin {

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

void setAlpha(osg::StateSet& state, const Look& look) {
    if (look.alpha == Look::Alpha::Mask)
        state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GEQUAL, look.alphaCutOff));
    const bool transparent = look.alpha == Look::Alpha::ByOpacity && look.diffuse.a() < 1.0f;
    if (!transparent && look.alpha != Look::Alpha::Blend) return;
    state.setMode(GL_BLEND, osg::StateAttribute::ON);
    state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
}

} // namespace

osg::ref_ptr<osg::StateSet> makeStateSet(const Look& look) {
    osg::ref_ptr<osg::StateSet> result = new osg::StateSet;
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, look.diffuse);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, look.diffuse);
    material->setSpecular(osg::Material::FRONT_AND_BACK, look.specular);
    material->setEmission(osg::Material::FRONT_AND_BACK, look.emission);
    material->setShininess(osg::Material::FRONT_AND_BACK, std::clamp(look.shininess, 0.0f, 128.0f));
    if (look.vertexColours) material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    result->setAttributeAndModes(material);
    if (look.image.valid()) {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(look.image);
        texture->setWrap(osg::Texture::WRAP_S, look.wrapS);
        texture->setWrap(osg::Texture::WRAP_T, look.wrapT);
        result->setTextureAttributeAndModes(0, texture);
    }
    setSides(*result, look.twoSided.value_or(true));
    setAlpha(*result, look);
    return result;
}

osg::ref_ptr<osg::Image> readTexture(const std::string& name, const std::string& meshPath,
                                     const osgDB::Options* options) {
    if (name.empty()) return nullptr;
    osg::ref_ptr<osgDB::Options> local =
        options != nullptr ? options->cloneOptions() : new osgDB::Options;
    local->getDatabasePathList().push_front(osgDB::getFilePath(meshPath));
    const std::string fileName = osgDB::convertFileNameToNativeStyle(name);
    osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(fileName, local);
    if (!image)
        OSG_NOTICE << meshPath << ": texture \"" << name << "\" cannot be read; drawn without"
                   << std::endl;
    return image;
}

} // namespace osgSkin
