// SPDX-License-Identifier: MIT
#include <osgSkin/DeformableSkin>

#include <osg/Geometry>

#include <cstddef>
#include <cstdint>
#include <string>

namespace osgSkin {
namespace {

std::string beyond(std::int64_t vertex, std::size_t vertexCount) {
    return "a primitive that names vertex " + std::to_string(vertex) + ", expected less than " +
           std::to_string(vertexCount);
}

/// Checks `count` vertices from `first` on.
std::string findRangeError(std::int64_t first, std::int64_t count, std::size_t vertexCount) {
    if (count < 0) return "a primitive of " + std::to_string(count) + " corners";
    if (first < 0) return beyond(first, vertexCount);
    const bool fits = first + count <= static_cast<std::int64_t>(vertexCount);
    return fits ? "" : beyond(first + count - 1, vertexCount);
}

/// Not by getNumIndices(): OSG adds the counts up in a number that may wrap.
std::string findRangeError(const osg::DrawArrayLengths& runs, std::size_t vertexCount) {
    std::int64_t first = runs.getFirst();
    for (const GLsizei count : runs) {
        std::string wrong = findRangeError(first, count, vertexCount);
        if (!wrong.empty()) return wrong;
        first += count;
    }
    return {};
}

/// OSG does not check that both lists are of the same length.
std::string findRangeError(const osg::MultiDrawArrays& runs, std::size_t vertexCount) {
    if (runs.getFirsts().size() != runs.getCounts().size())
        return std::to_string(runs.getFirsts().size()) + " first vertices of " +
               std::to_string(runs.getCounts().size()) + " runs";
    for (std::size_t i = 0; i < runs.getCounts().size(); ++i) {
        std::string wrong = findRangeError(runs.getFirsts()[i], runs.getCounts()[i], vertexCount);
        if (!wrong.empty()) return wrong;
    }
    return {};
}

std::string findRangeError(const osg::PrimitiveSet* primitives, std::size_t vertexCount) {
    if (!primitives) return "a null primitive set";
    if (const auto* runs = dynamic_cast<const osg::DrawArrayLengths*>(primitives))
        return findRangeError(*runs, vertexCount);
    if (const auto* runs = dynamic_cast<const osg::MultiDrawArrays*>(primitives))
        return findRangeError(*runs, vertexCount);
    const unsigned int count = primitives->getNumIndices();
    // Stops at the first bad one, so that a wrong count does not take long.
    for (unsigned int i = 0; i < count; ++i)
        if (primitives->index(i) >= vertexCount) return beyond(primitives->index(i), vertexCount);
    // OSG reads all three corners of an incomplete triangle.
    if (primitives->getDrawElements() && primitives->getMode() == GL_TRIANGLES && count % 3 != 0)
        return std::to_string(count) + " corners of triangles, expected a multiple of 3";
    return {};
}

} // namespace

std::string brokenPrimitive(const osg::Geometry& geometry, std::size_t vertices) {
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i) {
        std::string wrong = findRangeError(geometry.getPrimitiveSet(i), vertices);
        if (!wrong.empty()) return wrong;
    }
    return {};
}

} // namespace osgSkin
