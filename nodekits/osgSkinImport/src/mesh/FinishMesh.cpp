// SPDX-License-Identifier: MIT
#include "mesh/FinishMesh.h"

#include "files/FileText.h"
#include "mesh/CornerMesh.h"
#include "mesh/Material.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/MeshPart>
#include <osgSkinRig/MorphsByVertex>
#include <osgSkinRig/SkinMesh>

#include <osg/Material>
#include <osg/StateSet>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

/// For each vertex, the first vertex at the same position.
std::vector<std::size_t> weld(const std::vector<glm::dvec3>& positions) {
    std::map<std::tuple<double, double, double>, std::size_t> first;
    std::vector<std::size_t> result;
    result.reserve(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const glm::dvec3& p = positions[v];
        result.push_back(first.emplace(std::make_tuple(p.x, p.y, p.z), v).first->second);
    }
    return result;
}

/// Corner normals, smooth over the skin and weighted by area. Vertices at the same position share a
/// normal, so that texture seams do not show.
std::vector<glm::vec3> smoothNormals(const SkinMesh& mesh) {
    const std::vector<std::size_t> welded = weld(mesh.positions);
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    // Bodies may have any unit: scaled to size 1, squared lengths neither overflow nor vanish.
    const double extent = mesh.size();
    const double scale = extent > 0.0 ? 1.0 / extent : 1.0;
    // A polygon's normal is the sum of its triangles' (Newell). All its corners get the same one,
    // so that its triangulation does not show in the shading.
    const std::uint32_t* corners = mesh.faceVertices.data();
    for (const std::uint32_t size : mesh.faceSizes) {
        const glm::dvec3& origin = mesh.positions[corners[0]];
        glm::dvec3 normal(0.0);
        for (std::uint32_t k = 2; k < size; ++k)
            normal += glm::cross((mesh.positions[corners[k - 1]] - origin) * scale,
                                 (mesh.positions[corners[k]] - origin) * scale);
        for (std::uint32_t k = 0; k < size; ++k) sums[welded[corners[k]]] += normal;
        corners += size;
    }
    std::vector<glm::vec3> result;
    result.reserve(mesh.faceVertices.size());
    for (const std::uint32_t v : mesh.faceVertices) {
        const double length = glm::length(sums[welded[v]]);
        // Any unit vector if all faces around the vertex are degenerate.
        result.emplace_back(length > 0.0 ? sums[welded[v]] / length : glm::dvec3(0.0, 1.0, 0.0));
    }
    return result;
}

/// A material's area, and the part of it whose normals point to the back of the faces.
struct Areas {
    double all = 0.0, contradicting = 0.0;

    /// The threshold exceeds half because two-sided sheets may share one set of normals.
    bool areMostlyWrong() const { return contradicting > 0.6 * all; }
};

std::vector<Areas> areasOf(const CornerMesh& mesh) {
    std::vector<Areas> result(mesh.stateSets.size());
    const double extent = mesh.mesh.size(), scale = extent > 0.0 ? 1.0 / extent : 1.0;
    std::size_t first = 0;
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f) {
        const std::size_t size = mesh.mesh.faceSizes[f];
        const auto corner = [&](std::size_t k) {
            return mesh.mesh.positions[mesh.mesh.faceVertices[first + k]];
        };
        glm::dvec3 face(0.0), given(0.0);
        for (std::size_t k = 2; k < size; ++k)
            face +=
                glm::cross((corner(k - 1) - corner(0)) * scale, (corner(k) - corner(0)) * scale);
        for (std::size_t k = 0; k < size; ++k) given += glm::dvec3(mesh.normals[first + k]);
        first += size;
        if (mesh.materials[f] >= result.size()) continue;
        Areas& areas = result[mesh.materials[f]];
        areas.all += glm::length(face);
        if (glm::dot(face, given) < 0.0) areas.contradicting += glm::length(face);
    }
    return result;
}

