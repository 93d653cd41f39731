// SPDX-License-Identifier: MIT
#include "scene/SceneMesh.h"

#include "files/FileText.h"
#include "scene/SceneBind.h"
#include "scene/SceneSkeleton.h"

#include <osgSkin/GlmOsg>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <osg/BoundingBox>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

// --- materials ---

/// A linear colour in sRGB; alpha is kept.
glm::vec4 toSrgb(const glm::vec4& linear) {
    return {osgSkin::toSrgb(linear.x), osgSkin::toSrgb(linear.y), osgSkin::toSrgb(linear.z),
            linear.w};
}

/// An image embedded in the file; null if it cannot be decoded.
osg::ref_ptr<osg::Image> decodeImage(const SourceImage& source, const std::string& path,
                                     ImageReader& imageReader) {
    return source.image ? source.image : imageReader.read(path, source.format, source.bytes);
}

/// State sets of the materials, and vertex colours.
class Materials {
public:
    Materials(const SourceScene& scene, const std::string& path, const osgDB::Options* options)
        : _scene(scene) {
        for (const auto& mesh : scene.meshes) _hasColours = _hasColours || !mesh->colours.empty();
        TextureReads reads(path, options);
        for (const SourceMaterial& source : scene.materials) {
            Material material = source.material;
            for (std::size_t map = 0; map < Material::kMaps; ++map)
                material.textures[map].image = imageOf(source.textures[map], path, options, reads);
            // Without its texture, the colour would make the whole surface glow.
            if (!source.textures[Material::Emission].name.empty() &&
                !material.textures[Material::Emission].image)
                material.emission = {0.0f, 0.0f, 0.0f, 1.0f};
            material.vertexColours = _hasColours;
            stateSets.push_back(makeStateSet(material));
        }
    }

    /// Whether some mesh has vertex colours; then all get them, some from their material.
    bool hasColours() const { return _hasColours; }

    /// A vertex's colour in sRGB; its material's if it has none.
    glm::vec4 colour(const SourceMesh& mesh, std::size_t vertex) const {
        const SourceMaterial& material = _scene.materials[mesh.material];
        const osg::Vec4& diffuse = material.material.diffuse;
        const glm::vec4 plain(diffuse.r(), diffuse.g(), diffuse.b(), diffuse.a());
        if (mesh.colours.empty()) return plain;
        const glm::vec4& own = mesh.colours[vertex];
        if (material.isLinear) return toSrgb(own) * plain;
        return own * glm::vec4(1.0f, 1.0f, 1.0f, plain.a);
    }

    std::vector<osg::ref_ptr<osg::StateSet>> stateSets; ///< [material]

private:
    osg::ref_ptr<osg::Image> imageOf(const SourceTexture& texture, const std::string& path,
                                     const osgDB::Options* options, TextureReads& reads) const {
        if (!texture.image) return readTexture(texture.name, path, options, reads);
        ImageReader& imageReader = reads.imageReader();
        return reads.once(texture.name, [&] {
            return imageReader.shared().once(path, texture.name, [&] {
                return decodeImage(*_scene.images[*texture.image], path, imageReader);
            });
        });
    }

    const SourceScene& _scene;
    bool _hasColours = false;
};

// --- placement ---

glm::dvec3 placed(const glm::dmat4& matrix, const glm::vec3& vertex) {
    return glm::dvec3(matrix * glm::dvec4(vertex, 1.0));
}

/// The joints that meshes may be parented to; none if nothing is skinned.
std::set<const SourceNode*> jointsOfSkins(const SourceScene& scene, const SceneBind& bind) {
    for (const SourceNode* node : bind.nodes())
        if (bind.isBone(*node)) return jointNodes(scene, bind);
    return {};
}

// --- meshes that were bound in another pose ---

bool counts(const SourceMesh& mesh, const SourceBone::Weight& entry) {
    return entry.vertex < mesh.positions.size() && std::isfinite(entry.weight) &&
           entry.weight > 0.0f;
}

