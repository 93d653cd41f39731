// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTF_GLTFDOCUMENT_H
#define OSGSKINIMPORT_GLTF_GLTFDOCUMENT_H

#include "gltf/GltfFile.h"
#include "scene/SceneMorphs.h"
#include "scene/SourceScene.h"

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgSkin {

/// The type of an accessor's elements, and where the file stores them.
struct GltfAccessor {
    std::size_t count = 0;
    std::string type;      ///< such as "VEC3"
    std::size_t width = 0; ///< numbers per element
    int component = 0;     ///< component type, 5120 to 5126
    bool normalised = false;
    bool stored = false; ///< in a buffer view; otherwise all zeros
    bool sparse = false; ///< some elements are replaced
    std::size_t view = 0, offset = 0;
    std::size_t changes = 0; ///< number of replaced elements, if sparse
    int indexComponent = 0;
    std::size_t indexView = 0, indexOffset = 0, changeView = 0, changeOffset = 0;
    std::string error; ///< why it cannot be read; empty if it can

    /// Whether the file contains its values, not only in compressed form by an extension.
    bool hasValues() const { return stored || sparse; }
    /// The number of elements in the file.
    std::size_t storedCount() const { return stored ? count : sparse ? changes : 0; }
};

/// Reads the numbers of a glTF file as the specification defines: normalised integers, sparse
/// accessors, strides. Errors in unused accessors are ignored.
class GltfAccessors {
public:
    /// Checks that accessors lie in their buffer views, and buffer views in their buffers.
    /// \param file with its buffers; must outlive this
    explicit GltfAccessors(const GltfFile& file);

    const GltfAccessor& operator[](std::size_t accessor) const { return _accessors[accessor]; }

    /// The index of a valid accessor.
    /// \throw osgSkin::Error with the accessor, `where` and what is wrong with it
    std::size_t indexOf(const nlohmann::json& value, const std::string& where) const;

    void requireType(std::size_t accessor, std::initializer_list<const char*> types,
                     const std::string& where) const;
    /// Throws unless components are unsigned integers of one or two bytes, or, if `wide`, four.
    void requireIndices(std::size_t accessor, bool wide, const std::string& where) const;
    /// Throws for an accessor without values in the file, which would be all zeros.
    void requireValues(std::size_t accessor, const std::string& where) const;

    /// All numbers, element by element.
    std::vector<float> floats(std::size_t accessor) const;

    /// The vectors of a VEC3 accessor that are not zero.
    VertexOffsets offsets(std::size_t accessor) const;

    /// All numbers of joints or indices, as integers even if the file declares them normalised.
    std::vector<std::uint32_t> integers(std::size_t accessor) const;

    /// The bytes of a buffer view that viewError() accepts.
    std::string_view bytesOf(std::size_t view) const;

    /// The reason why `elements` of `bytes` each do not fit in a buffer view, `packed` or with the
    /// view's stride; empty if they fit.
    std::string viewError(const nlohmann::json& view, std::size_t offset, std::size_t elements,
                          std::size_t bytes, bool packed) const;

    struct View {
        std::size_t buffer = 0, offset = 0, length = 0, stride = 0; ///< stride 0: packed
    };
    const View& view(std::size_t index) const { return _views[index]; }

private:
    std::string findError(const nlohmann::json& from, GltfAccessor& known) const;
    template <typename Result>
    void read(std::size_t view, std::size_t offset, int component, std::size_t width,
              std::size_t count, bool packed, std::vector<Result>& result) const;
    template <typename Result>
    void readChanges(std::size_t accessor, std::vector<std::uint32_t>& indices,
                     std::vector<Result>& values) const;
    template <typename Result>
    std::vector<Result> all(std::size_t accessor) const;

    const GltfFile& _file;
    std::vector<View> _views;
    std::vector<GltfAccessor> _accessors;
};

using GltfIndex = std::optional<std::size_t>; ///< index in some list; none if not given

/// A material's transform of texture coordinates (KHR_texture_transform).
struct GltfTextureTransform {
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0}, rotation = 0.0;

    /// The directions along which texture coordinates grow are the same after it.
    bool keepsDirections() const { return rotation == 0.0 && scale[0] > 0.0 && scale[1] > 0.0; }
    bool operator==(const GltfTextureTransform& other) const {
        return std::equal(offset, offset + 2, other.offset) &&
               std::equal(scale, scale + 2, other.scale) && rotation == other.rotation;
    }
};

struct GltfMaterial {
    SourceMaterial source; ///< an `image` is an index in GltfDocument::images
    bool hasTextures = false;
    std::size_t texCoord = 0; ///< of all textures, as is `transform`
    std::optional<GltfTextureTransform> transform;

    /// Whether it needs a mesh's tangents, and those of the file fit.
    bool usesTangents() const {
        return source.textures[Material::Normal].image.has_value() &&
               (!transform || transform->keepsDirections());
    }
};

/// An embedded image, or the name of an image file.
struct GltfImage {
    std::string uri; ///< decoded; empty if embedded
    std::string format;
    std::string_view view; ///< encoded; if empty, see `data`
    std::string data;
};

struct GltfPrimitive {
    struct Target {
        GltfIndex positions, normals, tangents;
    };
    struct Draco {
        std::size_t view = 0;
        std::map<std::string, std::size_t> ids; ///< of compressed attributes, by name
    };
    std::size_t positions = 0;                     ///< accessor, like those below
    GltfIndex normals, tangents, colours, indices; ///< tangents: if the material uses them
    std::array<GltfIndex, 8> texCoords;
    std::array<GltfIndex, 4> joints, weights; ///< both or none
    GltfIndex material;
    std::size_t mode = 4; ///< 0: points, which are not drawn
    std::vector<Target> targets;
    std::optional<Draco> draco;
};