/// Recomputes a material's normals, smooth over the skin, if over most of its area they point to
/// the back of the faces: exporters mirror one without the other. Reports this in a notice.
/// \param mesh with unit normals
/// \param path of the file
void mendNormals(CornerMesh& mesh, const std::string& path) {
    const std::vector<Areas> areas = areasOf(mesh);
    std::vector<glm::vec3> computed;
    std::vector<bool> isMended(mesh.mesh.positions.size(), false);
    std::size_t first = 0, faces = 0;
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f) {
        const std::size_t size = mesh.mesh.faceSizes[f], begin = first;
        first += size;
        if (mesh.materials[f] >= areas.size() || !areas[mesh.materials[f]].areMostlyWrong())
            continue;
        if (computed.empty()) computed = smoothNormals(mesh.mesh);
        for (std::size_t k = begin; k < first; ++k) {
            mesh.normals[k] = computed[k];
            isMended[mesh.mesh.faceVertices[k]] = true;
        }
        ++faces;
    }
    if (faces == 0) return;
    for (MorphTarget& target : mesh.morphs)
        for (std::size_t i = 0; i < target.normals.size(); ++i)
            if (isMended[target.vertices[i]]) target.normals[i] = glm::vec3(0.0f);
    warn(path, "the normals of " + std::to_string(faces) + " of " +
                   std::to_string(mesh.mesh.faceSizes.size()) +
                   " faces point to the back of the faces; recomputed");
}

/// A vector's part perpendicular to a unit normal, of unit length; zero if there is none.
glm::dvec3 alongSurface(const glm::dvec3& vector, const glm::dvec3& normal) {
    const glm::dvec3 along = vector - normal * glm::dot(vector, normal);
    const double length = glm::length(along);
    return std::isfinite(length) && length > 0.0 ? along / length : glm::dvec3(0.0);
}

/// Computes the tangents of faces with a normal map by their texture coordinates.
///
/// As MikkTSpace, with which normal maps are made: corners that share position, normal, texture
/// coordinates and handedness share the mean of their faces' tangents, weighted by angle.
class TangentBuilder {
public:
    explicit TangentBuilder(const CornerMesh& mesh)
        : _mesh(mesh), _welded(weld(mesh.mesh.positions)),
          _isMirrored(mesh.mesh.faceVertices.size(), false) {}

    /// \param corners three indices in the mesh's `faceVertices`
    void addTriangle(const std::uint32_t* corners) {
        glm::dvec3 p[3];
        glm::dvec2 t[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = _mesh.mesh.positions[_mesh.mesh.faceVertices[corners[k]]];
            t[k] = glm::dvec2(_mesh.texCoords[corners[k]]);
        }
        const glm::dvec2 a = t[1] - t[0], b = t[2] - t[0];
        const double area = a.x * b.y - b.x * a.y;
        if (area == 0.0) return;
        const glm::dvec3 alongU = ((p[1] - p[0]) * b.y - (p[2] - p[0]) * a.y) / area;
        for (int k = 0; k < 3; ++k) {
            _isMirrored[corners[k]] = area < 0.0;
            const glm::dvec3 normal(_mesh.normals[corners[k]]);
            const double cosine = glm::dot(alongSurface(p[(k + 1) % 3] - p[k], normal),
                                           alongSurface(p[(k + 2) % 3] - p[k], normal));
            _sums[keyOf(corners[k], area < 0.0)] +=
                std::acos(std::clamp(cosine, -1.0, 1.0)) * alongSurface(alongU, normal);
        }
    }

    /// A corner's tangent; any one along the surface where texture coordinates give none.
    glm::vec4 tangent(std::size_t corner) const {
        const glm::dvec3 normal(_mesh.normals[corner]);
        for (const bool isMirrored : {bool(_isMirrored[corner]), !_isMirrored[corner]}) {
            const auto sum = _sums.find(keyOf(corner, isMirrored));
            const glm::dvec3 mean =
                sum != _sums.end() ? alongSurface(sum->second, normal) : glm::dvec3(0.0);
            if (mean != glm::dvec3(0.0)) return {glm::vec3(mean), isMirrored ? -1.0f : 1.0f};
        }
        const glm::dvec3 axis =
            std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        return {glm::vec3(alongSurface(axis, normal)), 1.0f};
    }

private:
    using Key = std::pair<std::size_t, std::array<float, 6>>;

    Key keyOf(std::size_t corner, bool isMirrored) const {
        const glm::vec3& n = _mesh.normals[corner];
        const glm::vec2& t = _mesh.texCoords[corner];
        return {_welded[_mesh.mesh.faceVertices[corner]],
                {n.x, n.y, n.z, t.x, t.y, isMirrored ? -1.0f : 1.0f}};
    }

