// SPDX-License-Identifier: MIT
#include "Surface.h"

#include "Bytes.h"

#include <osgSkin/GlmOsg>

#include <glm/geometric.hpp>
#include <osg/AlphaFunc>
#include <osg/Geometry>
#include <osg/Material>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <sstream>

namespace bake {

namespace {

using osgSkin::Character;
using osgSkin::MeshPart;

std::vector<const MeshPart*> piecesOf(const Character& character) {
    std::vector<const MeshPart*> pieces;
    for (const auto& skin : character.skin.skins) pieces.push_back(&skin.part);
    for (const auto& rigid : character.skin.rigids) pieces.push_back(&rigid.part);
    return pieces;
}

template <typename Array>
const Array* perVertex(const osg::Array* array, std::size_t vertices) {
    const auto* typed = dynamic_cast<const Array*>(array);
    return typed != nullptr && typed->size() == vertices ? typed : nullptr;
}

/// Merges the drawables that share a state set.
class Gatherer {
public:
    void add(std::uint32_t piece, const MeshPart& part) {
        const osg::Geometry& geometry = *part.geometry;
        const std::size_t count = part.sourceVertex.size();
        const auto* normals = perVertex<osg::Vec3Array>(geometry.getNormalArray(), count);
        const auto* texCoords = perVertex<osg::Vec2Array>(geometry.getTexCoordArray(0), count);
        const auto* colours = perVertex<osg::Vec4Array>(geometry.getColorArray(), count);
        std::vector<std::uint32_t> indices(count);
        for (std::uint32_t v = 0; v < count; ++v) {
            Vertex vertex;
            vertex.source = part.sourceVertex[v];
            vertex.drawn = {piece, v};
            if (normals != nullptr) vertex.normal = (*normals)[v];
            if (texCoords != nullptr) vertex.texCoord = (*texCoords)[v];
            if (colours != nullptr) vertex.colour = (*colours)[v];
            indices[v] = add(vertex);
        }
        _hasTexCoords = _hasTexCoords || texCoords != nullptr;
        _hasColours = _hasColours || colours != nullptr;
        const auto& corners =
            static_cast<const osg::DrawElementsUInt&>(*geometry.getPrimitiveSet(0));
        for (std::size_t t = 0; t < part.sourceFace.size(); ++t)
            _triangles.push_back({part.sourceFace[t],
                                  {indices[corners[3 * t]], indices[corners[3 * t + 1]],
                                   indices[corners[3 * t + 2]]}});
    }

    Surface finish(osg::StateSet* state) {
        std::vector<std::uint32_t> order(_vertices.size()), newIndex(_vertices.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return _vertices[a].source < _vertices[b].source;
        });
        Surface result;
        result.state = state;
        for (std::uint32_t k = 0; k < order.size(); ++k) {
            const Vertex& vertex = _vertices[order[k]];
            newIndex[order[k]] = k;
            result.sourceVertex.push_back(vertex.source);
            result.drawn.push_back(vertex.drawn);
            const glm::dvec3 normal = osgSkin::toGlm(osg::Vec3d(vertex.normal));
            const double length = glm::length(normal);
            result.restNormals.push_back(length > 0.0 ? normal / length : glm::dvec3(0, 1, 0));
            if (_hasTexCoords) result.texCoords.push_back(vertex.texCoord);
            if (_hasColours) result.colours.push_back(vertex.colour);
        }
        std::stable_sort(_triangles.begin(), _triangles.end(),
                         [](const Triangle& a, const Triangle& b) { return a.face < b.face; });
        for (const Triangle& triangle : _triangles) {
            for (const std::uint32_t v : triangle.vertices) result.triangles.push_back(newIndex[v]);
            result.sourceFace.push_back(triangle.face);
        }
        return result;
    }

private:
    struct Vertex {
        std::uint32_t source = 0;
        Surface::Drawn drawn;
        osg::Vec3 normal;
        osg::Vec2 texCoord;
        osg::Vec4 colour{1.0f, 1.0f, 1.0f, 1.0f};
    };
    struct Triangle {
        std::uint32_t face;
        std::array<std::uint32_t, 3> vertices;
    };

