// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTF_GLTFDOCUMENT_H
#define OSGSKINIMPORT_GLTF_GLTFDOCUMENT_H

#include "gltf/GltfFile.h"
#include "scene/SourceScene.h"

#include <glm/mat4x4.hpp>

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

/// What an accessor's elements are, and where they stand.
struct GltfAccessor {
    std::size_t count = 0;
    std::string type;      ///< as "VEC3"
    std::size_t width = 0; ///< numbers in an element
    int component = 0;     ///< type of a number, 5120 to 5126
    bool normalised = false;
    bool stored = false; ///< in a buffer view; otherwise zeros
    bool sparse = false; ///< with some elements replaced
    std::size_t view = 0, offset = 0;
    std::size_t changes = 0; ///< of a sparse one
    int indexComponent = 0;
    std::size_t indexView = 0, indexOffset = 0, changeView = 0, changeOffset = 0;
    std::string wrong; ///< why it cannot be read; empty: it can

    /// Whether the file holds its values, not only in a compressed form of some extension.
    bool hasValues() const { return stored || sparse; }
};

/// The numbers of a glTF file, read as its specification says: normalised integers, sparse
/// accessors, strides. What no part of the file names may be wrong.
class GltfAccessors {
public:
    /// Checks that accessors lie in their buffer views, and these in their buffers.
    /// \param file with its buffers; must outlive this
    explicit GltfAccessors(const GltfFile& file);

    const GltfAccessor& operator[](std::size_t accessor) const { return _accessors[accessor]; }

    /// The index of an accessor that can be read.
    /// \throw osgSkin::Error with the accessor, `where` and what is wrong with it
    std::size_t indexOf(const nlohmann::json& value, const std::string& where) const;

    void requireType(std::size_t accessor, std::initializer_list<const char*> types,
                     const std::string& where) const;
    /// Refuses others than whole numbers of one or two bytes, or where `wide` four.
    void requireIndices(std::size_t accessor, bool wide, const std::string& where) const;
    /// Refuses an accessor that stands nowhere in the file, which is zeros.
    void requireValues(std::size_t accessor, const std::string& where) const;

    /// All numbers, element by element.
    std::vector<float> floats(std::size_t accessor) const;

    /// The same of joints or indices, which are whole numbers even where the file calls them
    /// normalised.
    std::vector<std::uint32_t> integers(std::size_t accessor) const;

    /// What stands in a buffer view of which beyondView() says nothing.
    std::string_view bytesOf(std::size_t view) const;

    /// Why so many elements of so many bytes are not within a buffer view, `packed` or as far from
    /// each other as the view says; empty where they are.
    std::string beyondView(const nlohmann::json& view, std::size_t offset, std::size_t elements,
                           std::size_t bytes, bool packed) const;

    struct View {
        std::size_t buffer = 0, offset = 0, length = 0, stride = 0; ///< stride 0: packed
    };
    const View& view(std::size_t index) const { return _views[index]; }

private:
    std::string wrongWith(const nlohmann::json& from, GltfAccessor& known) const;
    template <typename Result>
    void read(std::size_t view, std::size_t offset, int component, std::size_t width,
              std::size_t count, bool packed, std::vector<Result>& result) const;
    template <typename Result>
    std::vector<Result> all(std::size_t accessor) const;

    const GltfFile& _file;
    std::vector<View> _views;
    std::vector<GltfAccessor> _accessors;
};

using GltfIndex = std::optional<std::size_t>; ///< of an entry of some list; none where not given

/// How a material's texture moves texture coordinates (KHR_texture_transform).
struct GltfTextureTransform {
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0}, rotation = 0.0;
};

struct GltfMaterial {
    SourceMaterial source; ///< its `image` is an index in GltfDocument::images
    std::size_t texCoord = 0;
    std::optional<GltfTextureTransform> transform;
};

/// A picture of the file, or the name of another file with one.
struct GltfImage {
    std::string uri; ///< decoded; empty: it stands in this file
    std::string format;
    std::string_view view; ///< encoded; where empty, `data` is
    std::string data;
};

struct GltfPrimitive {
    struct Target {
        GltfIndex positions, normals;
    };
    struct Draco {
        std::size_t view = 0;
        std::map<std::string, std::size_t> ids; ///< of compressed attributes, by their names
    };
    std::size_t positions = 0; ///< indices of accessors, as those that follow
    GltfIndex normals, colours, indices;
    std::array<GltfIndex, 8> texCoords;
    std::array<GltfIndex, 4> joints, weights; ///< both or none
    GltfIndex material;
    std::size_t mode = 4; ///< 0: points, which are not drawn
    std::vector<Target> targets;
    std::optional<Draco> draco;
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
    std::vector<double> weights; ///< of morph targets
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
    std::vector<double> translation, rotation, scale; ///< none where they are not given
    GltfIndex mesh, skin;
    std::vector<double> weights; ///< instead of the mesh's
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

/// The lists of a glTF file, with every index, number and size checked: nodes are trees of no more
/// than the allowed depth, each index names something, accessors lie in their buffer views and
/// these in their buffers, attributes of a primitive have one count, and what is asked for is in
/// proportion to the file's size. Extras, cameras, lights and unknown extensions are not in it.
class GltfDocument {
public:
    /// \param file whose meshopt compression is unpacked; must outlive this
    /// \throw osgSkin::Error with the file, the place in it and what was expected
    explicit GltfDocument(GltfFile& file);

    GltfFile& file;
    GltfAccessors accessors;
    std::vector<GltfImage> images;
    std::vector<GltfMaterial> materials;
    std::vector<GltfMesh> meshes;
    std::vector<GltfSkin> skins;
    std::vector<GltfNode> nodes;
    std::vector<std::size_t> roots; ///< of the scene that is shown
    std::vector<GltfAnimation> animations;
};

/// Fills in images and materials.
void readMaterials(GltfDocument& document);

/// Adds a mesh for each primitive that the scene shows, once for each way to show it.
///
/// \param order nodes of the scene with meshes, in which these are added
/// \param indexOf of each node in `scene`; -1 for those that it does not have
void addMeshes(const GltfDocument& document, const std::vector<std::size_t>& order,
               const std::vector<int>& indexOf, SourceScene& scene);

/// Adds the animations: all interpolations become linear ones, steps by pairs of keys, and cubic
/// splines by samples at each key and 30 times a second between them.
/// \param indexOf as of addMeshes()
/// \throw osgSkin::Error where a track has not a value a key, or times go back
void addAnimations(const GltfDocument& document, const std::vector<int>& indexOf,
                   SourceScene& scene);

/// What Draco's compression of a primitive holds.
struct DracoMesh {
    std::vector<std::uint32_t> corners; ///< of triangles
    std::size_t vertices = 0;
    std::map<std::string, std::vector<float>> floats;
    std::map<std::string, std::vector<std::uint32_t>> joints;
};

/// Unpacks a primitive's Draco compression.
/// \throw osgSkin::Error with `where` where it cannot be, and by its name in a build without Draco
DracoMesh unpackDraco(const GltfDocument& document, const GltfPrimitive& primitive,
                      const std::string& where);

} // namespace osgSkin

#endif