    const CornerMesh& _mesh;
    std::vector<std::size_t> _welded;
    std::vector<bool> _isMirrored; ///< per corner
    std::map<Key, glm::dvec3> _sums;
};

/// Completes the tangents of faces whose material has a normal map; clears all others.
void finishTangents(CornerMesh& mesh) {
    std::vector<bool> needed;
    for (const osg::ref_ptr<osg::StateSet>& state : mesh.stateSets)
        needed.push_back(hasNormalMap(*state));
    if (!mesh.hasTexCoords || std::count(needed.begin(), needed.end(), true) == 0) {
        mesh.tangents.clear();
        return;
    }
    mesh.tangents.resize(mesh.normals.size(), glm::vec4(0.0f));
    TangentBuilder builder(mesh);
    const std::vector<std::uint32_t> corners = mesh.mesh.triangleCorners();
    const std::uint32_t* triangle = corners.data();
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f)
        for (std::uint32_t k = 2; k < mesh.mesh.faceSizes[f]; ++k, triangle += 3)
            if (needed[mesh.materials[f]]) builder.addTriangle(triangle);
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f)
        for (std::uint32_t k = 0; k < mesh.mesh.faceSizes[f]; ++k, ++corner) {
            glm::vec4& tangent = mesh.tangents[corner];
            const glm::vec3 given(
                alongSurface(glm::dvec3(glm::vec3(tangent)), glm::dvec3(mesh.normals[corner])));
            if (!needed[mesh.materials[f]])
                tangent = glm::vec4(0.0f);
            else if (given != glm::vec3(0.0f))
                tangent = glm::vec4(given, tangent.w < 0.0f ? -1.0f : 1.0f);
            else
                tangent = builder.tangent(corner);
        }
}

/// Builds a part from its triangles.
class PartBuilder {
public:
    explicit PartBuilder(const CornerMesh& source) : _source(source) {}

    /// \param face index of the face in the mesh
    /// \param corners three indices in the mesh's `faceVertices`
    void addTriangle(std::uint32_t face, const std::uint32_t* corners) {
        for (int k = 0; k < 3; ++k) _triangles->push_back(vertex(corners[k]));
        _part.sourceFace.push_back(face);
    }

    MeshPart finish(osg::StateSet* stateSet, const MorphsByVertex& morphs) {
        _part.morphs = morphs.ofCopies(_part.sourceVertex);
        _part.geometry = new osg::Geometry;
        osg::Geometry& geometry = *_part.geometry;
        geometry.setVertexArray(_positions);
        geometry.setNormalArray(_normals, osg::Array::BIND_PER_VERTEX);
        if (_source.hasTexCoords)
            geometry.setTexCoordArray(0, _texCoords, osg::Array::BIND_PER_VERTEX);
        if (!_colours->empty()) geometry.setColorArray(_colours, osg::Array::BIND_PER_VERTEX);
        if (!_tangents->empty() && hasNormalMap(*stateSet))
            geometry.setVertexAttribArray(MeshPart::kTangentAttribute, _tangents,
                                          osg::Array::BIND_PER_VERTEX);
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
        const bool hasTangents = !_source.tangents.empty();
        const glm::vec4 u = hasTangents ? _source.tangents[corner] : glm::vec4(0.0f);
        const Key key{source, {n.x, n.y, n.z, t.x, t.y, c.r, c.g, c.b, c.a, u.x, u.y, u.z, u.w}};
        const auto [entry, isNew] = _copies.emplace(key, static_cast<unsigned>(_positions->size()));
        if (isNew) {
            _positions->push_back(osg::Vec3(toOsg(_source.mesh.positions[source])));
            _normals->push_back(osg::Vec3(toOsg(glm::dvec3(n))));
            _texCoords->push_back({t.x, t.y});
            if (coloured) _colours->push_back({c.r, c.g, c.b, c.a});
            if (hasTangents) _tangents->push_back({u.x, u.y, u.z, u.w});
            _part.sourceVertex.push_back(source);
        }
        return entry->second;
    }

    using Key = std::pair<std::uint32_t, std::array<float, 13>>;

    const CornerMesh& _source;
    MeshPart _part;
    std::map<Key, unsigned> _copies;
    osg::ref_ptr<osg::Vec3Array> _positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> _normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> _texCoords = new osg::Vec2Array;
    osg::ref_ptr<osg::Vec4Array> _colours = new osg::Vec4Array;
    osg::ref_ptr<osg::Vec4Array> _tangents = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUInt> _triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
};