    std::uint32_t add(const Vertex& vertex) {
        const osg::Vec3& n = vertex.normal;
        const osg::Vec2& t = vertex.texCoord;
        const osg::Vec4& c = vertex.colour;
        const Key key{vertex.source,
                      {n.x(), n.y(), n.z(), t.x(), t.y(), c.r(), c.g(), c.b(), c.a()}};
        const auto [entry, isNew] =
            _indices.emplace(key, static_cast<std::uint32_t>(_vertices.size()));
        if (isNew) _vertices.push_back(vertex);
        return entry->second;
    }

    using Key = std::pair<std::uint32_t, std::array<float, 9>>;
    std::map<Key, std::uint32_t> _indices;
    std::vector<Vertex> _vertices;
    std::vector<Triangle> _triangles;
    bool _hasTexCoords = false, _hasColours = false;
};

} // namespace

std::vector<glm::dvec3> Surface::normals(const Character& character) const {
    const std::size_t skins = character.skin.skins.size();
    std::vector<const osg::Vec3Array*> arrays;
    std::vector<osg::Matrixd> matrices(skins);
    for (const auto& skin : character.skin.skins)
        arrays.push_back(static_cast<const osg::Vec3Array*>(
            skin.drawable->getDeformedGeometry()->getNormalArray()));
    for (const auto& rigid : character.skin.rigids) {
        arrays.push_back(static_cast<const osg::Vec3Array*>(rigid.drawn().getNormalArray()));
        matrices.push_back(rigid.node->getMatrix() * rigid.bone->getMatrixInSkeletonSpace());
    }
    std::vector<glm::dvec3> result;
    result.reserve(drawn.size());
    for (const Drawn& at : drawn) {
        const glm::dvec3 normal = osgSkin::toGlm(osg::Matrixd::transform3x3(
            osg::Vec3d((*arrays[at.piece])[at.vertex]), matrices[at.piece]));
        const double length = glm::length(normal);
        result.push_back(length > 0.0 ? normal / length : glm::dvec3(0.0, 1.0, 0.0));
    }
    return result;
}

std::vector<Surface> surfacesOf(const Character& character) {
    const std::vector<const MeshPart*> pieces = piecesOf(character);
    std::vector<osg::StateSet*> states;
    for (const MeshPart& part : character.body.parts)
        if (osg::StateSet* state = part.geometry->getStateSet();
            std::find(states.begin(), states.end(), state) == states.end())
            states.push_back(state);
    std::vector<Surface> result;
    for (osg::StateSet* state : states) {
        Gatherer gatherer;
        for (std::uint32_t p = 0; p < pieces.size(); ++p)
            if (pieces[p]->geometry->getStateSet() == state) gatherer.add(p, *pieces[p]);
        result.push_back(gatherer.finish(state));
    }
    return result;
}

SurfaceMaterial SurfaceMaterial::of(const Surface& surface) {
    SurfaceMaterial material;
    const osg::StateSet& state = *surface.state;
    const auto* attribute =
        dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL));
    material.vertexColours =
        !surface.colours.empty() &&
        (attribute == nullptr || attribute->getColorMode() != osg::Material::OFF);
    if (attribute != nullptr) {
        material.diffuse = attribute->getDiffuse(osg::Material::FRONT);
        material.specular = attribute->getSpecular(osg::Material::FRONT);
        material.emission = attribute->getEmission(osg::Material::FRONT);
        material.shininess = attribute->getShininess(osg::Material::FRONT);
    }
    if (material.vertexColours) material.diffuse = {1.0f, 1.0f, 1.0f, 1.0f};
    const auto* texture = dynamic_cast<const osg::Texture*>(
        state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    if (texture != nullptr && !surface.texCoords.empty()) {
        material.image = texture->getImage(0);
        material.wrapS = texture->getWrap(osg::Texture::WRAP_S);
        material.wrapT = texture->getWrap(osg::Texture::WRAP_T);
    }
    material.twoSided = (state.getMode(GL_CULL_FACE) & osg::StateAttribute::ON) == 0;
    const auto* test =
        dynamic_cast<const osg::AlphaFunc*>(state.getAttribute(osg::StateAttribute::ALPHAFUNC));
    if ((state.getMode(GL_BLEND) & osg::StateAttribute::ON) != 0) {
        material.alpha = Alpha::Blend;
    } else if (test != nullptr) {
        material.alpha = Alpha::Mask;
        material.alphaCutOff = test->getReferenceValue();
    }
    return material;
}

