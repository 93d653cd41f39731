// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/CrowdCharacter>

#include <osg/Matrixd>
#include <osg/Vec3f>
#include <osg/Vec4f>

#include <array>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// A camera's view in the crowd's space: the four side planes, without near and far, which depend
/// on what is seen.
struct CrowdView {
    CrowdView(const osg::Matrixd& modelView, const osg::Matrixd& projection);

    std::array<osg::Vec4f, 4> planes; ///< inside: x a + y b + z c + d >= 0; unit normals
    osg::Vec3f eye;
    float sizeAtOne; ///< of a sphere of radius 1 at distance 1, in half heights of the picture
    bool isFlat;     ///< orthographic: the size does not depend on the distance

    bool sees(const osg::Vec4f& sphere) const;
    /// The radius of a sphere in the picture, in half heights of it.
    float sizeOf(const osg::Vec4f& sphere) const;
};

/// The levels of detail in which members of some size are drawn; cullProgram() does the same.
class CrowdLevels {
public:
    explicit CrowdLevels(const CrowdCharacter& character);

    /// Below which each level is used; the first is infinite.
    const std::vector<float>& sizes() const { return _sizes; }
    const std::vector<unsigned int>& triangles() const { return _triangles; } ///< of a member

    /// \param steps by which the levels' sizes are raised, 16 for twice the size; 0..kBins
    std::size_t levelOf(float size, int steps) const { return levelOf(size, binOf(size), steps); }

    /// The fewest steps with which members have so many triangles at most; kBins, with which all
    /// are in the last level, where there are none.
    int stepsFor(const std::vector<float>& sizes, unsigned int maxTriangles) const;
    static constexpr int kBins = 256;

private:
    static int binOf(float size);
    std::size_t levelOf(float size, int bin, int steps) const;
    bool fit(const std::vector<unsigned int>& asIs, const std::array<unsigned int, kBins>& bins,
             int steps, unsigned int maxTriangles) const;

    std::vector<float> _sizes;
    std::vector<unsigned int> _triangles;
};

} // namespace osgSkin