/// Builds a drawable part for each material in use. A vertex is duplicated if its corners differ in
/// normal, texture coordinates, colour or tangent.
std::vector<MeshPart> makeMeshParts(const CornerMesh& source) {
    std::vector<PartBuilder> builders;
    builders.reserve(source.stateSets.size());
    for (std::size_t m = 0; m < source.stateSets.size(); ++m) builders.emplace_back(source);
    const std::vector<std::uint32_t> corners = source.mesh.triangleCorners();
    const std::uint32_t* triangle = corners.data();
    for (std::uint32_t f = 0; f < source.mesh.faceSizes.size(); ++f)
        for (std::uint32_t k = 2; k < source.mesh.faceSizes[f]; ++k, triangle += 3)
            builders[source.materials[f]].addTriangle(f, triangle);
    const MorphsByVertex morphs(source.morphs);
    std::vector<MeshPart> result;
    for (std::size_t m = 0; m < builders.size(); ++m)
        if (!builders[m].empty()) result.push_back(builders[m].finish(source.stateSets[m], morphs));
    return result;
}

constexpr std::size_t kElementsOfVertex = 14;   ///< of 64 bytes each, half a sample
constexpr std::size_t kSamplesOfMaterial = 500; ///< a drawable takes 50 kilobytes

/// Normalises all normals; false if some are missing.
bool normalise(std::vector<glm::vec3>& normals) {
    for (glm::vec3& n : normals) {
        const double length = glm::length(glm::dvec3(n));
        if (!std::isfinite(length) || !(length > 0.0)) return false;
        n = glm::vec3(glm::dvec3(n) / length);
    }
    return true;
}

/// No colour is brighter than this: larger values range to 255.
constexpr float kTooBright = 16.0f;

/// Whether colours, or alphas, range from 0 to 255 and not to 1, as some programs write them,
/// usually as integers.
bool countsTo255(const std::vector<glm::vec4>& colours, int first, int end) {
    float max = 0.0f;
    bool areWhole = true;
    for (const glm::vec4& colour : colours)
        for (int k = first; k < end; ++k) {
            areWhole = areWhole && colour[k] == std::floor(colour[k]); // also false for NaN
            max = std::max(max, colour[k]);
        }
    return max > (areWhole ? 1.0f : kTooBright) && max <= 255.0f;
}

void finishColours(std::vector<glm::vec4>& colours) {
    const float rgb = countsTo255(colours, 0, 3) ? 255.0f : 1.0f;
    const float alpha = countsTo255(colours, 3, 4) ? 255.0f : 1.0f;
    for (glm::vec4& colour : colours) {
        colour /= glm::vec4(rgb, rgb, rgb, alpha);
        for (int k = 0; k < 4; ++k)
            colour[k] = std::isfinite(colour[k]) ? std::clamp(colour[k], 0.0f, 1.0f) : 1.0f;
    }
}

/// A material as it is with the colours of vertices in place of its own; null where it has
/// textures, a program, vertex colours already, or is transparent.
osg::ref_ptr<osg::StateSet> withVertexColours(const osg::StateSet& state) {
    const auto* const material =
        dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL));
    const auto side = osg::Material::FRONT_AND_BACK;
    if (!material || !state.getTextureAttributeList().empty() ||
        state.getAttribute(osg::StateAttribute::PROGRAM) ||
        material->getColorMode() != osg::Material::OFF || material->getDiffuse(side).a() != 1.0f ||
        material->getAmbient(side) != material->getDiffuse(side))
        return nullptr;
    const osg::ref_ptr<osg::StateSet> result =
        osg::clone(&state, osg::CopyOp(osg::CopyOp::DEEP_COPY_STATEATTRIBUTES));
    auto& own = static_cast<osg::Material&>(*result->getAttribute(osg::StateAttribute::MATERIAL));
    own.setAmbient(side, osg::Vec4(1, 1, 1, 1));
    own.setDiffuse(side, osg::Vec4(1, 1, 1, 1));
    own.setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    own.setName("");
    result->setName("");
    return result;
}

