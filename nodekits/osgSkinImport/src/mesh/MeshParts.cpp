// SPDX-License-Identifier: MIT
#include "mesh/MeshParts.h"

#include <osgSkin/GlmOsg>

#include <array>
#include <map>

namespace osgSkin {
namespace {

/// A part while its faces come in.
class PartBuilder {
public:
    explicit PartBuilder(const CornerMesh& source) : _source(source) {}

    /// \param corners three places in the mesh's `faceVertices`
    void addTriangle(std::uint32_t face, const std::uint32_t* corners) {
        for (int k = 0; k < 3; ++k) _triangles->push_back(vertex(corners[k]));
        _part.sourceFace.push_back(face);
    }

    MeshPart finish(osg::StateSet* stateSet) {
        _part.geometry = new osg::Geometry;
        osg::Geometry& geometry = *_part.geometry;
        geometry.setVertexArray(_positions);
        geometry.setNormalArray(_normals, osg::Array::BIND_PER_VERTEX);
        if (_source.hasTexCoords)
            geometry.setTexCoordArray(0, _texCoords, osg::Array::BIND_PER_VERTEX);
        if (!_colours->empty()) geometry.setColorArray(_colours, osg::Array::BIND_PER_VERTEX);
        geometry.addPrimitiveSet(_triangles);
        geometry.setUseDisplayList(false);
        geometry.setUseVertexBufferObjects(true);
        geometry.setStateSet(stateSet);
        return _part;
    }

    bool empty() const { return _triangles->empty(); }

private:
    unsigned vertex(std::size_t corner) {
        const std::uint32_t source = _source.mesh.faceVertices[corner];
        const glm::vec3& n = _source.normals[corner];
        const glm::vec2& t = _source.texCoords[corner];
        const bool coloured = !_source.colours.empty();
        const glm::vec4 c = coloured ? _source.colours[corner] : glm::vec4(1.0f);
        const Key key{source, {n.x, n.y, n.z, t.x, t.y, c.r, c.g, c.b, c.a}};
        const auto [entry, isNew] = _copies.emplace(key, static_cast<unsigned>(_positions->size()));
        if (isNew) {
            _positions->push_back(osg::Vec3(toOsg(_source.mesh.positions[source])));
            _normals->push_back(osg::Vec3(toOsg(glm::dvec3(n))));
            _texCoords->push_back({t.x, t.y});
            if (coloured) _colours->push_back({c.r, c.g, c.b, c.a});
            _part.sourceVertex.push_back(source);
        }
        return entry->second;
    }

    using Key = std::pair<std::uint32_t, std::array<float, 9>>;

    const CornerMesh& _source;
    MeshPart _part;
    std::map<Key, unsigned> _copies;
    osg::ref_ptr<osg::Vec3Array> _positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> _normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> _texCoords = new osg::Vec2Array;
    osg::ref_ptr<osg::Vec4Array> _colours = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUInt> _triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
};

} // namespace

std::vector<MeshPart> makeMeshParts(const CornerMesh& source) {
    std::vector<PartBuilder> builders;
    builders.reserve(source.stateSets.size());
    for (std::size_t m = 0; m < source.stateSets.size(); ++m) builders.emplace_back(source);
    const std::vector<std::uint32_t> corners = source.mesh.triangleCorners();
    const std::uint32_t* triangle = corners.data();
    for (std::uint32_t f = 0; f < source.mesh.faceSizes.size(); ++f)
        for (std::uint32_t k = 2; k < source.mesh.faceSizes[f]; ++k, triangle += 3)
            builders[source.materials[f]].addTriangle(f, triangle);
    std::vector<MeshPart> result;
    for (std::size_t m = 0; m < builders.size(); ++m)
        if (!builders[m].empty()) result.push_back(builders[m].finish(source.stateSets[m]));
    return result;
}

} // namespace osgSkin
