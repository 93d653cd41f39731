// SPDX-License-Identifier: MIT
#include "Glb.h"

#include "Bytes.h"
#include "Surface.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bake {

namespace {

constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

void pad(std::string& data, char with) {
    while (data.size() % 4 != 0) data += with;
}

} // namespace

std::size_t GlbBuffer::addView(std::size_t begin, Use use) {
    nlohmann::json view{
        {"buffer", 0}, {"byteOffset", begin}, {"byteLength", _bytes.data.size() - begin}};
    if (use != Use::Data)
        view["target"] = use == Use::Vertices ? kArrayBuffer : kElementArrayBuffer;
    _views.push_back(view);
    return _views.size() - 1;
}

std::size_t GlbBuffer::addAccessor(std::size_t begin, std::size_t count, const char* type,
                                   int component, Use use) {
    _accessors.push_back({{"bufferView", addView(begin, use)},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return _accessors.size() - 1;
}

namespace {

/// The smallest and largest of each axis, in float, so that they match the stored values.
struct Range {
    std::array<float, 3> low, high;

    Range() {
        low.fill(std::numeric_limits<float>::max());
        high.fill(std::numeric_limits<float>::lowest());
    }
    void add(const glm::dvec3& v) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<float>(v[static_cast<int>(axis)]);
            low[axis] = std::min(low[axis], value);
            high[axis] = std::max(high[axis], value);
        }
    }
};

} // namespace

std::size_t GlbBuffer::addVectors(const std::vector<glm::dvec3>& vectors, bool withRange) {
    const std::size_t begin = size();
    Range range;
    for (const glm::dvec3& v : vectors) {
        _bytes.add(v);
        range.add(v);
    }
    const std::size_t index = addAccessor(begin, vectors.size(), "VEC3", kFloat, Use::Vertices);
    if (withRange) {
        _accessors[index]["min"] = range.low;
        _accessors[index]["max"] = range.high;
    }
    return index;
}

std::size_t GlbBuffer::addTexCoords(const std::vector<osg::Vec2>& texCoords) {
    const std::size_t begin = size();
    for (const osg::Vec2& t : texCoords) {
        _bytes.add(t.x());
        _bytes.add(1.0f - t.y()); // glTF's origin is the upper left
    }
    return addAccessor(begin, texCoords.size(), "VEC2", kFloat, Use::Vertices);
}

std::size_t GlbBuffer::addColours(const std::vector<osg::Vec4>& linear) {
    const std::size_t begin = size();
    for (const osg::Vec4& c : linear)
        for (unsigned k = 0; k < 4; ++k) _bytes.add(std::clamp(c[k], 0.0f, 1.0f));
    return addAccessor(begin, linear.size(), "VEC4", kFloat, Use::Vertices);
}

std::size_t GlbBuffer::addIndices(const std::vector<std::uint32_t>& indices) {
    const std::size_t begin = size();
    for (const std::uint32_t index : indices) _bytes.add(index);
    return addAccessor(begin, indices.size(), "SCALAR", kUnsignedInt, Use::Indices);
}

std::size_t GlbBuffer::addTimes(const std::vector<float>& ascending) {
    const std::size_t index = addNumbers(ascending);
    _accessors[index]["min"] = {ascending.front()};
    _accessors[index]["max"] = {ascending.back()};
    return index;
}

std::size_t GlbBuffer::addNumbers(const std::vector<float>& numbers) {
    return addFloats(numbers, "SCALAR", 1);
}

std::size_t GlbBuffer::addFloats(const std::vector<float>& numbers, const char* type,
                                 std::size_t width) {
    const std::size_t begin = size();
    for (const float number : numbers) _bytes.add(number);
    return addAccessor(begin, numbers.size() / width, type, kFloat, Use::Data);
}