/// Makes one material of those that differ in their colour alone.
void mergeColours(CornerMesh& mesh) {
    std::vector<osg::ref_ptr<osg::StateSet>> merged(mesh.stateSets.size());
    std::vector<std::uint32_t> target(mesh.stateSets.size());
    for (std::uint32_t m = 0; m < merged.size(); ++m) {
        target[m] = m;
        merged[m] = withVertexColours(*mesh.stateSets[m]);
        for (std::uint32_t k = 0; k < m && merged[m]; ++k)
            if (merged[k] && target[k] == k && merged[m]->compare(*merged[k], true) == 0) {
                target[m] = k;
                break;
            }
    }
    const auto isShared = [&](std::uint32_t m) {
        return std::count(target.begin(), target.end(), target[m]) > 1;
    };
    if (mesh.colours.empty()) mesh.colours.assign(mesh.normals.size(), glm::vec4(1.0f));
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f) {
        const std::uint32_t m = mesh.materials[f];
        const std::size_t end = corner + mesh.mesh.faceSizes[f];
        if (isShared(m)) {
            const auto& material = static_cast<const osg::Material&>(
                *mesh.stateSets[m]->getAttribute(osg::StateAttribute::MATERIAL));
            const osg::Vec4& colour = material.getDiffuse(osg::Material::FRONT_AND_BACK);
            for (std::size_t k = corner; k < end; ++k)
                mesh.colours[k] = {colour.r(), colour.g(), colour.b(), colour.a()};
            mesh.materials[f] = target[m];
        }
        corner = end;
    }
    for (std::uint32_t m = 0; m < merged.size(); ++m)
        if (target[m] == m && isShared(m)) mesh.stateSets[m] = merged[m];
}

/// Throws osgSkin::Error if an offset is not finite or too large.
void checkMorphs(const std::vector<MorphTarget>& morphs, const std::string& path) {
    for (const MorphTarget& target : morphs)
        for (const auto* offsets : {&target.positions, &target.normals, &target.tangents})
            for (std::size_t i = 0; i < offsets->size(); ++i)
                if (!isInRange((*offsets)[i]))
                    failFile(path, "morph target " + inQuotes(target.name) +
                                       ": its offset of vertex " +
                                       std::to_string(target.vertices[i]) +
                                       " is not finite, or beyond -1e18 to 1e18");
}

std::size_t samplesFor(const std::string& path, const ReadLimits& limits) {
    std::error_code failure;
    const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(path, failure));
    return limits.samplesOf(failure ? 0 : bytes);
}

} // namespace

void checkVertices(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits) {
    const std::size_t limit = 2 * samplesFor(path, limits);
    if (kElementsOfVertex * mesh.mesh.positions.size() > limit)
        failFile(path, std::to_string(mesh.mesh.positions.size()) + " vertices, expected at most " +
                           std::to_string(limit / kElementsOfVertex) + " (option maxSamples)");
}

void checkMaterials(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits) {
    const std::size_t limit = samplesFor(path, limits) / kSamplesOfMaterial;
    const std::set<std::uint32_t> used(mesh.materials.begin(), mesh.materials.end());
    if (used.size() > limit)
        failFile(path, std::to_string(used.size()) + " materials, expected at most " +
                           std::to_string(limit) + " (option maxSamples)");
}

ImportedMesh finishMesh(CornerMesh read, const std::string& path, const ReadLimits& limits) {
    if (read.mesh.faceSizes.empty()) failFile(path, "no face, expected at least one");
    try {
        read.mesh.validate();
    } catch (const Error& error) {
        failFile(path, error.what());
    }
    if (read.mesh.size() == 0.0) failFile(path, "all vertices are at the same position");
    checkMorphs(read.morphs, path);
    if (normalise(read.normals)) {
        mendNormals(read, path);
    } else {
        read.normals = smoothNormals(read.mesh);
        for (MorphTarget& target : read.morphs) target.normals.clear();
        read.tangents.clear();
    }
    for (glm::vec2& t : read.texCoords)
        if (!std::isfinite(t.x) || !std::isfinite(t.y)) t = glm::vec2(0.0f);
    finishColours(read.colours);
    if (limits.mergesColours) mergeColours(read);
    finishTangents(read);

    ImportedMesh result;
    result.parts = makeMeshParts(read);
    result.weights = std::move(read.weights);
    result.mesh = std::move(read.mesh);
    return result;
}

} // namespace osgSkin
