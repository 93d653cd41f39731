// SPDX-License-Identifier: MIT
#include "RiggedGlb.h"

#include "Glb.h"
#include "JointRanges.h"
#include "Surface.h"
#include "Vrm.h"

#include <osgSkin/Correctives>
#include <osgSkin/DeformableSkin>
#include <osgSkin/MorphTargets>
#include <osgSkin/RigidPart>
#include <osgSkin/SetMorph>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace bake {

namespace {

using osgSkin::Character;
using osgSkin::CorrectiveJoint;
using osgSkin::Correctives;
using osgSkin::JointMap;

constexpr std::size_t kFitPoses = 64;  ///< spread over all clips, besides each joint's extremes
constexpr double kNegligible = 3e-5;   ///< displacement by a corrective, in the body's size
constexpr double kRangesSeconds = 0.5; ///< between poses
constexpr double kUnmoved = 1e-7;      ///< a number of a channel that does not differ from another

/// Poses for fitting weights: some of every clip, and those in which a joint bends or twists most.
std::vector<osgSkin::Pose> fitPoses(const osgSkin::Binding& binding,
                                    const std::vector<RiggedClip>& clips) {
    std::vector<const osgSkin::Pose*> all;
    for (const RiggedClip& clip : clips)
        for (const osgSkin::Pose& pose : clip.poses) all.push_back(&pose);
    if (all.empty()) return jointRanges(binding);
    std::set<std::size_t> chosen;
    for (std::size_t i = 0; i < kFitPoses; ++i)
        chosen.insert(i * (all.size() - 1) / (kFitPoses - 1));
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
        std::array<double, 2> most{};
        std::array<std::size_t, 2> at{};
        for (std::size_t p = 0; p < all.size(); ++p) {
            const osgSkin::BendTwist split = all[p]->transform(j).split;
            const std::array<double, 2> angles{split.bendAngle, std::abs(split.twistAngle)};
            for (std::size_t k = 0; k < 2; ++k)
                if (angles[k] > most[k]) {
                    most[k] = angles[k];
                    at[k] = p;
                }
        }
        chosen.insert(at.begin(), at.end());
    }
    std::vector<osgSkin::Pose> result;
    for (const std::size_t p : chosen) result.push_back(*all[p]);
    return result;
}

/// A shape of all vertices that a clip drives: a morph target or a mode of a joint's correctives.
struct Shape {
    std::string name;
    float initial = 0.0f;
    std::vector<std::vector<float>> weights; ///< of each clip, one per pose
    /// Of each surface: vertices, and how far they and their normals move, rest space.
    struct Moves {
        std::vector<std::uint32_t> vertices;
        std::vector<glm::dvec3> positions, normals;
    };
    std::vector<Moves> surfaces;
};

/// A character's morph targets as the drawables have them.
std::vector<Shape> morphShapes(const Character& character, const std::vector<Surface>& surfaces,
                               const std::vector<RiggedClip>& clips) {
    std::vector<const osgSkin::MorphTargets*> pieces;
    for (const auto& skin : character.skin.skins)
        pieces.push_back(skin.drawable->getMorphTargets());
    for (const auto& rigid : character.skin.rigids) {
        const auto* skin = dynamic_cast<const osgSkin::DeformableSkin*>(rigid.node->getChild(0));
        pieces.push_back(skin ? skin->getMorphTargets() : nullptr);
    }
    std::vector<Shape> shapes;
    for (const std::string& name : character.morphs()) {
        Shape shape;
        shape.name = name;
        for (const RiggedClip& clip : clips) {
            shape.weights.emplace_back();
            for (const std::vector<float>& morphs : clip.morphs)
                shape.weights.back().push_back(morphs[shapes.size()]);
        }
        for (const Surface& surface : surfaces) {
            Shape::Moves moves;
            for (std::uint32_t v = 0; v < surface.drawn.size(); ++v) {
                const Surface::Drawn& at = surface.drawn[v];
                const osgSkin::MorphTargets* of = pieces[at.piece];
                const std::size_t t = of ? of->find(name) : 0;
                if (!of || t == of->targets().size()) continue;
                const osgSkin::MorphTarget& target = of->targets()[t];
                shape.initial = target.initial;
                const auto found =
                    std::lower_bound(target.vertices.begin(), target.vertices.end(), at.vertex);
                if (found == target.vertices.end() || *found != at.vertex) continue;
                const auto i = std::size_t(found - target.vertices.begin());
                moves.vertices.push_back(v);
                moves.positions.emplace_back(target.positions[i]);
                moves.normals.emplace_back(target.normals.empty() ? glm::vec3(0.0f)
                                                                  : target.normals[i]);
            }
            shape.surfaces.push_back(std::move(moves));
        }
        shapes.push_back(std::move(shape));
    }
    return shapes;
}