struct GltfMesh {
    /// A facial expression of a VRM file: morph targets of this mesh, with weights.
    struct Expression {
        std::string name;
        std::vector<std::pair<std::size_t, double>> parts; ///< below targetNames.size()
        ExpressionRules rules;
    };
    std::string name;
    std::vector<GltfPrimitive> primitives;
    std::vector<std::string> targetNames; ///< of the primitive with most morph targets
    std::vector<double> weights;          ///< of morph targets
    std::vector<Expression> expressions;
};

struct GltfSkin {
    std::string name;
    std::vector<std::size_t> joints;
    GltfIndex inverseBinds;
};

struct GltfNode {
    std::string name; ///< unique after nameNodes()
    glm::dmat4 matrix{1.0};
    bool hasMatrix = false;
    std::vector<double> translation, rotation, scale; ///< empty if not given
    GltfIndex mesh, skin;
    std::vector<double> weights; ///< override the mesh's
    bool hasWeights = false;
    std::vector<std::size_t> children;
    GltfIndex parent;
};

struct GltfAnimation {
    enum class Path { Translation, Rotation, Scale, Weights };
    enum class Interpolation { Linear, Step, CubicSpline };
    struct Sampler {
        std::size_t input = 0, output = 0;
        Interpolation interpolation = Interpolation::Linear;
    };
    struct Channel {
        std::size_t sampler = 0;
        GltfIndex node;
        Path path = Path::Weights;
    };
    std::string name;
    bool isNamed = false;
    std::vector<Sampler> samplers;
    std::vector<Channel> channels;
};

/// The contents of a glTF file, with every index, number and size checked: nodes are trees within
/// the depth limit, indices are in range, accessors lie in their buffer views and these in their
/// buffers, attributes of a primitive have the same count, and the amount of data is in proportion
/// to the file's size. Extras, cameras, lights and unknown extensions are not included.
class GltfDocument {
public:
    /// \param file whose meshopt compression has been decoded; must outlive this
    /// \throw osgSkin::Error with the file, the position in it and what was expected
    explicit GltfDocument(GltfFile& file);

    GltfFile& file;
    GltfAccessors accessors;
    std::vector<GltfImage> images;
    std::vector<GltfMaterial> materials;
    std::vector<GltfMesh> meshes;
    std::vector<GltfSkin> skins;
    std::vector<GltfNode> nodes;
    std::vector<std::size_t> roots; ///< of the default scene
    std::vector<GltfAnimation> animations;
    std::vector<std::string> expressions; ///< names, each once
};

/// Reads images and materials.
void readMaterials(GltfDocument& document);

/// Reads the expressions of VRM 0 and 1 as further morph targets of the meshes. Reports what they
/// do beside moving vertices, which is left out.
///
/// \param document with meshes and nodes
void readExpressions(GltfDocument& document);

/// Adds a mesh for each primitive in the scene, once for each distinct set of morph weights and for
/// each node with a skin.
///
/// \param document with meshes
/// \param order scene nodes with meshes, in the order in which to add them
/// \param indexOf index in `scene` of each node; -1 if it is not in the scene
/// \param scene to add to
void addMeshes(const GltfDocument& document, const std::vector<std::size_t>& order,
               const std::vector<int>& indexOf, SourceScene& scene);

/// Adds the animations. All interpolations become linear: steps become pairs of keys, and cubic
/// splines are sampled at each key and 30 times a second between keys.
/// \param document with animations
/// \param indexOf as for addMeshes()
/// \param scene to add to
/// \throw osgSkin::Error if a track does not have one value per key, or times decrease
void addAnimations(const GltfDocument& document, const std::vector<int>& indexOf,
                   SourceScene& scene);

/// Nodes of a VRM animation that are not joints: expressions and gaze.
struct VrmAnimationNodes {
    std::map<std::size_t, std::string> expressions; ///< their names; x is the weight
    GltfIndex gaze;                                 ///< which rotates as the eyes look
};
VrmAnimationNodes vrmAnimationNodes(const GltfDocument& document);

/// Reads the springs of VRM 0 and 1. Reports what names no node, which is left out.
/// \param indexOf as for addMeshes()
/// \param scene with all nodes
void readSprings(GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene);

/// Reads the constraints of VRM 1. Reports those that cannot be used, which are left out.
/// \param indexOf as for addMeshes()
/// \param scene with all nodes
void readConstraints(GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene);

/// The decoded content of a Draco-compressed primitive.
struct DracoMesh {
    std::vector<std::uint32_t> corners; ///< of triangles
    std::size_t vertices = 0;
    std::map<std::string, std::vector<float>> floats;
    std::map<std::string, std::vector<std::uint32_t>> joints;
};

/// Counts the data of Draco-compressed primitives as larger: a file's limits are relative to its
/// size, and Draco packs a vertex with all attributes into one byte to six.
void countDraco(GltfFile& file);

/// Decodes a Draco-compressed primitive.
/// \throw osgSkin::Error with `where` if decoding fails, or if this build is without Draco
DracoMesh unpackDraco(const GltfDocument& document, const GltfPrimitive& primitive,
                      const std::string& where);

} // namespace osgSkin

#endif
