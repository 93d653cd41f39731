// SPDX-License-Identifier: MIT
// Meshes read from a text, and the state and arrays of their parts.
#pragma once

#include "TextFile.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Array>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/Texture2D>

#include <string>

/// Reads a mesh file with this content.
inline osgSkin::ImportedMesh readMesh(const std::string& name, const std::string& content) {
    return osgSkin::importMesh(test::saveText(name, content));
}

inline const osg::Geometry& geometryOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return *mesh.parts.at(part).geometry;
}

inline const osg::Material& materialOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return dynamic_cast<const osg::Material&>(
        *geometryOf(mesh, part).getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
}

inline osg::Vec4 diffuseOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return materialOf(mesh, part).getDiffuse(osg::Material::FRONT);
}

inline osg::Vec4 emissionOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return materialOf(mesh, part).getEmission(osg::Material::FRONT);
}

/// The image of one of a part's textures; null if it has none.
inline const osg::Image* imageOf(const osgSkin::MeshPart& part, unsigned unit = 0) {
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        part.geometry->getStateSet()->getTextureAttribute(unit, osg::StateAttribute::TEXTURE));
    return texture != nullptr ? texture->getImage() : nullptr;
}

inline const osg::Vec3Array& normalsOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return dynamic_cast<const osg::Vec3Array&>(*geometryOf(mesh, part).getNormalArray());
}

inline const osg::Vec4Array& coloursOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return dynamic_cast<const osg::Vec4Array&>(*geometryOf(mesh, part).getColorArray());
}

inline const osg::Vec2Array& texCoordsOf(const osgSkin::ImportedMesh& mesh, std::size_t part = 0) {
    return dynamic_cast<const osg::Vec2Array&>(*geometryOf(mesh, part).getTexCoordArray(0));
}
