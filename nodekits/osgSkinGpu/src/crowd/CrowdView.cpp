// SPDX-License-Identifier: MIT
#include "crowd/CrowdView.h"

#include <osg/Vec3d>
#include <osg/Vec4d>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace osgSkin {

CrowdView::CrowdView(const osg::Matrixd& modelView, const osg::Matrixd& projection) {
    const osg::Matrixd clip = modelView * projection;
    for (unsigned int i = 0; i < planes.size(); ++i) {
        const int axis = static_cast<int>(i / 2);
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        osg::Vec4d plane;
        for (int row = 0; row < 4; ++row)
            plane[static_cast<unsigned int>(row)] = clip(row, 3) + sign * clip(row, axis);
        const double length = osg::Vec3d(plane.x(), plane.y(), plane.z()).length();
        planes[i] = length > 0.0 ? plane / length : osg::Vec4d(0, 0, 0, 1);
    }
    eye = osg::Matrixd::inverse(modelView).getTrans();
    sizeAtOne = static_cast<float>(std::abs(projection(1, 1)));
    isFlat = projection(3, 3) != 0.0;
}

bool CrowdView::sees(const osg::Vec4f& sphere) const {
    return std::all_of(planes.begin(), planes.end(), [&](const osg::Vec4f& plane) {
        return plane.x() * sphere.x() + plane.y() * sphere.y() + plane.z() * sphere.z() +
                   plane.w() >=
               -sphere.w();
    });
}

float CrowdView::sizeOf(const osg::Vec4f& sphere) const {
    const float size = sphere.w() * sizeAtOne;
    const osg::Vec3f centre(sphere.x(), sphere.y(), sphere.z());
    return isFlat ? size : size / std::max((eye - centre).length(), 1e-6f);
}

CrowdLevels::CrowdLevels(const CrowdCharacter& character) : _sizes(character.levelSizes()) {
    for (std::size_t level = 0; level < _sizes.size(); ++level)
        _triangles.push_back(static_cast<unsigned int>(character.triangleCount(level)));
}

/// Sixteen bins for each power of two, from 2^-12 to 2^4, by the bits of a float: the same in
/// shaders.
int CrowdLevels::binOf(float size) {
    std::int32_t bits;
    std::memcpy(&bits, &size, sizeof bits);
    return std::clamp((bits >> 19) - 1840, 0, kBins - 1);
}

std::size_t CrowdLevels::levelOf(float size, int bin, int steps) const {
    std::size_t level = 0;
    while (level + 1 < _sizes.size() &&
           (steps == 0 ? size < _sizes[level + 1] : bin < binOf(_sizes[level + 1]) + steps))
        ++level;
    return level;
}

bool CrowdLevels::fit(const std::vector<unsigned int>& asIs,
                      const std::array<unsigned int, kBins>& bins, int steps,
                      unsigned int maxTriangles) const {
    std::uint64_t sum = 0;
    if (steps == 0)
        for (std::size_t level = 0; level < asIs.size(); ++level)
            sum += std::uint64_t{asIs[level]} * _triangles[level];
    else
        for (int bin = 0; bin < kBins; ++bin)
            sum += std::uint64_t{bins[static_cast<std::size_t>(bin)]} *
                   _triangles[levelOf(0.0f, bin, steps)];
    return sum <= maxTriangles;
}

int CrowdLevels::stepsFor(const std::vector<float>& sizes, unsigned int maxTriangles) const {
    std::vector<unsigned int> asIs(_sizes.size());
    std::array<unsigned int, kBins> bins{};
    for (const float size : sizes) {
        ++asIs[levelOf(size, 0)];
        ++bins[static_cast<std::size_t>(binOf(size))];
    }
    int steps = 0;
    while (steps < kBins && !fit(asIs, bins, steps, maxTriangles)) ++steps;
    return steps;
}

} // namespace osgSkin
