// SPDX-License-Identifier: MIT
#ifndef OSGSKINBAKE_GLB_H
#define OSGSKINBAKE_GLB_H

#include "Bytes.h"
#include "FrameWriter.h"
#include "Surface.h"

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <osg/Image>
#include <osg/Vec2>
#include <osg/Vec4>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace bake {

/// The binary buffer of a glTF file, with its views and accessors. The add functions return the
/// index of the new accessor, except addFile().
class GlbBuffer {
public:
    std::size_t addVectors(const std::vector<glm::dvec3>& vectors, bool withRange);
    std::size_t addTexCoords(const std::vector<osg::Vec2>& texCoords); ///< flipped for glTF
    std::size_t addColours(const std::vector<osg::Vec4>& linear);
    std::size_t addIndices(const std::vector<std::uint32_t>& indices);
    std::size_t addTimes(const std::vector<float>& ascending);
    std::size_t addNumbers(const std::vector<float>& numbers);
    /// Animated or other numbers that are no vertices', `width` of them for each of `type`.
    std::size_t addFloats(const std::vector<float>& numbers, const char* type, std::size_t width);
    /// Vectors of a morph target: 0 but for those of `vertices`, which ascend.
    std::size_t addSparse(std::size_t count, const std::vector<std::uint32_t>& vertices,
                          const std::vector<glm::dvec3>& vectors);
    std::size_t addJoints(const std::vector<std::uint16_t>& joints); ///< four a vertex
    std::size_t addWeights(const std::vector<float>& weights);       ///< four a vertex, as joints
    std::size_t addFile(const std::string& data); ///< returns the index of the view

    std::size_t size() const { return _bytes.data.size(); }

    /// Adds the buffer's description to `root`, and writes both as a .glb file.
    /// \throw osgSkin::Error if the file cannot be written
    void write(const std::string& file, nlohmann::json root) const;

private:
    enum class Use { Vertices, Indices, Data };
    std::size_t addView(std::size_t begin, Use use);
    std::size_t addAccessor(std::size_t begin, std::size_t count, const char* type, int component,
                            Use use);

    Bytes _bytes;
    nlohmann::json _views = nlohmann::json::array();
    nlohmann::json _accessors = nlohmann::json::array();
};

/// The materials of a glTF file, with their textures and embedded images.
class GlbMaterials {
public:
    /// \param buffer receives the images; must outlive this object
    /// \param folder base of the images' relative file names
    GlbMaterials(GlbBuffer& buffer, std::string folder);

    /// Adds a material and returns its index.
    std::size_t add(const SurfaceMaterial& material, const std::string& name);

    /// Adds the materials, textures and images to the file's JSON.
    void finish(nlohmann::json& root) const;

private:
    std::optional<std::size_t> texture(const SurfaceMaterial& material);
    std::optional<std::size_t> image(const osg::Image& image);
    std::size_t sampler(const SurfaceMaterial& material);

    GlbBuffer& _buffer;
    std::string _folder;
    nlohmann::json _materials = nlohmann::json::array();
    nlohmann::json _textures = nlohmann::json::array();
    nlohmann::json _images = nlohmann::json::array();
    nlohmann::json _samplers = nlohmann::json::array();
    std::map<const osg::Image*, std::optional<std::size_t>> _known;
    std::map<std::string, std::size_t> _files;
};

/// Writes a binary glTF file. Its mesh is the first frame, each further frame is a morph target,
/// and an animation interpolates linearly between them. A file of one frame has the character's own
/// morph targets. Any glTF player can play it, without a skin
/// model or a skeleton. Each material has one primitive, with its texture.
class GlbMorphs : public FrameWriter {
public:
    GlbMorphs(std::string file, const FrameSeries& series);
    void add(std::size_t frame, const PosedMesh& posed) override;
    void addMorph(const std::string& name, const PosedMesh& posed) override;
    void finish() override;

private:
    /// A surface and the frames added so far.
    struct Primitive {
        Surface surface;
        SurfaceMaterial material;
        std::vector<glm::dvec3> positions, normals; ///< of the first frame
        nlohmann::json attributes;
        nlohmann::json targets = nlohmann::json::array();
    };
    void addFirst(Primitive& primitive, const PosedMesh& posed);
    void addTarget(Primitive& primitive, const PosedMesh& posed);
    nlohmann::json animation();

    std::string _file;
    FrameSeries _series;
    GlbBuffer _buffer;
    GlbMaterials _materials;
    std::vector<Primitive> _primitives;
    std::vector<std::string> _morphs; ///< names
    std::size_t _frames = 0;
};

} // namespace bake

#endif