std::size_t GlbBuffer::addSparse(std::size_t count, const std::vector<std::uint32_t>& vertices,
                                 const std::vector<glm::dvec3>& vectors) {
    Range range;
    if (vertices.size() < count) range.add(glm::dvec3(0.0)); // the others
    nlohmann::json accessor{{"componentType", kFloat}, {"count", count}, {"type", "VEC3"}};
    if (!vertices.empty()) {
        std::size_t begin = size();
        for (const std::uint32_t vertex : vertices) _bytes.add(vertex);
        const std::size_t indices = addView(begin, Use::Data);
        begin = size();
        for (const glm::dvec3& v : vectors) {
            _bytes.add(v);
            range.add(v);
        }
        accessor["sparse"] = {
            {"count", vertices.size()},
            {"indices", {{"bufferView", indices}, {"componentType", kUnsignedInt}}},
            {"values", {{"bufferView", addView(begin, Use::Data)}}}};
    }
    accessor["min"] = range.low;
    accessor["max"] = range.high;
    _accessors.push_back(std::move(accessor));
    return _accessors.size() - 1;
}

std::size_t GlbBuffer::addJoints(const std::vector<std::uint16_t>& joints) {
    const std::size_t begin = size();
    for (const std::uint16_t joint : joints) {
        _bytes.add(static_cast<std::uint8_t>(joint & 255));
        _bytes.add(static_cast<std::uint8_t>(joint >> 8));
    }
    return addAccessor(begin, joints.size() / 4, "VEC4", kUnsignedShort, Use::Vertices);
}

std::size_t GlbBuffer::addWeights(const std::vector<float>& weights) {
    const std::size_t begin = size();
    for (const float weight : weights) _bytes.add(weight);
    return addAccessor(begin, weights.size() / 4, "VEC4", kFloat, Use::Vertices);
}

std::size_t GlbBuffer::addFile(const std::string& data) {
    const std::size_t begin = size();
    _bytes.data += data;
    const std::size_t view = addView(begin, Use::Data);
    pad(_bytes.data, '\0'); // aligns the numbers that follow
    return view;
}

void GlbBuffer::write(const std::string& file, nlohmann::json root) const {
    root["accessors"] = _accessors;
    root["bufferViews"] = _views;
    root["buffers"] = {{{"byteLength", size()}}};
    std::string json = root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    pad(json, ' ');
    Bytes out;
    out.data = "glTF";
    out.add(std::uint32_t(2));
    std::string binary = _bytes.data;
    pad(binary, '\0');
    const std::size_t total = 12 + 8 + json.size() + 8 + binary.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw osgSkin::Error(file + ": too large for a .glb file, expected fewer frames");
    out.add(static_cast<std::uint32_t>(total));
    out.add(static_cast<std::uint32_t>(json.size()));
    out.data += "JSON" + json;
    out.add(static_cast<std::uint32_t>(binary.size()));
    out.data += std::string("BIN\0", 4);
    out.data += binary;
    writeBytes(file, out.data);
}

namespace {

constexpr int kLinear = 9729;
constexpr int kLinearMipmapLinear = 9987;

int wrapOf(osg::Texture::WrapMode mode) {
    if (mode == osg::Texture::REPEAT) return 10497;
    return mode == osg::Texture::MIRROR ? 33648 : 33071; // MIRRORED_REPEAT, CLAMP_TO_EDGE
}

/// The roughness whose highlight is as wide as Blinn's.
float roughnessOf(const SurfaceMaterial& material) {
    const osg::Vec4& s = material.specular;
    if (std::max({s.r(), s.g(), s.b()}) <= 0.0f) return 1.0f;
    return std::pow(2.0f / (std::max(material.shininess, 0.0f) + 2.0f), 0.25f);
}

} // namespace

GlbMaterials::GlbMaterials(GlbBuffer& buffer, std::string folder)
    : _buffer(buffer), _folder(std::move(folder)) {}

std::optional<std::size_t> GlbMaterials::image(const osg::Image& image) {
    const auto known = _known.find(&image);
    if (known != _known.end()) return known->second;
    const std::optional<ImageBytes> bytes = bytesOf(image, _folder);
    std::optional<std::size_t> index;
    if (bytes) {
        // Several materials may have loaded the same file separately.
        const auto file = _files.find(bytes->file);
        if (file != _files.end() && !bytes->file.empty()) {
            index = file->second;
        } else {
            index = _images.size();
            _images.push_back({{"bufferView", _buffer.addFile(bytes->data)},
                               {"mimeType", bytes->isJpeg ? "image/jpeg" : "image/png"}});
            _files[bytes->file] = *index;
        }
    }
    _known[&image] = index;
    return index;
}

