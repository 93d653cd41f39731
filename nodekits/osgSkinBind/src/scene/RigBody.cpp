// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/RigBody.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osg/TriangleIndexFunctor>
#include <osgAnimation/MorphGeometry>

#include <cmath>

namespace osgSkin {
namespace {

struct Triangles {
    std::vector<unsigned int> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        if (a != b && b != c && c != a) corners.insert(corners.end(), {a, b, c});
    }
};

const osg::Geometry& sourceOf(const osgAnimation::RigGeometry& rig) {
    const osg::Geometry* source = rig.getSourceGeometry();
    if (dynamic_cast<const osgAnimation::MorphGeometry*>(source) != nullptr)
        throw Error("it has morph targets");
    return source != nullptr ? *source : rig;
}

const osg::Vec3Array& verticesOf(const osg::Geometry& source) {
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(source.getVertexArray());
    if (vertices == nullptr || vertices->empty()) throw Error("it has no vertices of three floats");
    for (const osg::Vec3& v : *vertices)
        if (!v.valid() || !std::isfinite(v.length2())) throw Error("a vertex is not finite");
    return *vertices;
}

/// DeformableSkin draws what is given per vertex, or once for all.
void checkBindings(const osg::Geometry& source, std::size_t vertices) {
    osg::Geometry::ArrayList arrays;
    source.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays) {
        const auto binding = array->getBinding();
        if (binding == osg::Array::BIND_PER_PRIMITIVE_SET ||
            (binding == osg::Array::BIND_PER_VERTEX && array->getNumElements() < vertices))
            throw Error("an attribute is not given per vertex");
    }
}

osg::ref_ptr<osg::Vec3Array> smoothNormals(const osg::Vec3Array& vertices,
                                           const std::vector<unsigned int>& corners) {
    osg::ref_ptr<osg::Vec3Array> normals =
        new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, unsigned(vertices.size()));
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const osg::Vec3& a = vertices[corners[i]];
        const osg::Vec3 area = (vertices[corners[i + 1]] - a) ^ (vertices[corners[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) (*normals)[corners[i + k]] += area;
    }
    for (osg::Vec3& normal : *normals)
        if (normal.normalize() == 0.0f) normal.set(0.0f, 0.0f, 1.0f);
    return normals;
}

osg::ref_ptr<osg::Vec3Array> normalsOf(const osg::Geometry& source, const osg::Vec3Array& vertices,
                                       const std::vector<unsigned int>& corners) {
    const auto* given = dynamic_cast<const osg::Vec3Array*>(source.getNormalArray());
    if (given == nullptr || given->size() < vertices.size() ||
        given->getBinding() == osg::Array::BIND_OVERALL)
        return smoothNormals(vertices, corners);
    osg::ref_ptr<osg::Vec3Array> normals =
        new osg::Vec3Array(given->begin(), given->begin() + std::ptrdiff_t(vertices.size()));
    return normals;
}

void move(const osg::Matrixd& toSkeleton, osg::Vec3Array& vertices, osg::Vec3Array& normals) {
    if (toSkeleton.isIdentity()) return; // to the last bit
    const osg::Matrixd inverse = osg::Matrixd::inverse(toSkeleton);
    for (osg::Vec3& v : vertices) v = v * toSkeleton;
    for (osg::Vec3& n : normals) {
        n = osg::Matrixd::transform3x3(inverse, n);
        n.normalize();
    }
}

MeshPart makePart(const osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton) {
    const osg::Geometry& source = sourceOf(rig);
    const osg::Vec3Array& given = verticesOf(source);
    checkBindings(source, given.size());
    const std::string broken = brokenPrimitive(source, given.size());
    if (!broken.empty()) throw Error("it has " + broken);
    osg::TriangleIndexFunctor<Triangles> triangles;
    source.accept(triangles);
    if (triangles.corners.empty()) throw Error("it has no triangles");

    MeshPart part;
    part.geometry = new osg::Geometry(source, osg::CopyOp::SHALLOW_COPY);
    osg::Geometry& geometry = *part.geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(given.begin(), given.end());
    const osg::ref_ptr<osg::Vec3Array> normals = normalsOf(source, given, triangles.corners);
    move(toSkeleton, *vertices, *normals);
    geometry.setVertexArray(vertices);
    geometry.setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry.removePrimitiveSet(0, geometry.getNumPrimitiveSets());
    geometry.addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, unsigned(triangles.corners.size()), triangles.corners.data()));
    geometry.setName(rig.getName().empty() ? source.getName() : rig.getName());
    if (rig.getStateSet() != nullptr)
        geometry.setStateSet(const_cast<osg::StateSet*>(rig.getStateSet()));
    geometry.setUpdateCallback(nullptr);
    return part;
}

VertexWeights weightsOf(const osgAnimation::RigGeometry& rig, std::size_t vertices,
                        const RestSkeleton& skeleton) {
    VertexWeights result(vertices);
    bool any = false;
    if (rig.getInfluenceMap() != nullptr)
        for (const auto& [bone, entries] : *rig.getInfluenceMap()) {
            const int joint = skeleton.find(bone);
            if (joint < 0) continue;
            for (const auto& [vertex, weight] : entries) {
                if (vertex >= vertices || !std::isfinite(weight) || weight < 0.0f)
                    throw Error("bone \"" + bone + "\" has a weight that is negative, not finite " +
                                "or for a vertex that is not there");
                result[vertex].push_back({static_cast<std::uint32_t>(joint), double(weight)});
                any = any || weight > 0.0f;
            }
        }
    if (!any) throw Error("it has no weights for the bones of its skeleton");
    return result;
}

} // namespace

void RigBody::add(const osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton,
                  const RestSkeleton& skeleton) {
    MeshPart part = makePart(rig, toSkeleton);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray());
    const VertexWeights own = weightsOf(rig, vertices.size(), skeleton);

    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto firstFace = static_cast<std::uint32_t>(mesh.faceSizes.size());
    for (const osg::Vec3& v : vertices) {
        part.sourceVertex.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(toGlm(osg::Vec3d(v)));
    }
    const auto& corners =
        static_cast<const osg::DrawElementsUInt&>(*part.geometry->getPrimitiveSet(0));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        mesh.faceVertices.push_back(first + corners[i]);
        if (i % 3 == 0) {
            part.sourceFace.push_back(firstFace + static_cast<std::uint32_t>(i / 3));
            mesh.faceSizes.push_back(3);
        }
    }
    weights.insert(weights.end(), own.begin(), own.end());
    parts.push_back(part);
}

} // namespace osgSkin