std::vector<osg::Vec4> vertexColoursOf(const std::vector<Surface>& surfaces,
                                       const osgSkin::SkinMesh& mesh) {
    std::vector<osg::Vec4> result;
    for (const Surface& surface : surfaces) {
        if (!SurfaceMaterial::of(surface).vertexColours) continue;
        result.resize(mesh.positions.size(), {1.0f, 1.0f, 1.0f, 1.0f});
        for (std::size_t v = 0; v < surface.colours.size(); ++v)
            for (unsigned k = 0; k < 4; ++k)
                result[surface.sourceVertex[v]][k] = std::clamp(surface.colours[v][k], 0.0f, 1.0f);
    }
    return result;
}

osg::Vec4 linear(const osg::Vec4& srgb) {
    osg::Vec4 result = srgb;
    for (unsigned k = 0; k < 3; ++k) {
        const float value = srgb[k];
        result[k] = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
    }
    return result;
}

namespace {

/// The images' names in the library at `file`. Writes images that have no file.
class Images {
public:
    Images(std::string file, std::string folder)
        : _file(std::move(file)), _folder(std::move(folder)) {}

    std::string nameOf(const osg::Image& image) {
        const auto [entry, isNew] = _names.emplace(&image, std::string());
        if (!isNew) return entry->second;
        const std::optional<ImageBytes> bytes = bytesOf(image, _folder);
        if (!bytes) return entry->second;
        if (!bytes->file.empty()) {
            // Resolve links first: a relative path with ".." would follow their targets.
            const auto file = std::filesystem::weakly_canonical(bytes->file);
            const auto here = std::filesystem::weakly_canonical(_file).parent_path();
            return entry->second = file.lexically_proximate(here).string();
        }
        const std::string name = osgDB::getNameLessExtension(_file) + "_" +
                                 std::to_string(++_written) + (bytes->isJpeg ? ".jpg" : ".png");
        writeBytes(name, bytes->data);
        return entry->second = osgDB::getSimpleFileName(name);
    }

private:
    std::string _file, _folder;
    std::map<const osg::Image*, std::string> _names;
    int _written = 0;
};

std::ostream& operator<<(std::ostream& out, const osg::Vec4& c) {
    return out << c.r() << ' ' << c.g() << ' ' << c.b();
}

} // namespace

std::string libraryName(const std::string& pattern) {
    std::string stem = osgDB::getStrippedName(pattern);
    const std::size_t percent = stem.find('%');
    if (percent != std::string::npos) {
        stem = stem.substr(0, percent) + stem.substr(stem.find('d', percent) + 1);
        while (!stem.empty() && std::string("_-. ").find(stem.back()) != std::string::npos)
            stem.pop_back();
        if (stem.empty()) stem = "frame";
    }
    return stem + ".mtl";
}

std::string materialName(std::size_t surface) {
    return "skin_" + std::to_string(surface + 1);
}

void writeLibrary(const std::string& file, const std::vector<Surface>& surfaces,
                  const std::string& folder) {
    Images images(file, folder);
    std::ostringstream out;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const SurfaceMaterial material = SurfaceMaterial::of(surfaces[s]);
        out << "newmtl " << materialName(s) << "\nKd " << material.diffuse << "\nKs "
            << material.specular << "\nKe " << material.emission << "\nNs " << material.shininess
            << "\nd "
            << (material.alpha == SurfaceMaterial::Alpha::Opaque ? 1.0f : material.diffuse.a())
            << "\nillum 2\n";
        if (!material.image) continue;
        const std::string name = images.nameOf(*material.image);
        if (!name.empty()) out << "map_Kd " << name << "\n";
    }
    writeBytes(file, out.str());
}

} // namespace bake
