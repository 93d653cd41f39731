// SPDX-License-Identifier: MIT
#include "PeerSkin.h"

#include <osgSkin/GlmOsg>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <utility>

namespace twist {
namespace {

/// Normals go by the inverse transpose. The cofactors are that up to a positive factor, and are
/// there too where linear blending has flattened the skin.
glm::dvec3 turnNormal(const glm::dmat4& matrix, const glm::dvec3& normal) {
    const glm::dvec3 x(matrix[0]);
    const glm::dvec3 y(matrix[1]);
    const glm::dvec3 z(matrix[2]);
    const glm::dvec3 turned =
        glm::dmat3(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)) * normal;
    const double length = glm::length(turned);
    return length > 1e-12 ? turned / length : normal;
}

} // namespace

PeerSkin::PeerSkin(const osgSkin::MeshPart& part, std::vector<glm::dvec3> rest,
                   compare::SkinWeights weights, Blend blend)
    : _part(part), _rest(std::move(rest)), _weights(std::move(weights)), _blend(std::move(blend)),
      _positions(_rest),
      _geometry(new osg::Geometry(*part.geometry, osg::CopyOp::DEEP_COPY_ARRAYS)) {
    _geometry->setUseDisplayList(false);
    _geometry->setUseVertexBufferObjects(true);
    // Written in place, so an update has to wait until it is drawn.
    _geometry->setDataVariance(osg::Object::DYNAMIC);
}

void PeerSkin::setPose(const std::vector<glm::dmat4>& skinning) {
    const std::vector<glm::dmat4> matrices = _blend(_weights, skinning);
    _positions = compare::transformPoints(matrices, _rest);
    const auto& rest = static_cast<const osg::Vec3Array&>(*_part.geometry->getNormalArray());
    auto& vertices = static_cast<osg::Vec3Array&>(*_geometry->getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*_geometry->getNormalArray());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::uint32_t v = _part.sourceVertex[i];
        vertices[i] = osgSkin::toOsg(_positions[v]);
        normals[i] = osgSkin::toOsg(turnNormal(matrices[v], osgSkin::toGlm(osg::Vec3d(rest[i]))));
    }
    vertices.dirty();
    normals.dirty();
    _geometry->dirtyBound();
}

} // namespace twist
