// SPDX-License-Identifier: MIT
#include "RestGeometry.h"

#include <osgSkin/DeformableSkin>

namespace {

std::size_t fewest(const osg::Array& array, const osg::Geometry& geometry,
                   std::size_t vertexCount) {
    switch (array.getBinding()) {
    case osg::Array::BIND_PER_VERTEX:
        return vertexCount;
    case osg::Array::BIND_PER_PRIMITIVE_SET:
        return geometry.getNumPrimitiveSets();
    case osg::Array::BIND_OVERALL:
        return 1;
    default:
        return 0;
    }
}

} // namespace

std::string whatIsWrongWith(const osg::Geometry& geometry, std::size_t vertexCount) {
    std::string wrong = osgSkin::brokenPrimitive(geometry, vertexCount);
    if (!wrong.empty()) return wrong;
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (array->getNumElements() < fewest(*array, geometry, vertexCount))
            return "an array with " + std::to_string(array->getNumElements()) +
                   " elements, expected at least " +
                   std::to_string(fewest(*array, geometry, vertexCount)) + " for " +
                   std::to_string(vertexCount) + " vertices";
    return {};
}
