// SPDX-License-Identifier: MIT
#include "crowd/Levels.h"

#include <osgSkin/DeformableSkin>
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

} // namespace

std::vector<GLuint> trianglesOf(const osg::Geometry& geometry) {
    const std::string broken =
        brokenPrimitive(geometry, geometry.getVertexArray()->getNumElements());
    if (!broken.empty())
        throw Error("crowd: the geometry \"" + geometry.getName() + "\" has " + broken);
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
