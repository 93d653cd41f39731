// SPDX-License-Identifier: MIT
#include "RestGeometry.h"

namespace {

bool isTooShort(const osg::Array* array, std::size_t vertexCount) {
    return array && array->getBinding() == osg::Array::BIND_PER_VERTEX &&
           array->getNumElements() < vertexCount;
}

} // namespace

std::string whatIsWrongWith(const osg::Geometry& geometry, std::size_t vertexCount) {
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry.getPrimitiveSetList()) {
        if (!primitives) return "a primitive set that is none";
        // Ends at the first bad one, so that a false count does not take long.
        for (unsigned int i = 0; i < primitives->getNumIndices(); ++i)
            if (primitives->index(i) >= vertexCount)
                return "a primitive that names vertex " + std::to_string(primitives->index(i)) +
                       ", expected less than " + std::to_string(vertexCount);
    }
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (isTooShort(array, vertexCount))
            return "an array with " + std::to_string(array->getNumElements()) +
                   " elements, expected one of each of " + std::to_string(vertexCount) +
                   " vertices";
    return {};
}
