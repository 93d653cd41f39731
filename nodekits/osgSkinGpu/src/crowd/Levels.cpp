// SPDX-License-Identifier: MIT
#include "crowd/Levels.h"

#include <osgSkin/Error>

#include <osg/TriangleIndexFunctor>

#include <string>

#ifdef OSGSKIN_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace osgSkin {
namespace {

struct CollectTriangles {
    std::vector<GLuint> indices;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
    }
};

/// OSG reads all corners of a triangle that is begun, and believes ranges.
void checkPrimitives(const osg::Geometry& geometry) {
    const std::string where = "crowd: the geometry \"" + geometry.getName() + "\" ";
    const unsigned int vertices = geometry.getVertexArray()->getNumElements();
    for (unsigned int s = 0; s < geometry.getNumPrimitiveSets(); ++s) {
        const osg::PrimitiveSet* set = geometry.getPrimitiveSet(s);
        if (!set) throw Error(where + "has a primitive set that is none");
        const unsigned int count = set->getNumIndices();
        if (set->getDrawElements() && set->getMode() == GL_TRIANGLES && count % 3 != 0)
            throw Error(where + "has " + std::to_string(count) +
                        " corners of triangles, expected a multiple of 3");
        for (unsigned int i = 0; i < count; ++i) // ends at the first, whatever the count
            if (set->index(i) >= vertices)
                throw Error(where + "has a primitive that names vertex " +
                            std::to_string(set->index(i)) + ", expected less than " +
                            std::to_string(vertices));
    }
}

} // namespace

std::vector<GLuint> trianglesOf(const osg::Geometry& geometry) {
    checkPrimitives(geometry);
    osg::TriangleIndexFunctor<CollectTriangles> collect;
    geometry.accept(collect);
    return collect.indices;
}

std::vector<GLuint> simplified([[maybe_unused]] const std::vector<osg::Vec3>& positions,
                               [[maybe_unused]] const std::vector<GLuint>& indices,
                               [[maybe_unused]] std::size_t most) {
#ifdef OSGSKIN_HAS_MESHOPTIMIZER
    std::vector<GLuint> result(indices.size());
    if (indices.empty()) return result;
    // Of the extent: what is that small in the picture may be that wrong.
    const float error = 0.05f;
    const std::size_t size =
        meshopt_simplify(result.data(), indices.data(), indices.size(), positions.front().ptr(),
                         positions.size(), sizeof(osg::Vec3), most, error, 0, nullptr);
    result.resize(size);
    return result;
#else
    throw Error("levels of detail: this osgSkinGpu was built without meshoptimizer");
#endif
}

} // namespace osgSkin
