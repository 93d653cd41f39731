// SPDX-License-Identifier: MIT
#include "Cylinder.h"

#include <osgSkin/GlmOsg>

#include <glm/gtc/constants.hpp>

#include <array>
#include <cmath>

namespace twist {
namespace {

/// A row of drawn vertices: a circle of the surface of revolution.
struct Row {
    double radius, z;
    double along;       ///< length of the outline up to here
    glm::dvec2 normal;  ///< outwards and along z
    std::uint32_t ring; ///< of the mesh; a cap's rim and the side's end are one ring
    bool startsSurface; ///< a new surface: not joined to the row before
};

/// The outline from the middle of the lower cap over the side to the middle of the upper one.
std::vector<Row> outline() {
    constexpr double half = Cylinder::kHalfLength;
    constexpr std::uint32_t caps = Cylinder::kCapRings;
    constexpr std::uint32_t steps = Cylinder::kSteps;
    std::vector<Row> rows;
    for (std::uint32_t i = 0; i <= caps; ++i) {
        const double radius = double(i) / caps;
        rows.push_back({radius, -half, radius, {0, -1}, i, i == 0});
    }
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const double up = 2.0 * half * i / steps;
        rows.push_back({1.0, up - half, up, {1, 0}, caps + i, i == 0});
    }
    for (std::uint32_t i = 0; i <= caps; ++i) {
        const double inwards = double(i) / caps;
        rows.push_back({1.0 - inwards, half, inwards, {0, 1}, caps + steps + i, i == 0});
    }
    return rows;
}

constexpr std::uint32_t kRings = 2 * Cylinder::kCapRings + Cylinder::kSteps + 1;

/// The mesh has one vertex in the middle of each cap and kSegments on every ring between.
std::uint32_t meshVertex(std::uint32_t ring, std::uint32_t column) {
    if (ring == 0) return 0;
    if (ring == kRings - 1) return 1 + (kRings - 2) * Cylinder::kSegments;
    return 1 + (ring - 1) * Cylinder::kSegments + column % Cylinder::kSegments;
}

void addFace(osgSkin::SkinMesh& mesh, const Row& low, const Row& high, std::uint32_t column) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t vertex :
         {meshVertex(low.ring, column), meshVertex(low.ring, column + 1),
          meshVertex(high.ring, column + 1), meshVertex(high.ring, column)})
        if (corners.empty() || (vertex != corners.back() && vertex != corners.front()))
            corners.push_back(vertex);
    mesh.faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
    mesh.faceVertices.insert(mesh.faceVertices.end(), corners.begin(), corners.end());
}

} // namespace

Cylinder::Cylinder() {
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::Vec2Array> texture = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    mesh.positions.resize(2 + (kRings - 2) * kSegments);
    rings.resize(kSteps + 1);

    const std::vector<Row> rows = outline();
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const Row& row = rows[r];
        const auto start = static_cast<std::uint32_t>(vertices->size());
        // The first column stands twice: the texture's two ends meet there.
        for (std::uint32_t i = 0; i <= kSegments; ++i) {
            const double angle = glm::two_pi<double>() * (i % kSegments) / kSegments;
            const glm::dvec2 way(std::cos(angle), std::sin(angle));
            const glm::dvec3 position(row.radius * way, row.z);
            const std::uint32_t vertex = meshVertex(row.ring, i);
            mesh.positions[vertex] = position;
            vertices->push_back(osgSkin::toOsg(position));
            normals->push_back(osgSkin::toOsg(glm::dvec3(row.normal.x * way, row.normal.y)));
            texture->push_back(osg::Vec2(float(i) / kSegments,
                                         static_cast<float>(row.along / (2.0 * kChequerLength))));
            part.sourceVertex.push_back(vertex);
            if (i == kSegments) continue;
            if (row.normal.y == 0.0) rings[row.ring - kCapRings].push_back(vertex);
            if (row.startsSurface) continue;
            const std::uint32_t c = start + i;
            const std::uint32_t b = c - (kSegments + 1);
            const auto face = static_cast<std::uint32_t>(mesh.faceSizes.size());
            addFace(mesh, rows[r - 1], row, i);
            const bool lowPoint = rows[r - 1].radius == 0.0;
            const bool highPoint = row.radius == 0.0;
            if (!lowPoint) {
                for (const std::uint32_t v : {b, b + 1, c}) triangles->push_back(v);
                part.sourceFace.push_back(face);
            }
            if (!highPoint) {
                for (const std::uint32_t v : {b + 1, c + 1, c}) triangles->push_back(v);
                part.sourceFace.push_back(face);
            }
        }
    }
    part.geometry = new osg::Geometry;
    part.geometry->setVertexArray(vertices);
    part.geometry->setNormalArray(normals);
    part.geometry->setTexCoordArray(0, texture);
    part.geometry->addPrimitiveSet(triangles);
}

} // namespace twist
