// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Surface.h"

#include <osg/Image>
#include <osg/Texture>
#include <osg/Vec4>

#include <vector>

namespace bake {

/// A surface's material, as its state set has it. Colours are sRGB.
struct SurfaceMaterial {
    enum class Alpha { Opaque, Mask, Blend };

    osg::Vec4 diffuse{0.8f, 0.8f, 0.8f, 1.0f}; ///< white where the vertices have colours
    osg::Vec4 specular{0.0f, 0.0f, 0.0f, 1.0f};
    osg::Vec4 emission{0.0f, 0.0f, 0.0f, 1.0f};
    float shininess = 0.0f;               ///< Blinn's exponent
    osg::ref_ptr<const osg::Image> image; ///< of texture unit 0, where there are coordinates for it
    osg::Texture::WrapMode wrapS = osg::Texture::REPEAT, wrapT = osg::Texture::REPEAT;
    bool twoSided = true;
    bool vertexColours = false; ///< the surface's are to be used
    Alpha alpha = Alpha::Opaque;
    float alphaCutOff = 0.5f; ///< with Alpha::Mask

    static SurfaceMaterial of(const Surface& surface);
};

/// The colours of the mesh's vertices, white where a surface has none, clamped to 0..1; empty where
/// no surface uses any.
std::vector<osg::Vec4> vertexColoursOf(const std::vector<Surface>& surfaces,
                                       const osgSkin::SkinMesh& mesh);

/// An sRGB colour made linear; alpha is kept.
osg::Vec4 linear(const osg::Vec4& srgb);

} // namespace bake