/// A mesh's transform by one of its bones; `toScene` if the bone's offset matrix is singular.
glm::dmat4 placeBy(const SourceBone& bone, const glm::dmat4& toScene, const SceneBind& bind) {
    const double volume = glm::determinant(glm::dmat3(bone.offset));
    const SourceNode* const node = bind.find(bone.name);
    if (node == nullptr || !std::isfinite(volume) || volume == 0.0) return toScene;
    return bind.node(*node) * bone.offset;
}

/// Calls `use` with each valid weight, and the mesh's transform by its bone.
template <typename Use>
void forEachWeight(const SourceMesh& mesh, const glm::dmat4& toScene, const SceneBind& bind,
                   const Use& use) {
    for (const SourceBone& bone : mesh.bones) {
        const glm::dmat4 own = placeBy(bone, toScene, bind);
        for (const SourceBone::Weight& entry : bone.weights)
            if (counts(mesh, entry)) use(entry, own);
    }
}

/// For a mesh that was bound in another pose than the meshes that share its bones: the transform of
/// each vertex into the common bind pose, blended from its bones by weight.
///
/// \param mesh any
/// \param toScene the mesh's transform, as returned by bind.mesh()
/// \param bind of the scene
/// \return a matrix for each vertex, from the mesh's space to the scene's; empty if `toScene` fits
///        all vertices within a thousandth of the mesh's size
std::vector<glm::dmat4> perVertexBindPose(const SourceMesh& mesh, const glm::dmat4& toScene,
                                          const SceneBind& bind) {
    constexpr double kOff = 1e-3; // relative rounding error in files
    if (mesh.bones.empty()) return {};
    osg::BoundingBoxd box;
    for (const glm::vec3& vertex : mesh.positions) box.expandBy(toOsg(placed(toScene, vertex)));
    const double tolerance = box.valid() ? kOff * 2.0 * box.radius() : 0.0;
    bool isApart = false;
    forEachWeight(mesh, toScene, bind, [&](const SourceBone::Weight& entry, const glm::dmat4& own) {
        const glm::vec3& vertex = mesh.positions[entry.vertex];
        isApart =
            isApart || glm::distance(placed(own, vertex), placed(toScene, vertex)) > tolerance;
    });
    if (!isApart) return {};
    std::vector<glm::dmat4> result(mesh.positions.size(), glm::dmat4(0.0));
    std::vector<double> sums(mesh.positions.size(), 0.0);
    forEachWeight(mesh, toScene, bind, [&](const SourceBone::Weight& entry, const glm::dmat4& own) {
        result[entry.vertex] += double(entry.weight) * own;
        sums[entry.vertex] += double(entry.weight);
    });
    for (std::size_t v = 0; v < result.size(); ++v)
        result[v] = sums[v] > 0.0 ? result[v] / sums[v] : toScene;
    return result;
}

// --- the mesh ---

constexpr std::uint32_t kUnused = ~0u;

/// The index of each vertex of a mesh in the result if the first is `first`; kUnused for vertices
/// that no face uses. Meshes that share vertices, such as one body's materials, each contain all of
/// them.
std::vector<std::uint32_t> indicesOf(const SourceMesh& source, std::size_t first,
                                     const std::string& where) {
    std::vector<std::uint32_t> result(source.positions.size(), kUnused);
    std::size_t corner = 0;
    for (std::size_t f = 0; f < source.faceSizes.size(); ++f) {
        const std::size_t end = corner + source.faceSizes[f];
        const bool isFace = source.faceSizes[f] >= 3; // not a point or a line
        for (; corner < end; ++corner) {
            if (!isFace) continue;
            const std::uint32_t v = source.corners[corner];
            if (v >= result.size())
                failFile(where, "face " + std::to_string(f) + " names vertex " + std::to_string(v) +
                                    ", expected less than " + std::to_string(result.size()));
            result[v] = 0;
        }
    }
    for (std::uint32_t& index : result) {
        if (index == kUnused) continue;
        if (first >= kUnused) failFile(where, "more vertices than 32-bit indices reach");
        index = static_cast<std::uint32_t>(first++);
    }
    return result;
}

