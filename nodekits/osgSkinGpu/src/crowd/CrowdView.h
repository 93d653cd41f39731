// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Matrixd>
#include <osg/Vec3f>
#include <osg/Vec4f>

#include <array>
#include <vector>

namespace osgSkin {

/// What a camera sees of a crowd, in the crowd's space: the sides of its view, without near and
/// far, which depend on what is seen.
struct CrowdView {
    CrowdView(const osg::Matrixd& modelView, const osg::Matrixd& projection);

    std::array<osg::Vec4f, 4> planes; ///< inside: x a + y b + z c + d >= 0; unit
    osg::Vec3f eye;
    float sizeAtOne; ///< of a sphere of radius 1 at distance 1, in halves of the picture's height
    bool isFlat;     ///< no perspective: at any distance

    bool sees(const osg::Vec4f& sphere) const;
    /// The level of detail in which a sphere is drawn, whose sizes begin at infinity.
    std::size_t levelOf(const osg::Vec4f& sphere, const std::vector<float>& sizes) const;
};

} // namespace osgSkin
