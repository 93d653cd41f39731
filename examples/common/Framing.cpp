// SPDX-License-Identifier: MIT
#include "Framing.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace example {

View framed(const osg::BoundingBoxd& box, const osg::Vec3d& side, double aspect) {
    View view;
    view.centre = box.center();
    osg::Vec3d back = side;
    back.normalize();
    osg::Vec3d right = view.up ^ back;
    right.normalize();
    const osg::Vec3d up = back ^ right;
    const double height = std::tan(0.5 * osg::DegreesToRadians(view.fieldOfView)) / 1.1;
    double distance = 0.0;
    for (unsigned int i = 0; i < 8; ++i) {
        const osg::Vec3d corner = box.corner(i) - view.centre;
        const double from = std::max(std::abs(corner * up), std::abs(corner * right) / aspect);
        distance = std::max(distance, from / height + corner * back);
    }
    view.eye = view.centre + back * distance;
    return view;
}

} // namespace example
