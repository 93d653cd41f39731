// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/PartSubset.h"

#include <osg/TriangleIndexFunctor>

#include <cstring>

namespace osgSkin {
namespace {

constexpr std::uint32_t kUnused = 0xffffffffu;

struct CollectTriangles {
    std::vector<std::uint32_t> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        corners.insert(corners.end(), {a, b, c});
    }
};

/// The elements of a per-vertex array at `indices`, as a new array of the same kind.
osg::ref_ptr<osg::Array> gather(const osg::Array& source,
                                const std::vector<std::uint32_t>& indices) {
    osg::ref_ptr<osg::Array> result = static_cast<osg::Array*>(source.cloneType());
    result->setBinding(source.getBinding());
    result->setNormalize(source.getNormalize());
    result->resizeArray(static_cast<unsigned int>(indices.size()));
    if (indices.empty()) return result;
    auto* to = static_cast<char*>(const_cast<GLvoid*>(result->getDataPointer()));
    for (std::size_t i = 0; i < indices.size(); ++i)
        std::memcpy(to + i * source.getElementSize(), source.getDataPointer(indices[i]),
                    source.getElementSize());
    return result;
}

osg::Array* subset(osg::Array* source, std::size_t vertices,
                   const std::vector<std::uint32_t>& indices,
                   std::vector<osg::ref_ptr<osg::Array>>& keepAlive) {
    if (!source || source->getNumElements() != vertices) return source; // an overall binding
    keepAlive.push_back(gather(*source, indices));
    return keepAlive.back();
}

std::vector<std::uint32_t> corners(const osg::Geometry& geometry) {
    osg::TriangleIndexFunctor<CollectTriangles> triangles;
    geometry.accept(triangles);
    return std::move(triangles.corners);
}

/// The vertices `oldIndex` of the part, with everything that is given per vertex, and no triangle.
MeshPart vertexSubset(const MeshPart& part, const std::vector<std::uint32_t>& oldIndex) {
    const osg::Geometry& source = *part.geometry;
    const std::size_t vertices = part.sourceVertex.size();
    MeshPart result;
    result.geometry = new osg::Geometry;
    osg::Geometry& geometry = *result.geometry;
    geometry.setName(source.getName());
    geometry.setStateSet(const_cast<osg::StateSet*>(source.getStateSet()));
    geometry.setUseDisplayList(false);
    geometry.setUseVertexBufferObjects(true);

    std::vector<osg::ref_ptr<osg::Array>> arrays;
    const auto take = [&](const osg::Array* array) {
        return subset(const_cast<osg::Array*>(array), vertices, oldIndex, arrays);
    };
    geometry.setVertexArray(take(source.getVertexArray()));
    geometry.setNormalArray(take(source.getNormalArray()));
    geometry.setColorArray(take(source.getColorArray()));
    geometry.setSecondaryColorArray(take(source.getSecondaryColorArray()));
    for (unsigned int unit = 0; unit < source.getNumTexCoordArrays(); ++unit)
        geometry.setTexCoordArray(unit, take(source.getTexCoordArray(unit)));
    for (unsigned int i = 0; i < source.getNumVertexAttribArrays(); ++i)
        geometry.setVertexAttribArray(i, take(source.getVertexAttribArray(i)));
    for (const std::uint32_t v : oldIndex) result.sourceVertex.push_back(part.sourceVertex[v]);
    return result;
}

} // namespace

MeshPart partSubset(const MeshPart& part, const std::vector<bool>& keep) {
    const std::vector<std::uint32_t> old = corners(*part.geometry);
    std::vector<std::uint32_t> newIndex(part.sourceVertex.size(), kUnused);
    for (std::size_t c = 0; c < old.size(); ++c)
        if (keep[c / 3]) newIndex[old[c]] = 0;
    std::vector<std::uint32_t> oldIndex;
    for (std::uint32_t v = 0; v < newIndex.size(); ++v) {
        if (newIndex[v] == kUnused) continue;
        newIndex[v] = static_cast<std::uint32_t>(oldIndex.size());
        oldIndex.push_back(v);
    }

    MeshPart result = vertexSubset(part, oldIndex);
    const osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (std::size_t c = 0; c < old.size(); ++c) {
        if (!keep[c / 3]) continue;
        elements->push_back(newIndex[old[c]]);
        if (c % 3 == 0) result.sourceFace.push_back(part.sourceFace[c / 3]);
    }
    result.geometry->addPrimitiveSet(elements);
    return result;
}

MeshPart reorderedPart(const MeshPart& part, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> newIndex(order.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) newIndex[order[v]] = v;
    MeshPart result = vertexSubset(part, order);
    result.sourceFace = part.sourceFace;
    const osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (const std::uint32_t v : corners(*part.geometry)) elements->push_back(newIndex[v]);
    result.geometry->addPrimitiveSet(elements);
    return result;
}

} // namespace osgSkin
