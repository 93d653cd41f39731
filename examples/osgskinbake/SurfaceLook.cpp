// SPDX-License-Identifier: GPL-3.0-or-later
#include "SurfaceLook.h"

#include <osg/AlphaFunc>
#include <osg/Material>

#include <algorithm>
#include <cmath>

namespace bake {

SurfaceLook SurfaceLook::of(const Surface& surface) {
    SurfaceLook look;
    const osg::StateSet& state = *surface.state;
    const auto* material =
        dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL));
    look.vertexColours = !surface.colours.empty() &&
                         (material == nullptr || material->getColorMode() != osg::Material::OFF);
    if (material != nullptr) {
        look.diffuse = material->getDiffuse(osg::Material::FRONT);
        look.specular = material->getSpecular(osg::Material::FRONT);
        look.emission = material->getEmission(osg::Material::FRONT);
        look.shininess = material->getShininess(osg::Material::FRONT);
    }
    if (look.vertexColours) look.diffuse = {1.0f, 1.0f, 1.0f, 1.0f};
    const auto* texture = dynamic_cast<const osg::Texture*>(
        state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    if (texture != nullptr && !surface.texCoords.empty()) {
        look.image = texture->getImage(0);
        look.wrapS = texture->getWrap(osg::Texture::WRAP_S);
        look.wrapT = texture->getWrap(osg::Texture::WRAP_T);
    }
    look.twoSided = (state.getMode(GL_CULL_FACE) & osg::StateAttribute::ON) == 0;
    const auto* test =
        dynamic_cast<const osg::AlphaFunc*>(state.getAttribute(osg::StateAttribute::ALPHAFUNC));
    if ((state.getMode(GL_BLEND) & osg::StateAttribute::ON) != 0) {
        look.alpha = Alpha::Blend;
    } else if (test != nullptr) {
        look.alpha = Alpha::Mask;
        look.alphaCutOff = test->getReferenceValue();
    }
    return look;
}

std::vector<osg::Vec4> vertexColoursOf(const std::vector<Surface>& surfaces,
                                       const osgSkin::SkinMesh& mesh) {
    std::vector<osg::Vec4> result;
    for (const Surface& surface : surfaces) {
        if (!SurfaceLook::of(surface).vertexColours) continue;
        result.resize(mesh.positions.size(), {1.0f, 1.0f, 1.0f, 1.0f});
        for (std::size_t v = 0; v < surface.colours.size(); ++v)
            for (unsigned k = 0; k < 4; ++k)
                result[surface.sourceVertex[v]][k] = std::clamp(surface.colours[v][k], 0.0f, 1.0f);
    }
    return result;
}

osg::Vec4 linear(const osg::Vec4& displayed) {
    osg::Vec4 result = displayed;
    for (unsigned k = 0; k < 3; ++k) {
        const float value = displayed[k];
        result[k] = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
    }
    return result;
}

} // namespace bake