glm::dmat3 normalMatrixOf(const glm::dmat4& toScene) {
    return glm::transpose(glm::inverse(glm::dmat3(toScene)));
}

/// Adds one mesh of the scene in the scene's space: transformed by `toScene`, or each vertex by its
/// own matrix if `apart` is not empty.
void addMesh(const SourceMesh& source, const glm::dmat4& toScene,
             const std::vector<glm::dmat4>& apart, const std::vector<std::uint32_t>& indices,
             const Materials& materials, CornerMesh& result) {
    for (std::size_t v = 0; v < indices.size(); ++v)
        if (indices[v] != kUnused)
            result.mesh.positions.push_back(
                placed(apart.empty() ? toScene : apart[v], source.positions[v]));

    const glm::dmat3 normalMatrix = normalMatrixOf(toScene);
    const bool mirrored = glm::determinant(glm::dmat3(toScene)) < 0.0;
    std::size_t first = 0;
    for (const std::uint32_t size : source.faceSizes) {
        const std::uint32_t* const corners = source.corners.data() + first;
        first += size;
        if (size < 3) continue; // points and lines
        result.addFace(static_cast<std::uint32_t>(source.material));
        for (std::uint32_t k = 0; k < size; ++k) {
            // Reverse the corners of a mirrored face to keep its front side.
            const std::uint32_t v = corners[mirrored ? size - 1 - k : k];
            glm::dvec3 normal(0.0);
            if (!source.normals.empty())
                normal = (apart.empty() ? normalMatrix : normalMatrixOf(apart[v])) *
                         glm::dvec3(source.normals[v]);
            const glm::vec2 texCoord =
                source.texCoords.empty() ? glm::vec2(0.0f) : source.texCoords[v];
            result.addCorner(indices[v], glm::vec3(normal), texCoord);
            if (materials.hasColours()) result.colours.push_back(materials.colour(source, v));
            if (source.tangents.empty()) continue;
            result.tangents.resize(result.normals.size(), glm::vec4(0.0f));
            const glm::vec4& tangent = source.tangents[v];
            const glm::dmat3 rotation(apart.empty() ? toScene : apart[v]);
            result.tangents.back() = glm::vec4(glm::vec3(rotation * glm::dvec3(tangent)),
                                               mirrored ? -tangent.w : tangent.w);
        }
        result.hasTexCoords = result.hasTexCoords || !source.texCoords.empty();
    }
}

/// Adds the morph targets of one mesh, transformed like its vertices. Those of the same name become
/// one.
/// \param known indices in result.morphs, by name
void addMorphs(const SourceMesh& source, const glm::dmat4& toScene,
               const std::vector<glm::dmat4>& apart, const std::vector<std::uint32_t>& indices,
               std::map<std::string, std::size_t>& known, CornerMesh& result) {
    const glm::dmat3 linear(toScene), normalMatrix = normalMatrixOf(toScene);
    for (const MorphTarget& from : source.morphs) {
        const auto [entry, isNew] = known.emplace(from.name, result.morphs.size());
        if (isNew) {
            result.morphs.emplace_back();
            result.morphs.back().name = from.name;
            result.morphs.back().initial = from.initial;
            result.morphs.back().rules = from.rules;
        }
        MorphTarget& to = result.morphs[entry->second];
        const bool hasNormals = !from.normals.empty() && !source.normals.empty();
        if (hasNormals) to.normals.resize(to.vertices.size());
        if (!from.tangents.empty()) to.tangents.resize(to.vertices.size());
        for (std::size_t i = 0; i < from.vertices.size(); ++i) {
            const std::uint32_t v = from.vertices[i];
            if (v >= indices.size() || indices[v] == kUnused) continue;
            const glm::dmat3 own = apart.empty() ? linear : glm::dmat3(apart[v]);
            to.vertices.push_back(indices[v]);
            to.positions.emplace_back(own * glm::dvec3(from.positions[i]));
            if (hasNormals) {
                const glm::dmat3 turn = apart.empty() ? normalMatrix : normalMatrixOf(apart[v]);
                // Relative to the vertex's normal, which will be of unit length.
                const double length = glm::length(turn * glm::dvec3(source.normals[v]));
                const glm::dvec3 change = turn * glm::dvec3(from.normals[i]) / length;
                to.normals.emplace_back(length > 0.0 ? change : glm::dvec3(0.0));
            }
            if (!from.tangents.empty()) {
                const double scale = std::cbrt(std::abs(glm::determinant(own)));
                const glm::dvec3 change = own * glm::dvec3(from.tangents[i]) / scale;
                to.tangents.emplace_back(scale > 0.0 ? change : glm::dvec3(0.0));
            }
        }
        if (!to.normals.empty()) to.normals.resize(to.vertices.size());
        if (!to.tangents.empty()) to.tangents.resize(to.vertices.size());
    }
}