/// Adds what a mode moves, at the weight `scale`.
void addMoves(Shape& shape, const Correctives& from, std::uint32_t corrective, std::size_t mode,
              double scale, const std::vector<Surface>& surfaces) {
    const auto share = [&](const std::vector<std::int16_t>& shares, std::size_t at) {
        return glm::dvec3(shares[at], shares[at + 1], shares[at + 2]) * scale /
               double(Correctives::kUnit);
    };
    for (const Surface& surface : surfaces) {
        Shape::Moves moves;
        for (std::uint32_t v = 0; v < surface.sourceVertex.size(); ++v) {
            const std::uint32_t source = surface.sourceVertex[v];
            for (std::uint32_t i = from.firstEntry[source]; i < from.firstEntry[source + 1]; ++i) {
                if (from.entries[i].joint != corrective) continue;
                const std::size_t at = from.entries[i].firstShare + 3 * mode;
                const glm::dvec3 position = share(from.shares, at);
                if (glm::length(position) < 1e-3 * std::abs(scale)) continue;
                moves.vertices.push_back(v);
                moves.positions.push_back(position);
                moves.normals.push_back(from.hasNormals()
                                            ? share(from.normalShares, at) *
                                                  from.joints[corrective].normalScales[mode]
                                            : glm::dvec3(0.0));
            }
        }
        shape.surfaces.push_back(std::move(moves));
    }
}

/// The modes of the correctives as shapes. Many engines clamp weights to 0..1, so a mode becomes
/// two shapes, one for its negative weights; those that no clip uses are left out.
std::vector<Shape> correctiveShapes(const Character& character,
                                    const std::vector<Surface>& surfaces,
                                    const std::vector<RiggedClip>& clips) {
    const osgSkin::Binding& binding = character.binding;
    const Correctives& from = binding.correctives;
    const double negligible = kNegligible * character.body.mesh.size();
    std::vector<Shape> shapes;
    for (std::uint32_t c = 0; !from.empty() && c < from.joints.size(); ++c) {
        const CorrectiveJoint& joint = from.joints[c];
        std::vector<Shape> modes(2 * joint.modes);
        std::vector<double> most(modes.size(), 0.0);
        for (const RiggedClip& clip : clips) {
            for (Shape& mode : modes) mode.weights.emplace_back();
            for (const osgSkin::Pose& pose : clip.poses) {
                const ModeWeights weights = modeWeights(pose, joint, binding);
                for (std::size_t k = 0; k < modes.size(); ++k) {
                    const double weight = k % 2 == 0 ? weights[k / 2] : -weights[k / 2];
                    modes[k].weights.back().push_back(float(std::max(weight, 0.0)));
                    most[k] = std::max(most[k], weight);
                }
            }
        }
        std::size_t number = 0;
        for (std::size_t k = 0; k < modes.size(); ++k) {
            if (most[k] < negligible) continue; // vectors are about 1 long at most
            const bool isInput = joint.basis == CorrectiveJoint::Basis::Input;
            modes[k].name =
                (isInput ? from.inputs[joint.joint] : binding.joints[joint.joint].name) +
                "_shape_" + std::to_string(++number);
            for (std::vector<float>& weights : modes[k].weights)
                for (float& weight : weights) weight = float(double(weight) / most[k]);
            addMoves(modes[k], from, c, k / 2, k % 2 == 0 ? most[k] : -most[k], surfaces);
            shapes.push_back(std::move(modes[k]));
        }
    }
    return shapes;
}

/// The keys of one property of a node in a clip.
class Keys {
public:
    /// \param atRest the property in the rest pose
    explicit Keys(std::vector<double> atRest) : _atRest(std::move(atRest)) {}

    void add(const double* numbers) { _keys.insert(_keys.end(), numbers, numbers + width()); }
    /// Whether a key differs from the rest pose.
    bool moves() const { return differs(_atRest.data()); }
    /// The keys, or one where all are the same.
    std::vector<float> numbers() const {
        const auto end = differs(_keys.data()) ? _keys.end() : _keys.begin() + width();
        return {_keys.begin(), end};
    }
    std::size_t width() const { return _atRest.size(); }

private:
    bool differs(const double* from) const {
        for (std::size_t i = 0; i < _keys.size(); ++i)
            if (std::abs(_keys[i] - from[i % width()]) > kUnmoved) return true;
        return false;
    }
    std::vector<double> _atRest, _keys;
};

