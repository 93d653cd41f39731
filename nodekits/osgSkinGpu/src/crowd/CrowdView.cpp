// SPDX-License-Identifier: MIT
#include "crowd/CrowdView.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {

CrowdView::CrowdView(const osg::Matrixd& modelView, const osg::Matrixd& projection) {
    const osg::Matrixd clip = modelView * projection;
    for (unsigned int i = 0; i < planes.size(); ++i) {
        const int axis = static_cast<int>(i / 2);
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        osg::Vec4d plane;
        for (unsigned int row = 0; row < 4; ++row)
            plane[row] = clip(static_cast<int>(row), 3) + sign * clip(static_cast<int>(row), axis);
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

std::size_t CrowdView::levelOf(const osg::Vec4f& sphere, const std::vector<float>& sizes) const {
    float size = sphere.w() * sizeAtOne;
    const osg::Vec3f centre(sphere.x(), sphere.y(), sphere.z());
    if (!isFlat) size /= std::max((eye - centre).length(), 1e-6f);
    std::size_t level = 0;
    while (level + 1 < sizes.size() && size < sizes[level + 1]) ++level;
    return level;
}

} // namespace osgSkin