/// Adds the weights of a mesh whose vertices have `indices`: its own, or, if it has none, full
/// weight for the joint `above` that it is parented to.
void addWeights(const SourceMesh& source, const SourceNode* above,
                const std::vector<std::uint32_t>& indices, const std::string& where,
                CornerMesh& result) {
    for (const SourceBone& bone : source.bones) {
        BoneWeights& weights = result.weightsOf(bone.name);
        for (std::size_t w = 0; w < bone.weights.size(); ++w) {
            const SourceBone::Weight& entry = bone.weights[w];
            if (entry.vertex >= indices.size() || !std::isfinite(entry.weight) ||
                entry.weight < 0.0f)
                failFile(where, "bone " + inQuotes(bone.name) + ": weight " + std::to_string(w) +
                                    ", expected a vertex below " + std::to_string(indices.size()) +
                                    " and a finite number of 0 or more");
            if (indices[entry.vertex] != kUnused)
                weights.entries.push_back({indices[entry.vertex], double(entry.weight)});
        }
    }
    if (!source.bones.empty() || above == nullptr) return;
    BoneWeights& weights = result.weightsOf(above->name);
    for (const std::uint32_t index : indices)
        if (index != kUnused) weights.entries.push_back({index, 1.0});
}

/// Removes morph targets that move nothing, and reports them.
void dropEmptyMorphs(std::vector<MorphTarget>& morphs, const std::string& path) {
    const auto empty =
        std::stable_partition(morphs.begin(), morphs.end(),
                              [](const MorphTarget& morph) { return !morph.vertices.empty(); });
    if (empty == morphs.end()) return;
    const auto count = morphs.end() - empty;
    warn(path, count == 1 ? "morph target " + inQuotes(empty->name) + " moves no vertex; left out"
                          : std::to_string(count) + " morph targets move no vertex; left out, " +
                                inQuotes(empty->name) + " among them");
    morphs.erase(empty, morphs.end());
}

} // namespace

CornerMesh readSceneMesh(const SourceScene& scene, const std::string& path,
                         const osgDB::Options* options) {
    CornerMesh result;
    const Materials materials(scene, path, options);
    result.stateSets = materials.stateSets;

    const SceneBind bind(scene);
    const std::set<const SourceNode*> joints = jointsOfSkins(scene, bind);
    std::map<std::string, std::size_t> morphs; // by name
    for (const SourceNode* node : bind.nodes())
        for (const std::size_t index : node->meshes) {
            const SourceMesh& mesh = *scene.meshes[index];
            const SourceNode* above = node;
            while (above != nullptr && joints.count(above) == 0) above = bind.parent(*above);
            const std::string where = path + ": mesh \"" + mesh.name + "\"";
            const auto indices = indicesOf(mesh, result.mesh.positions.size(), where);
            const glm::dmat4 toScene = bind.mesh(*node, index);
            const auto apart = perVertexBindPose(mesh, toScene, bind);
            addMesh(mesh, toScene, apart, indices, materials, result);
            addMorphs(mesh, toScene, apart, indices, morphs, result);
            addWeights(mesh, above, indices, where, result);
        }
    dropEmptyMorphs(result.morphs, path);
    return result;
}

} // namespace osgSkin