/// The clip of a character that has none: without it nothing would move helpers.
std::vector<RiggedClip> rangesClip(const Character& character) {
    RiggedClip clip{kRangesClip, kRangesSeconds, jointRanges(character.binding), {}};
    std::vector<float> weights;
    for (const std::string& name : character.morphs())
        weights.push_back(osgSkin::getMorph(*character.root, name));
    clip.morphs.assign(clip.poses.size(), weights);
    return {clip};
}

/// Writes the nodes, the skin, the mesh and the animations.
class Rig {
public:
    Rig(const Character& character, const std::vector<RiggedClip>& clips,
        const LinearSkinOptions& options)
        : _character(character), _joints(character.binding.joints), _clips(clips),
          _toGltf(character), _surfaces(surfacesOf(character)), _vrm(character) {
        LinearSkinOptions fit = options;
        // Programs pose a VRM's bones themselves.
        if (clips.empty() && _vrm.isHuman()) fit.helpers = 0;
        _skin = fitLinearSkin(character.binding, character.body.mesh.positions,
                              fitPoses(character.binding, clips), fit);
        _report.hasRanges = clips.empty() && !_skin.helpers.empty();
        if (_report.hasRanges) _clips = rangesClip(character);
        _shapes = morphShapes(character, _surfaces, _clips);
        _report.morphs = _shapes.size();
        for (Shape& shape : correctiveShapes(character, _surfaces, _clips))
            _shapes.push_back(std::move(shape));
        _report.joints = _joints.size();
        _report.helpers = _skin.helpers.size();
        _report.correctives = _shapes.size() - _report.morphs;
        _report.worst = _skin.worst;
        _report.isHuman = _vrm.isHuman();
        _report.vrmNote = _vrm.note();
        _report.leftOut = _vrm.leftOut();
    }

    const RiggedReport& write(const std::string& file, std::size_t weights) {
        nlohmann::json root{{"asset", {{"version", "2.0"}, {"generator", "osgskinbake"}}},
                            {"scene", 0}};
        root["nodes"] = nodes();
        const std::size_t meshNode = root["nodes"].size();
        root["nodes"].push_back({{"name", "skin"}, {"mesh", 0}, {"skin", 0}});
        root["scenes"] = {{{"nodes", {0, meshNode}}}};
        root["skins"] = {skin(meshNode)};
        GlbMaterials materials(_buffer, osgDB::getFilePath(_character.meshFile));
        root["meshes"] = {mesh(materials, weights)};
        materials.finish(root);
        nlohmann::json animations = animate(meshNode);
        if (!animations.empty()) root["animations"] = std::move(animations);
        std::vector<std::string> morphs;
        for (const Shape& shape : _shapes) morphs.push_back(shape.name);
        _vrm.write(morphs, meshNode, root);
        _buffer.write(file, root);
        return _report;
    }

private:
    /// The place of a joint or helper at rest, rest space.
    const glm::dvec3& centre(std::size_t node) const {
        return _joints[node < _joints.size() ? node : helper(node).joint].centre;
    }
    const HelperJoint& helper(std::size_t node) const {
        return _skin.helpers[node - _joints.size()];
    }
    int parent(std::size_t node) const {
        return node < _joints.size() ? _joints[node].parent : int(helper(node).parent);
    }
    std::size_t nodeCount() const { return _joints.size() + _skin.helpers.size(); }

    nlohmann::json nodes() const {
        std::vector<std::size_t> numbers(_joints.size(), 0);
        nlohmann::json result = nlohmann::json::array();
        for (std::size_t n = 0; n < nodeCount(); ++n) {
            const glm::dvec3 at = _toGltf.vector(
                parent(n) < 0 ? centre(n) : centre(n) - centre(std::size_t(parent(n))));
            std::string name = n < _joints.size() ? _joints[n].name : "";
            if (name.empty() && n >= _joints.size())
                name = _joints[helper(n).joint].name + "_helper_" +
                       std::to_string(++numbers[helper(n).joint]);
            result.push_back({{"name", name}, {"translation", {at.x, at.y, at.z}}});
            if (n >= _joints.size())
                for (const osgSkin::Influence& of : helper(n).ratios)
                    result.back()["extras"]["follows"].push_back({of.joint, of.bend, of.twist});
            if (parent(n) >= 0) result[std::size_t(parent(n))]["children"].push_back(n);
        }
        return result;
    }

