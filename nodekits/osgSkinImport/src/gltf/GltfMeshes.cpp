// SPDX-License-Identifier: MIT
#include "gltf/GltfDocument.h"

#include "files/FileText.h"
#include "scene/SceneMorphs.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>

namespace osgSkin {
namespace {

constexpr float kRounding = -1e-3f; ///< slightly negative weights come from rounding
constexpr std::size_t kPart = 20;   ///< the cost of a part of an expression, in numbers of targets

std::string number(std::size_t value) {
    return std::to_string(value);
}

template <typename Vector>
std::vector<Vector> asVectors(const std::vector<float>& numbers) {
    std::vector<Vector> result(numbers.size() / std::size_t(Vector::length()));
    if (!result.empty()) std::memcpy(result.data(), numbers.data(), result.size() * sizeof(Vector));
    return result;
}

/// Scales, rotates and translates texture coordinates in the file's texture space: v points down,
/// and rotations look counter-clockwise.
void moveEach(const GltfTextureTransform& transform, std::vector<float>& texCoords) {
    const double cosine = std::cos(transform.rotation), sine = std::sin(transform.rotation);
    for (std::size_t i = 0; i + 1 < texCoords.size(); i += 2) {
        const double u = transform.scale[0] * double(texCoords[i]);
        const double v = transform.scale[1] * double(texCoords[i + 1]);
        texCoords[i] = static_cast<float>(transform.offset[0] + cosine * u + sine * v);
        texCoords[i + 1] = static_cast<float>(transform.offset[1] - sine * u + cosine * v);
    }
}

class MeshBuilder {
public:
    MeshBuilder(const GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene)
        : _document(document), _file(document.file), _accessors(document.accessors),
          _indexOf(indexOf), _scene(scene), _materialOf(document.materials.size()),
          _imageOf(document.images.size()), _names(document.expressions),
          _morphs(64.0 * double(_file.limits.samplesOf(_file.ownBytes))) {}

    void run(const std::vector<std::size_t>& order) {
        std::map<std::pair<std::size_t, std::vector<double>>, std::vector<std::size_t>> known;
        for (const std::size_t n : order) {
            const GltfNode& node = _document.nodes[n];
            const GltfMesh& mesh = _document.meshes[*node.mesh];
            const std::vector<double>& weights = node.hasWeights ? node.weights : mesh.weights;
            std::vector<std::size_t>& shown =
                _scene.nodes[static_cast<std::size_t>(_indexOf[n])].meshes;
            const auto [first, isNew] =
                known.emplace(std::make_pair(*node.mesh, weights), std::vector<std::size_t>());
            // Meshes with bones are not shared.
            if (!isNew && !node.skin && !first->second.empty()) {
                shown = first->second;
                continue;
            }
            std::vector<float> initial(weights.begin(), weights.end());
            initial.resize(mesh.targetNames.size());
            const std::vector<std::string> names = _names.of(mesh.targetNames, initial);
            for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
                shown.push_back(_scene.meshes.size());
                const auto added = addPrimitive(*node.mesh, p, weights, node.skin);
                addMorphs(mesh, mesh.primitives[p], names, initial, *added);
            }
            if (!node.skin) first->second = shown;
        }
        // The default material is last.
        const std::size_t last = materialOf(_document.materials.size() - 1);
        for (const auto& mesh : _plain) mesh->material = last;
        _names.warnRenamed(_file.path);
    }

private:
    std::shared_ptr<SourceMesh> addPrimitive(std::size_t meshIndex, std::size_t primitiveIndex,
                                             const std::vector<double>& weights, GltfIndex skin) {
        const GltfMesh& from = _document.meshes[meshIndex];
        const GltfPrimitive& primitive = from.primitives[primitiveIndex];
        _where = "meshes[" + number(meshIndex) + "].primitives[" + number(primitiveIndex) + "]";
        auto mesh = std::make_shared<SourceMesh>();
        mesh->name = from.name.empty() ? "meshes[" + number(meshIndex) + "]" : from.name;
        if (from.primitives.size() > 1) mesh->name += "-" + number(primitiveIndex);
        if (primitive.material)
            mesh->material = materialOf(*primitive.material);
        else
            _plain.push_back(mesh);
        _packed = {};
        // Prefer uncompressed values if the file has them: they are more exact.
        _isPacked = primitive.draco.has_value() && !hasAllValues(primitive);
        if (_isPacked) _packed = unpackDraco(_document, primitive, _where);
        readAttributes(primitive, weights, *mesh);
        readFaces(primitive, *mesh);
        if (skin) readBones(_document.skins[*skin], *skin, primitive, *mesh);
        _scene.meshes.push_back(mesh);
        return mesh;
    }

