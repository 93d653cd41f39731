// SPDX-License-Identifier: GPL-3.0-or-later
#include "GlbMorphs.h"

#include "MaterialLibrary.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <cmath>
#include <limits>

namespace bake {
namespace {

constexpr std::size_t kMostFrames = 4096; ///< a weight of each in each: 64 MB

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
    if (series.count > kMostFrames)
        throw osgSkin::Error(_file + ": " + std::to_string(series.count) +
                             " frames, expected at most " + std::to_string(kMostFrames) +
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
        if (_frames > 1) entry["targets"] = primitive.targets;
        primitives.push_back(entry);
    }
    mesh["primitives"] = primitives;
    nlohmann::json node{{"name", "skin"}, {"mesh", 0}};
    if (_series.character->isZUp()) node["rotation"] = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    nlohmann::json root{{"asset", {{"version", "2.0"}, {"generator", "osgskinbake"}}},
                        {"scene", 0},
                        {"scenes", {{{"nodes", {0}}}}}};
    if (_frames > 1) {
        mesh["weights"] = std::vector<double>(_frames - 1, 0.0);
        root["animations"] = {animation()};
    }
    root["meshes"] = {mesh};
    root["nodes"] = {node};
    _materials.finish(root);
    _buffer.write(_file, root);
}

} // namespace bake