    nlohmann::json skin(std::size_t count) {
        std::vector<float> matrices;
        nlohmann::json joints = nlohmann::json::array();
        for (std::size_t n = 0; n < count; ++n) {
            const glm::vec3 at(_toGltf.vector(centre(n)));
            for (const float number : {1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                                       1.0f, 0.0f, -at.x, -at.y, -at.z, 1.0f})
                matrices.push_back(number);
            joints.push_back(n);
        }
        return {{"joints", joints},
                {"skeleton", 0},
                {"inverseBindMatrices", _buffer.addFloats(matrices, "MAT4", 16)}};
    }

    nlohmann::json mesh(GlbMaterials& materials, std::size_t weights) {
        nlohmann::json primitives = nlohmann::json::array();
        for (std::size_t s = 0; s < _surfaces.size(); ++s) {
            const SurfaceMaterial material = SurfaceMaterial::of(_surfaces[s]);
            nlohmann::json entry = primitive(s, material, weights);
            entry["material"] = materials.add(material, materialName(s));
            primitives.push_back(std::move(entry));
        }
        nlohmann::json result{{"name", "skin"}, {"primitives", primitives}};
        for (const Shape& shape : _shapes) {
            result["weights"].push_back(shape.initial);
            result["extras"]["targetNames"].push_back(
                shape.name + (_vrm.isExpression(shape.name) ? "_shape" : ""));
        }
        return result;
    }

    nlohmann::json primitive(std::size_t s, const SurfaceMaterial& material, std::size_t weights) {
        const Surface& surface = _surfaces[s];
        const std::vector<std::uint32_t>& source = surface.sourceVertex;
        std::vector<glm::dvec3> positions, normals;
        for (std::size_t v = 0; v < source.size(); ++v) {
            positions.push_back(_character.body.mesh.positions[source[v]]);
            normals.push_back(surface.restNormals[v]);
        }
        nlohmann::json targets = nlohmann::json::array();
        for (const Shape& shape : _shapes) {
            std::vector<glm::dvec3> moved, turned;
            const Shape::Moves& moves = shape.surfaces[s];
            for (std::size_t i = 0; i < moves.vertices.size(); ++i) {
                // Rest vertices have the initial weight.
                positions[moves.vertices[i]] -= double(shape.initial) * moves.positions[i];
                moved.push_back(_toGltf.vector(moves.positions[i]));
                turned.push_back(_toGltf.direction(moves.normals[i]));
            }
            targets.push_back(
                {{"POSITION", _buffer.addSparse(source.size(), moves.vertices, moved)},
                 {"NORMAL", _buffer.addSparse(source.size(), moves.vertices, turned)}});
        }
        for (glm::dvec3& position : positions) position = _toGltf.vector(position);
        for (glm::dvec3& normal : normals) normal = _toGltf.direction(normal);
        nlohmann::json attributes{{"POSITION", _buffer.addVectors(positions, true)},
                                  {"NORMAL", _buffer.addVectors(normals, false)}};
        if (!surface.texCoords.empty())
            attributes["TEXCOORD_0"] = _buffer.addTexCoords(surface.texCoords);
        if (material.vertexColours) {
            std::vector<osg::Vec4> colours;
            for (const osg::Vec4& colour : surface.colours) colours.push_back(linear(colour));
            attributes["COLOR_0"] = _buffer.addColours(colours);
        }
        for (std::size_t first = 0; first < weights; first += 4) {
            std::vector<std::uint16_t> joints;
            std::vector<float> shares;
            for (const std::uint32_t v : source)
                for (std::size_t i = first; i < first + 4; ++i) {
                    const std::vector<LinearSkin::Weight>& of = _skin.vertices[v];
                    const bool has = i < of.size();
                    joints.push_back(std::uint16_t(has ? of[i].joint : 0));
                    shares.push_back(has ? of[i].weight : 0.0f);
                }
            const std::string set = std::to_string(first / 4);
            attributes["JOINTS_" + set] = _buffer.addJoints(joints);
            attributes["WEIGHTS_" + set] = _buffer.addWeights(shares);
        }
        nlohmann::json result{{"attributes", attributes},
                              {"indices", _buffer.addIndices(surface.triangles)}};
        if (!targets.empty()) result["targets"] = std::move(targets);
        return result;
    }

    /// A clip's keys of a node: rotation, translation, scale.
    using NodeKeys = std::array<Keys, 3>;

