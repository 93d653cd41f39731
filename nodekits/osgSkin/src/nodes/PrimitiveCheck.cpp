// SPDX-License-Identifier: MIT
#include "nodes/PrimitiveCheck.h"

#include <cstdint>

namespace osgSkin {
namespace {

std::string beyond(std::int64_t vertex, std::size_t vertexCount) {
    return "a primitive that names vertex " + std::to_string(vertex) + ", expected less than " +
           std::to_string(vertexCount);
}

/// A run of `count` vertices from `first` on.
std::string whatIsWrongWith(std::int64_t first, std::int64_t count, std::size_t vertexCount) {
    if (count < 0) return "a primitive of " + std::to_string(count) + " corners";
    if (first < 0) return beyond(first, vertexCount);
    const bool fits = first + count <= static_cast<std::int64_t>(vertexCount);
    return fits ? "" : beyond(first + count - 1, vertexCount);
}

/// OSG counts all runs' vertices in a number that may wrap.
std::string whatIsWrongWith(const osg::DrawArrayLengths& runs, std::size_t vertexCount) {
    std::int64_t first = runs.getFirst();
    for (const GLsizei count : runs) {
        std::string wrong = whatIsWrongWith(first, count, vertexCount);
        if (!wrong.empty()) return wrong;
        first += count;
    }
    return {};
}

/// OSG looks for each run's first vertex in a list that may be shorter.
std::string whatIsWrongWith(const osg::MultiDrawArrays& runs, std::size_t vertexCount) {
    if (runs.getFirsts().size() != runs.getCounts().size())
        return std::to_string(runs.getFirsts().size()) + " first vertices of " +
               std::to_string(runs.getCounts().size()) + " runs";
    for (std::size_t i = 0; i < runs.getCounts().size(); ++i) {
        std::string wrong = whatIsWrongWith(runs.getFirsts()[i], runs.getCounts()[i], vertexCount);
        if (!wrong.empty()) return wrong;
    }
    return {};
}

std::string whatIsWrongWith(const osg::PrimitiveSet* primitives, std::size_t vertexCount) {
    if (!primitives) return "a primitive set that is none";
    if (const auto* runs = dynamic_cast<const osg::DrawArrayLengths*>(primitives))
        return whatIsWrongWith(*runs, vertexCount);
    if (const auto* runs = dynamic_cast<const osg::MultiDrawArrays*>(primitives))
        return whatIsWrongWith(*runs, vertexCount);
    const unsigned int count = primitives->getNumIndices();
    // Ends at the first bad one, so that a false count does not take long.
    for (unsigned int i = 0; i < count; ++i)
        if (primitives->index(i) >= vertexCount) return beyond(primitives->index(i), vertexCount);
    // OSG reads all three corners of a triangle that is begun.
    if (primitives->getDrawElements() && primitives->getMode() == GL_TRIANGLES && count % 3 != 0)
        return std::to_string(count) + " corners of triangles, expected a multiple of 3";
    return {};
}

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

std::string findBroken(const osg::Geometry& geometry, std::size_t vertices) {
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i) {
        std::string wrong = whatIsWrongWith(geometry.getPrimitiveSet(i), vertices);
        if (!wrong.empty()) return wrong;
    }
    return {};
}

std::string findShort(const osg::Geometry& geometry, std::size_t vertices) {
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (array->getNumElements() < fewest(*array, geometry, vertices))
            return "an array with " + std::to_string(array->getNumElements()) +
                   " elements, expected at least " +
                   std::to_string(fewest(*array, geometry, vertices)) + " for " +
                   std::to_string(vertices) + " vertices";
    return {};
}

} // namespace osgSkin
