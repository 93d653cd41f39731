// SPDX-License-Identifier: GPL-3.0-or-later
#include "SurfaceMaterial.h"

#include <osg/AlphaFunc>
#include <osg/Material>

#include <algorithm>
#include <cmath>

namespace bake {

SurfaceMaterial SurfaceMaterial::of(const Surface& surface) {
    SurfaceMaterial material;
    const osg::StateSet& state = *surface.state;
    const auto* attribute =
        dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL));
    material.vertexColours =
        !surface.colours.empty() &&
        (attribute == nullptr || attribute->getColorMode() != osg::Material::OFF);
    if (attribute != nullptr) {
        material.diffuse = attribute->getDiffuse(osg::Material::FRONT);
        material.specular = attribute->getSpecular(osg::Material::FRONT);
        material.emission = attribute->getEmission(osg::Material::FRONT);
        material.shininess = attribute->getShininess(osg::Material::FRONT);
    }
    if (material.vertexColours) material.diffuse = {1.0f, 1.0f, 1.0f, 1.0f};
    const auto* texture = dynamic_cast<const osg::Texture*>(
        state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    if (texture != nullptr && !surface.texCoords.empty()) {
        material.image = texture->getImage(0);
        material.wrapS = texture->getWrap(osg::Texture::WRAP_S);
        material.wrapT = texture->getWrap(osg::Texture::WRAP_T);
    }
    material.twoSided = (state.getMode(GL_CULL_FACE) & osg::StateAttribute::ON) == 0;
    const auto* test =
        dynamic_cast<const osg::AlphaFunc*>(state.getAttribute(osg::StateAttribute::ALPHAFUNC));
    if ((state.getMode(GL_BLEND) & osg::StateAttribute::ON) != 0) {
        material.alpha = Alpha::Blend;
    } else if (test != nullptr) {
        material.alpha = Alpha::Mask;
        material.alphaCutOff = test->getReferenceValue();
    }
    return material;
}

std::vector<osg::Vec4> vertexColoursOf(const std::vector<Surface>& surfaces,
                                       const osgSkin::SkinMesh& mesh) {
    std::vector<osg::Vec4> result;
    for (const Surface& surface : surfaces) {
        if (!SurfaceMaterial::of(surface).vertexColours) continue;
        result.resize(mesh.positions.size(), {1.0f, 1.0f, 1.0f, 1.0f});
        for (std::size_t v = 0; v < surface.colours.size(); ++v)
            for (unsigned k = 0; k < 4; ++k)
                result[surface.sourceVertex[v]][k] = std::clamp(surface.colours[v][k], 0.0f, 1.0f);
    }
    return result;
}

osg::Vec4 linear(const osg::Vec4& srgb) {
    osg::Vec4 result = srgb;
    for (unsigned k = 0; k < 3; ++k) {
        const float value = srgb[k];
        result[k] = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
    }
    return result;
}

} // namespace bake