    /// Whether the file also contains all of a compressed primitive's attributes uncompressed.
    bool hasAllValues(const GltfPrimitive& primitive) const {
        const auto has = [&](const GltfIndex& accessor) {
            return !accessor || _accessors[*accessor].hasValues();
        };
        bool result = has(primitive.positions) && has(primitive.normals) &&
                      has(primitive.tangents) && has(primitive.colours) && has(primitive.indices);
        for (const GltfIndex& each : primitive.texCoords) result = result && has(each);
        for (const GltfIndex& each : primitive.joints) result = result && has(each);
        for (const GltfIndex& each : primitive.weights) result = result && has(each);
        return result;
    }

    // --- attributes ---

    std::vector<float> floats(std::size_t accessor, const std::string& name,
                              std::size_t width) const {
        const auto packed = _packed.floats.find(name);
        if (packed == _packed.floats.end()) return _accessors.floats(accessor);
        if (packed->second.size() != width * _packed.vertices)
            failFile(_file.path, "malformed Draco compression: " + _where + "." + name +
                                     ": expected " + number(width) + " numbers a vertex");
        return packed->second;
    }

    void readAttributes(const GltfPrimitive& from, const std::vector<double>& weights,
                        SourceMesh& mesh) {
        std::vector<float> positions = floats(from.positions, "POSITION", 3);
        morph(from, weights, &GltfPrimitive::Target::positions, positions);
        mesh.positions = asVectors<glm::vec3>(positions);
        if (from.normals) {
            std::vector<float> normals = floats(*from.normals, "NORMAL", 3);
            morph(from, weights, &GltfPrimitive::Target::normals, normals);
            mesh.normals = asVectors<glm::vec3>(normals);
        }
        if (from.normals && from.tangents)
            mesh.tangents = asVectors<glm::vec4>(floats(*from.tangents, "TANGENT", 4));
        readTexCoords(from, mesh);
        if (!from.colours) return;
        const bool isOpaque = _accessors[*from.colours].width == 3;
        const std::vector<float> colours = floats(*from.colours, "COLOR_0", isOpaque ? 3 : 4);
        if (!isOpaque) {
            mesh.colours = asVectors<glm::vec4>(colours);
            return;
        }
        for (const glm::vec3& colour : asVectors<glm::vec3>(colours))
            mesh.colours.emplace_back(colour, 1.0f);
    }

    void readTexCoords(const GltfPrimitive& from, SourceMesh& mesh) {
        std::size_t set = 0;
        std::optional<GltfTextureTransform> transform;
        if (from.material) {
            const GltfMaterial& material = _document.materials[*from.material];
            if (from.texCoords[material.texCoord]) {
                set = material.texCoord;
                transform = material.transform;
            }
        }
        if (!from.texCoords[set]) return;
        std::vector<float> texCoords = floats(*from.texCoords[set], "TEXCOORD_" + number(set), 2);
        if (transform) moveEach(*transform, texCoords);
        mesh.texCoords = asVectors<glm::vec2>(texCoords);
        for (glm::vec2& texCoord : mesh.texCoords) texCoord.y = 1.0f - texCoord.y;
    }

    /// Counts numbers of morph targets against a limit for the whole file, so that a small file
    /// cannot take minutes.
    void takeMorph(std::size_t numbers) {
        _morphs -= double(numbers);
        if (_morphs < 0.0)
            failFile(_file.path, "malformed glTF: expected morph targets of fewer vertices "
                                 "(option maxSamples)");
    }