    std::vector<NodeKeys> keysOf(const RiggedClip& clip) const {
        std::vector<NodeKeys> keys;
        for (std::size_t n = 0; n < nodeCount(); ++n) {
            const glm::dvec3 at = _toGltf.vector(
                parent(n) < 0 ? centre(n) : centre(n) - centre(std::size_t(parent(n))));
            keys.push_back(
                {Keys({0.0, 0.0, 0.0, 1.0}), Keys({at.x, at.y, at.z}), Keys({1.0, 1.0, 1.0})});
        }
        std::vector<glm::dquat> before(nodeCount(), glm::dquat(1.0, 0.0, 0.0, 0.0));
        for (const osgSkin::Pose& pose : clip.poses) {
            const PosedJoints posed(_joints, pose);
            std::vector<JointMap> maps; // of rest space
            for (std::size_t n = 0; n < nodeCount(); ++n) {
                JointMap local; // relative to the parent
                if (n >= _joints.size()) {
                    local = inverse(maps[helper(n).parent]) * posed.product(helper(n).ratios);
                } else {
                    local = posed.own({std::uint32_t(n), 1.0f, 1.0f});
                    maps.push_back(parent(n) < 0 ? local : maps[std::size_t(parent(n))] * local);
                }
                glm::dvec3 at = local * centre(n);
                if (parent(n) >= 0) at -= centre(std::size_t(parent(n)));
                at = _toGltf.vector(at);
                glm::dquat q = glm::normalize(_toGltf.rotation(local.rotation));
                if (glm::dot(q, before[n]) < 0.0) q = -q; // blends the short way
                before[n] = q;
                const std::array<double, 4> rotation{q.x, q.y, q.z, q.w};
                const std::array<double, 3> scale{local.scale, local.scale, local.scale};
                keys[n][0].add(rotation.data());
                keys[n][1].add(&at.x);
                keys[n][2].add(scale.data());
            }
        }
        return keys;
    }

    nlohmann::json animate(std::size_t meshNode) {
        // A node that moves in one clip has keys in all, so that each can follow any other.
        std::vector<std::array<bool, 3>> moves(nodeCount());
        for (const RiggedClip& clip : _clips) {
            const std::vector<NodeKeys> keys = keysOf(clip);
            for (std::size_t n = 0; n < nodeCount(); ++n)
                for (std::size_t k = 0; k < 3; ++k) moves[n][k] = moves[n][k] || keys[n][k].moves();
        }
        nlohmann::json result = nlohmann::json::array();
        for (std::size_t c = 0; c < _clips.size(); ++c) {
            const RiggedClip& clip = _clips[c];
            std::vector<float> times;
            for (std::size_t f = 0; f < clip.poses.size(); ++f)
                times.push_back(float(double(f) * clip.seconds));
            std::map<bool, std::size_t> inputs; // by whether there is one key alone
            const auto input = [&](bool isOne) {
                const auto [entry, isNew] = inputs.emplace(isOne, 0);
                if (isNew) entry->second = _buffer.addTimes(isOne ? std::vector{0.0f} : times);
                return entry->second;
            };
            nlohmann::json samplers = nlohmann::json::array(), channels = nlohmann::json::array();
            const auto add = [&](std::size_t node, const char* path, bool isOne,
                                 std::size_t output) {
                channels.push_back(
                    {{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
                samplers.push_back({{"input", input(isOne)}, {"output", output}});
            };
            const std::vector<NodeKeys> keys = keysOf(clip);
            for (std::size_t n = 0; n < nodeCount(); ++n)
                for (std::size_t k = 0; k < 3; ++k) {
                    if (!moves[n][k]) continue;
                    constexpr std::array<const char*, 3> kPaths{"rotation", "translation", "scale"};
                    const std::vector<float> numbers = keys[n][k].numbers();
                    add(n, kPaths[k], numbers.size() == keys[n][k].width(),
                        _buffer.addFloats(numbers, k == 0 ? "VEC4" : "VEC3", keys[n][k].width()));
                }
            std::vector<float> weights;
            for (std::size_t f = 0; f < clip.poses.size(); ++f)
                for (const Shape& shape : _shapes) weights.push_back(shape.weights[c][f]);
            if (!weights.empty()) add(meshNode, "weights", false, _buffer.addNumbers(weights));
            if (channels.empty()) continue;
            result.push_back({{"name", clip.name}, {"samplers", samplers}, {"channels", channels}});
        }
        return result;
    }

    const Character& _character;
    const std::vector<osgSkin::BoundJoint>& _joints;
    std::vector<RiggedClip> _clips;
    ToGltf _toGltf;
    std::vector<Surface> _surfaces;
    std::vector<Shape> _shapes;
    Vrm _vrm;
    LinearSkin _skin;
    RiggedReport _report;
    GlbBuffer _buffer;
};

} // namespace

RiggedReport writeRigged(const std::string& file, const Character& character,
                         const std::vector<RiggedClip>& clips, const LinearSkinOptions& options) {
    return Rig(character, clips, options).write(file, options.weights);
}

} // namespace bake