std::size_t GlbMaterials::sampler(const SurfaceMaterial& material) {
    const nlohmann::json sampler{{"magFilter", kLinear},
                                 {"minFilter", kLinearMipmapLinear},
                                 {"wrapS", wrapOf(material.wrapS)},
                                 {"wrapT", wrapOf(material.wrapT)}};
    const auto found = std::find(_samplers.begin(), _samplers.end(), sampler);
    if (found != _samplers.end()) return static_cast<std::size_t>(found - _samplers.begin());
    _samplers.push_back(sampler);
    return _samplers.size() - 1;
}

std::optional<std::size_t> GlbMaterials::texture(const SurfaceMaterial& material) {
    if (!material.image) return std::nullopt;
    const std::optional<std::size_t> source = image(*material.image);
    if (!source) return std::nullopt;
    const nlohmann::json texture{{"source", *source}, {"sampler", sampler(material)}};
    const auto found = std::find(_textures.begin(), _textures.end(), texture);
    if (found != _textures.end()) return static_cast<std::size_t>(found - _textures.begin());
    _textures.push_back(texture);
    return _textures.size() - 1;
}

std::size_t GlbMaterials::add(const SurfaceMaterial& material, const std::string& name) {
    const osg::Vec4 base = linear(material.diffuse), light = linear(material.emission);
    const auto unit = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
    nlohmann::json pbr{
        {"baseColorFactor", {unit(base.r()), unit(base.g()), unit(base.b()), unit(base.a())}},
        {"metallicFactor", 0.0},
        {"roughnessFactor", roughnessOf(material)}};
    if (const auto index = texture(material)) pbr["baseColorTexture"] = {{"index", *index}};
    nlohmann::json entry{{"name", name}, {"pbrMetallicRoughness", pbr}};
    if (light.r() + light.g() + light.b() > 0.0f)
        entry["emissiveFactor"] = {unit(light.r()), unit(light.g()), unit(light.b())};
    if (material.twoSided) entry["doubleSided"] = true;
    if (material.alpha == SurfaceMaterial::Alpha::Blend) entry["alphaMode"] = "BLEND";
    if (material.alpha == SurfaceMaterial::Alpha::Mask) {
        entry["alphaMode"] = "MASK";
        entry["alphaCutoff"] = material.alphaCutOff;
    }
    _materials.push_back(entry);
    return _materials.size() - 1;
}

void GlbMaterials::finish(nlohmann::json& root) const {
    root["materials"] = _materials;
    if (_textures.empty()) return;
    root["textures"] = _textures;
    root["images"] = _images;
    root["samplers"] = _samplers;
}

namespace {

constexpr std::size_t kMaxFrames = 4096; ///< every frame stores a weight per frame: 64 MB

std::vector<glm::dvec3> gather(const std::vector<glm::dvec3>& of,
                               const std::vector<std::uint32_t>& indices) {
    std::vector<glm::dvec3> result;
    result.reserve(indices.size());
    for (const std::uint32_t index : indices) result.push_back(of[index]);
    return result;
}

std::vector<glm::dvec3> differences(const std::vector<glm::dvec3>& a,
                                    const std::vector<glm::dvec3>& b) {
    std::vector<glm::dvec3> result;
    result.reserve(a.size());
    for (std::size_t v = 0; v < a.size(); ++v) result.push_back(a[v] - b[v]);
    return result;
}

} // namespace

GlbMorphs::GlbMorphs(std::string file, const FrameSeries& series)
    : _file(std::move(file)), _series(series),
      _materials(_buffer, osgDB::getFilePath(series.character->meshFile)) {
    if (series.count > kMaxFrames)
        throw osgSkin::Error(_file + ": " + std::to_string(series.count) +
                             " frames, expected at most " + std::to_string(kMaxFrames) +
                             " in a .glb file, where weights grow with their square; bake fewer "
                             "(--frames A:B:STEP), or a .pc2 file");
    for (Surface& surface : surfacesOf(*series.character)) {
        Primitive primitive;
        primitive.surface = std::move(surface);
        primitive.material = SurfaceMaterial::of(primitive.surface);
        _primitives.push_back(std::move(primitive));
    }
}