    /// Adds morph targets with the file's default weights (section 3.7.2.2).
    void morph(const GltfPrimitive& from, const std::vector<double>& weights,
               GltfIndex GltfPrimitive::Target::*attribute, std::vector<float>& values) {
        const std::size_t targets = std::min(weights.size(), from.targets.size());
        if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; })) return;
        std::vector<double> sums(values.begin(), values.end());
        for (std::size_t t = 0; t < targets; ++t) {
            const GltfIndex& accessor = from.targets[t].*attribute;
            if (weights[t] == 0.0 || !accessor) continue;
            takeMorph(values.size());
            const std::vector<float> moves = _accessors.floats(*accessor);
            for (std::size_t i = 0; i < std::min(sums.size(), moves.size()); ++i)
                sums[i] += weights[t] * double(moves[i]);
        }
        for (std::size_t i = 0; i < sums.size(); ++i) values[i] = static_cast<float>(sums[i]);
    }

    // --- morph targets ---

    /// Adds the morph targets of a primitive, and the expressions that move it.
    void addMorphs(const GltfMesh& from, const GltfPrimitive& primitive,
                   const std::vector<std::string>& names, const std::vector<float>& initial,
                   SourceMesh& mesh) {
        if (primitive.mode == 0) return; // not drawn
        const MorphFiller filler(mesh);
        for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
            const GltfPrimitive::Target& source = primitive.targets[t];
            MorphTarget target;
            target.name = names[t];
            target.initial = initial[t];
            filler.fill(offsets(source.positions),
                        primitive.normals ? offsets(source.normals) : VertexOffsets(),
                        offsets(source.tangents), target);
            addMorph(std::move(target), mesh);
        }
        for (const GltfMesh::Expression& expression : from.expressions) {
            if (expression.parts.empty()) continue; // such as VRM's "neutral"
            std::vector<std::pair<const MorphTarget*, double>> parts;
            for (const auto& [t, weight] : expression.parts) {
                if (t >= primitive.targets.size()) continue;
                takeMorph(kPart + 3 * mesh.morphs[t].vertices.size());
                parts.emplace_back(&mesh.morphs[t], weight);
            }
            MorphTarget target = sumOf(parts);
            target.name = expression.name;
            target.rules = expression.rules;
            addMorph(std::move(target), mesh);
        }
    }

    VertexOffsets offsets(const GltfIndex& accessor) {
        if (!accessor) return {};
        takeMorph(3 * _accessors[*accessor].storedCount());
        return _accessors.offsets(*accessor);
    }

    void addMorph(MorphTarget target, SourceMesh& mesh) {
        _document.file.take(target.vertices.size(), _where);
        mesh.morphs.push_back(std::move(target));
    }

    // --- faces ---

    void readFaces(const GltfPrimitive& from, SourceMesh& mesh) const {
        constexpr std::size_t kTriangles = 4, kStrip = 5;
        const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
        if (_isPacked) {
            mesh.corners = _packed.corners;
        } else if (from.mode < kTriangles) {
            return;
        } else if (!from.indices) {
            mesh.corners.resize(vertices);
            for (std::uint32_t v = 0; v < vertices; ++v) mesh.corners[v] = v;
        } else {
            mesh.corners = _accessors.integers(*from.indices);
            for (std::size_t i = 0; i < mesh.corners.size(); ++i)
                if (mesh.corners[i] >= vertices)
                    failFile(_file.path, "malformed glTF: accessors[" + number(*from.indices) +
                                             "], " + _where + ".indices: number " + number(i) +
                                             " is " + number(mesh.corners[i]) +
                                             ", expected a vertex below " + number(vertices));
        }
        if (from.mode > kTriangles && !_isPacked)
            mesh.corners = trianglesOf(mesh.corners, from.mode == kStrip);
        mesh.corners.resize(mesh.corners.size() / 3 * 3);
        mesh.faceSizes.assign(mesh.corners.size() / 3, 3);
    }

    /// Triangles of a strip or a fan, all with the same winding.
    static std::vector<std::uint32_t> trianglesOf(const std::vector<std::uint32_t>& from,
                                                  bool isStrip) {
        std::vector<std::uint32_t> result;
        for (std::size_t i = 0; i + 2 < from.size(); ++i) {
            const std::size_t first = isStrip ? i + i % 2 : 0;
            const std::size_t second = isStrip ? i + 1 - i % 2 : i + 1;
            result.insert(result.end(), {from[first], from[second], from[i + 2]});
        }
        return result;
    }

    // --- skins ---

    void readBones(const GltfSkin& skin, std::size_t skinIndex, const GltfPrimitive& primitive,
                   SourceMesh& mesh) {
        const std::vector<glm::dmat4>& offsets = offsetsOf(skin, skinIndex);
        mesh.bones.resize(skin.joints.size());
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            mesh.bones[j].name = _document.nodes[skin.joints[j]].name;
            mesh.bones[j].offset = offsets[j];
        }
        for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
            if (!primitive.joints[set]) continue;
            const std::string number = std::to_string(set);
            const std::size_t names = *primitive.joints[set], parts = *primitive.weights[set];
            const std::vector<float> weights = floats(parts, "WEIGHTS_" + number, 4);
            const auto packed = _packed.joints.find("JOINTS_" + number);
            const std::vector<std::uint32_t> joints =
                packed != _packed.joints.end() ? packed->second : _accessors.integers(names);
            if (joints.size() != weights.size())
                failFile(_file.path, "malformed Draco compression: " + _where + ".JOINTS_" +
                                         number + ": expected 4 numbers a vertex");
            for (std::size_t i = 0; i < weights.size(); ++i) {
                if (!(std::isfinite(weights[i]) && weights[i] >= kRounding))
                    failWeight(parts, "WEIGHTS_" + number, i,
                               " has the weight " + std::to_string(weights[i]) +
                                   ", expected a number of 0 or more");
                if (!(weights[i] > 0.0f)) continue;
                if (joints[i] >= mesh.bones.size())
                    failWeight(names, "JOINTS_" + number, i,
                               " follows joint " + std::to_string(joints[i]) +
                                   ", expected one of the " + std::to_string(mesh.bones.size()) +
                                   " that the skin has");
                if (!isPlaceholder(mesh.bones[joints[i]]))
                    mesh.bones[joints[i]].weights.push_back(
                        {static_cast<std::uint32_t>(i / 4), weights[i]});
            }
        }
    }

    /// Whether a joint is the one that Blender's exporter adds for vertices that nobody painted.
    static bool isPlaceholder(const SourceBone& bone) {
        return bone.name.rfind("neutral_bone", 0) == 0;
    }

    [[noreturn]] void failWeight(std::size_t accessor, const std::string& member, std::size_t at,
                                 const std::string& message) const {
        failFile(_file.path, "malformed glTF: accessors[" + number(accessor) + "], " + _where +
                                 "." + member + ": vertex " + number(at / 4) + message);
    }

    /// Inverse bind matrices; by default all are the identity (section 3.7.3.1).
    const std::vector<glm::dmat4>& offsetsOf(const GltfSkin& skin, std::size_t index) {
        const auto [entry, isNew] = _offsets.emplace(index, std::vector<glm::dmat4>());
        std::vector<glm::dmat4>& result = entry->second;
        if (!isNew) return result;
        result.assign(skin.joints.size(), glm::dmat4(1.0));
        if (!skin.inverseBinds) return result;
        const std::size_t accessor = *skin.inverseBinds;
        if (_accessors[accessor].count < result.size())
            failFile(_file.path,
                     "skin " + inQuotes(skin.name) + " has " + number(_accessors[accessor].count) +
                         " inverse bind matrices for " + number(result.size()) + " joints");
        const std::vector<float> values = _accessors.floats(accessor);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!(std::abs(double(values[i])) <= kLargestCoordinate)) // nor NaN
                failFile(_file.path, "malformed glTF: accessors[" + number(accessor) + "], skins[" +
                                         number(index) + "].inverseBindMatrices: number " +
                                         number(i) + " is " + std::to_string(values[i]) +
                                         ", expected -1e18 to 1e18");
        std::size_t flat = 0;
        for (std::size_t j = 0; j < result.size(); ++j) {
            for (std::size_t k = 0; k < 16; ++k)
                result[j][int(k / 4)][int(k % 4)] = double(values[16 * j + k]);
            flat += glm::determinant(glm::dmat3(result[j])) == 0.0;
        }
        if (flat > 0)
            warn(_file.path, "skin " + inQuotes(skin.name) + " has " + number(flat) +
                                 " singular inverse bind matrices; their joints are bound where "
                                 "their nodes are");
        return result;
    }

    // --- materials ---

    /// The index in the scene of a material, which is added when it is first used.
    std::size_t materialOf(std::size_t index) {
        GltfIndex& known = _materialOf[index];
        if (known) return *known;
        known = _scene.materials.size();
        SourceMaterial material = _document.materials[index].source;
        for (SourceTexture& texture : material.textures)
            if (texture.image) addImage(_document.images[*texture.image], texture);
        _scene.materials.push_back(std::move(material));
        return *known;
    }

    /// Sets an embedded image, named after its index.
    void addImage(const GltfImage& from, SourceTexture& texture) {
        if (!from.uri.empty()) {
            texture.image.reset();
            return;
        }
        GltfIndex& known = _imageOf[*texture.image];
        if (!known) {
            known = _scene.images.size();
            const auto image = std::make_shared<SourceImage>();
            image->format = from.format;
            image->bytes = from.view.empty() ? from.data : std::string(from.view);
            _scene.images.push_back(image);
        }
        texture.image = known;
        texture.name = "*" + number(*known);
    }

    const GltfDocument& _document;
    const GltfFile& _file;
    const GltfAccessors& _accessors;
    const std::vector<int>& _indexOf;
    SourceScene& _scene;
    std::vector<GltfIndex> _materialOf, _imageOf;            ///< in the scene
    std::vector<std::shared_ptr<SourceMesh>> _plain;         ///< without a material
    std::map<std::size_t, std::vector<glm::dmat4>> _offsets; ///< by skin
    MorphNames _names;
    double _morphs;     ///< how many more numbers of morph targets may be read
    std::string _where; ///< path of the current primitive
    DracoMesh _packed;  ///< decoded content of the primitive
    bool _isPacked = false;
};

} // namespace

void addMeshes(const GltfDocument& document, const std::vector<std::size_t>& order,
               const std::vector<int>& indexOf, SourceScene& scene) {
    MeshBuilder(document, indexOf, scene).run(order);
}

} // namespace osgSkin
