// SPDX-License-Identifier: MIT
#include "Materials.h"

#include <osg/Material>
#include <osg/Notify>
#include <osg/Texture2D>

#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>

namespace osgSkin {

osg::ref_ptr<osg::StateSet> makeStateSet(const Look& look) {
    osg::ref_ptr<osg::StateSet> result = new osg::StateSet;
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, look.diffuse);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, look.diffuse);
    material->setSpecular(osg::Material::FRONT_AND_BACK, look.specular);
    material->setEmission(osg::Material::FRONT_AND_BACK, look.emission);
    material->setShininess(osg::Material::FRONT_AND_BACK, std::clamp(look.shininess, 0.0f, 128.0f));
    result->setAttributeAndModes(material);
    if (look.image.valid()) {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(look.image);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
        result->setTextureAttributeAndModes(0, texture);
    }
    if (look.diffuse.a() < 1.0f) {
        result->setMode(GL_BLEND, osg::StateAttribute::ON);
        result->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    }
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