void GlbMorphs::addFirst(Primitive& primitive, const PosedMesh& posed) {
    const Surface& surface = primitive.surface;
    primitive.positions = gather(posed.positions, surface.sourceVertex);
    primitive.normals = surface.normals(*_series.character);
    primitive.attributes = {{"POSITION", _buffer.addVectors(primitive.positions, true)},
                            {"NORMAL", _buffer.addVectors(primitive.normals, false)}};
    if (primitive.material.image)
        primitive.attributes["TEXCOORD_0"] = _buffer.addTexCoords(surface.texCoords);
    if (!primitive.material.vertexColours) return;
    std::vector<osg::Vec4> colours;
    for (const osg::Vec4& colour : surface.colours) colours.push_back(linear(colour));
    primitive.attributes["COLOR_0"] = _buffer.addColours(colours);
}

void GlbMorphs::addTarget(Primitive& primitive, const PosedMesh& posed) {
    const auto positions = gather(posed.positions, primitive.surface.sourceVertex);
    const auto normals = primitive.surface.normals(*_series.character);
    primitive.targets.push_back(
        {{"POSITION", _buffer.addVectors(differences(positions, primitive.positions), true)},
         {"NORMAL", _buffer.addVectors(differences(normals, primitive.normals), false)}});
}

void GlbMorphs::add(std::size_t, const PosedMesh& posed) {
    for (Primitive& primitive : _primitives)
        if (_frames == 0)
            addFirst(primitive, posed);
        else
            addTarget(primitive, posed);
    ++_frames;
    if (_buffer.size() > std::numeric_limits<std::uint32_t>::max() / 2)
        throw osgSkin::Error(_file + ": too large for a .glb file, expected fewer frames");
}

void GlbMorphs::addMorph(const std::string& name, const PosedMesh& posed) {
    for (Primitive& primitive : _primitives) addTarget(primitive, posed);
    _morphs.push_back(name);
}

nlohmann::json GlbMorphs::animation() {
    std::vector<float> times, weights;
    for (std::size_t f = 0; f < _frames; ++f) {
        times.push_back(static_cast<float>(static_cast<double>(f) * _series.seconds));
        for (std::size_t target = 1; target < _frames; ++target)
            weights.push_back(f == target ? 1.0f : 0.0f);
    }
    const std::size_t input = _buffer.addTimes(times), output = _buffer.addNumbers(weights);
    return {{"name", _series.name},
            {"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}};
}

void GlbMorphs::finish() {
    nlohmann::json mesh{{"name", "skin"}};
    nlohmann::json primitives = nlohmann::json::array();
    for (const Primitive& primitive : _primitives) {
        const std::string name = materialName(primitives.size());
        nlohmann::json entry{{"attributes", primitive.attributes},
                             {"indices", _buffer.addIndices(primitive.surface.triangles)},
                             {"material", _materials.add(primitive.material, name)}};
        if (!primitive.targets.empty()) entry["targets"] = primitive.targets;
        primitives.push_back(entry);
    }
    mesh["primitives"] = primitives;
    nlohmann::json node{{"name", "skin"}, {"mesh", 0}};
    if (_series.character->isZUp()) node["rotation"] = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    // glTF's unit is the metre.
    const double scale = _series.character->metresPerUnit();
    if (std::abs(scale - 1.0) > 1e-9) node["scale"] = {scale, scale, scale};
    nlohmann::json root{{"asset", {{"version", "2.0"}, {"generator", "osgskinbake"}}},
                        {"scene", 0},
                        {"scenes", {{{"nodes", {0}}}}}};
    if (_frames > 1) {
        mesh["weights"] = std::vector<double>(_frames - 1, 0.0);
        root["animations"] = {animation()};
    }
    if (!_morphs.empty()) {
        mesh["weights"] = std::vector<double>(_morphs.size(), 0.0);
        mesh["extras"]["targetNames"] = _morphs;
    }
    root["meshes"] = {mesh};
    root["nodes"] = {node};
    _materials.finish(root);
    _buffer.write(_file, root);
}

} // namespace bake
