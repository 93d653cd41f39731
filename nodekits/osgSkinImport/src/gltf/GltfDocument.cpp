// SPDX-License-Identifier: MIT
#include "gltf/GltfDocument.h"

#include "files/FileText.h"
#include "files/UniqueName.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <unordered_set>

namespace osgSkin {

using nlohmann::json;

namespace {

// The cost of a mesh, in elements of 64 bytes.
constexpr std::size_t kRead = 1;        // elements per vertex read
constexpr std::size_t kDrawn = 12;      // elements per vertex bound and deformed
constexpr std::size_t kReadCorners = 4; // corners per element
constexpr std::size_t kDrawnCorners = 2;

/// The name of a numbered attribute: "TEXCOORD_1".
std::string numbered(const char* start, std::size_t set) {
    return start + std::to_string(set);
}

} // namespace

class DocumentReader {
public:
    explicit DocumentReader(GltfDocument& document)
        : _document(document), _file(document.file), _accessors(document.accessors) {}

    void run() {
        readMaterials(_document);
        readMeshes();
        readSkins();
        readNodes();
        readExpressions(_document);
        readScenes();
        readAnimations();
        _file.checkEntries();
        if (_unfinished > 0)
            warn(_file.path,
                 "incomplete triangles ignored in " + std::to_string(_unfinished) + " primitives");
        if (_placedTwice > 0)
            warn(_file.path, std::to_string(_placedTwice) +
                                 " nodes have a matrix and a translation, rotation or scale; the "
                                 "matrix is used");
    }

private:
    /// The cost of a mesh when it is read, and per node that shows it.
    struct Cost {
        std::size_t elements = 0, drawn = 0, targets = 0, allTargets = 0;
    };

    // --- meshes ---

    void readMeshes() {
        _file.forEach("meshes", [&](const json& from, const std::string& where) {
            GltfMesh mesh;
            mesh.name = nameOf(from);
            mesh.weights = _file.weights(from, where);
            _costs.emplace_back();
            const json& primitives = from.at("primitives");
            if (!primitives.is_array()) _file.fail(where + ".primitives", "a list");
            for (std::size_t p = 0; p < primitives.size(); ++p)
                readPrimitive(primitives[p], where + ".primitives[" + std::to_string(p) + "]",
                              mesh);
            if (mesh.primitives.empty())
                _file.fail(where + ".primitives", "at least one with positions");
            for (const GltfPrimitive& primitive : mesh.primitives) {
                _costs.back().targets = std::max(_costs.back().targets, primitive.targets.size());
                _costs.back().allTargets += primitive.targets.size();
            }
            if (mesh.weights.size() > _costs.back().targets)
                mesh.weights.resize(_costs.back().targets);
            mesh.targetNames = targetNames(from, where, _costs.back().targets);
            _file.addEntries(mesh.primitives.size());
            _document.meshes.push_back(std::move(mesh));
        });
    }

    /// The names of morph targets, which exporters add to a mesh or its primitives; "face-3" where
    /// there is none.
    std::vector<std::string> targetNames(const json& mesh, const std::string& where,
                                         std::size_t count) {
        const json* names = nullptr;
        const auto look = [&names](const json& from) {
            const auto extras = from.find("extras");
            if (names || extras == from.end() || !extras->is_object()) return;
            const auto found = extras->find("targetNames");
            if (found != extras->end() && found->is_array()) names = &*found;
        };
        look(mesh);
        for (const json& primitive : mesh.at("primitives")) look(primitive);
        std::vector<std::string> result(count);
        if (count == 0) return result;
        const std::string own = nameOf(mesh);
        const std::string label = _targetLabels.unique(own.empty() ? where : own);
        for (std::size_t t = 0; t < count; ++t) {
            if (names && t < names->size() && (*names)[t].is_string())
                result[t] = nameOf({{"name", (*names)[t]}});
            if (result[t].empty()) result[t] = label + "-" + std::to_string(t);
        }
        return result;
    }

    void readPrimitive(const json& from, const std::string& where, GltfMesh& mesh) {
        const json& attributes = from.at("attributes");
        if (!attributes.is_object()) _file.fail(where + ".attributes", "an object");
        if (!attributes.contains("POSITION")) return; // nothing to draw
        GltfPrimitive primitive;
        const std::size_t vertices =
            _accessors[_accessors.indexOf(attributes.at("POSITION"), where + ".POSITION")].count;
        for (const char* fifth : {"JOINTS_4", "WEIGHTS_4"})
            if (attributes.contains(fifth))
                _file.fail(where + "." + fifth, "four sets of joints and weights at most");
        const auto attribute = [&](const std::string& name,
                                   std::initializer_list<const char*> types) -> GltfIndex {
            const auto found = attributes.find(name);
            if (found == attributes.end()) return std::nullopt;
            const std::string place = where + "." + name;
            const std::size_t accessor = _accessors.indexOf(*found, place);
            _accessors.requireType(accessor, types, place);
            if (name.rfind("JOINTS_", 0) == 0) _accessors.requireIndices(accessor, false, place);
            if (_accessors[accessor].count != vertices)
                _file.fail(place, std::to_string(vertices) + " elements, as many as of POSITION");
            return accessor;
        };
        primitive.positions = *attribute("POSITION", {"VEC3"});
        primitive.normals = attribute("NORMAL", {"VEC3"});
        primitive.colours = attribute("COLOR_0", {"VEC3", "VEC4"});
        for (std::size_t set = 0; set < primitive.texCoords.size(); ++set)
            primitive.texCoords[set] = attribute(numbered("TEXCOORD_", set), {"VEC2"});
        for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
            const GltfIndex joints = attribute(numbered("JOINTS_", set), {"VEC4"});
            const GltfIndex weights = attribute(numbered("WEIGHTS_", set), {"VEC4"});
            if (!joints || !weights) continue; // ignored unless both exist
            primitive.joints[set] = joints;
            primitive.weights[set] = weights;
        }
        std::size_t corners = vertices;
        if (from.contains("indices")) {
            const std::string place = where + ".indices";
            primitive.indices = _accessors.indexOf(from.at("indices"), place);
            _accessors.requireType(*primitive.indices, {"SCALAR"}, place);
            _accessors.requireIndices(*primitive.indices, true, place);
            corners = _accessors[*primitive.indices].count;
        }
        if (from.contains("mode"))
            primitive.mode = _file.index(from.at("mode"), 7, where + ".mode");
        if (from.contains("material"))
            primitive.material = _file.indexOf(from.at("material"), "materials", where);
        if (primitive.material && _document.materials[*primitive.material].usesTangents())
            primitive.tangents = attribute("TANGENT", {"VEC4"});
        readDraco(from, where, primitive);
        if (!primitive.draco) {
            checkStored(primitive, where);
            checkMode(corners, primitive);
            if (primitive.mode == 0 && !primitive.indices) corners = vertices;
        }
        readTargets(from, vertices, where, primitive);
        countPrimitive(primitive, vertices, corners, where);
        mesh.primitives.push_back(std::move(primitive));
    }

    void countPrimitive(const GltfPrimitive& primitive, std::size_t vertices, std::size_t corners,
                        const std::string& where) {
        const std::size_t read = kRead * vertices + corners / kReadCorners;
        _file.take(read, where);
        Cost& cost = _costs.back();
        cost.elements += read;
        if (primitive.mode == 0) return; // points are not drawn
        const std::size_t named =
            primitive.indices ? countNamed(*primitive.indices, vertices) : vertices;
        cost.drawn += kDrawn * named + corners / kDrawnCorners;
    }

    /// How many of `vertices` the indices use. A primitive of one material often uses a few of the
    /// vertices that all primitives of a body share.
    std::size_t countNamed(std::size_t accessor, std::size_t vertices) {
        const GltfAccessor& source = _accessors[accessor];
        if (!source.stored || source.sparse) return std::min(source.count, vertices);
        const auto [known, isNew] = _named.emplace(std::make_pair(accessor, vertices), 0);
        if (!isNew) return known->second;
        std::vector<bool> isNamed(vertices, false);
        for (const std::uint32_t vertex : _accessors.integers(accessor)) {
            if (vertex >= vertices || isNamed[vertex]) continue;
            isNamed[vertex] = true;
            ++known->second;
        }
        return known->second;
    }

    void readDraco(const json& from, const std::string& where, GltfPrimitive& primitive) const {
        constexpr std::size_t kFarthest = 1 << 30; // larger ids are invalid
        const auto extensions = from.find("extensions");
        if (extensions == from.end()) return;
        const auto found = extensions->find("KHR_draco_mesh_compression");
        if (found == extensions->end()) return;
        GltfPrimitive::Draco draco;
        draco.view = _file.indexOf(found->at("bufferView"), "bufferViews", where);
        const std::string error = _accessors.viewError(found->at("bufferView"), 0, 0, 0, true);
        if (!error.empty()) _file.fail(where + ".extensions", error);
        for (const auto& [name, id] : found->at("attributes").items())
            if (from.at("attributes").contains(name))
                draco.ids[name] = _file.index(id, kFarthest, where + ".extensions");
        primitive.draco = std::move(draco);
    }

    /// Points, lines and surfaces with too few corners become points, which are not drawn.
    void checkMode(std::size_t corners, GltfPrimitive& primitive) {
        constexpr std::size_t kTriangles = 4;
        const bool isSurface = primitive.mode >= kTriangles;
        if (isSurface && (corners < 3 || (primitive.mode == kTriangles && corners % 3 != 0)))
            ++_unfinished;
        if (isSurface && corners >= 3) return;
        primitive.mode = 0;
        primitive.indices.reset();
    }

    /// Without Draco, indices and joints must have values in the file. Other accessors without
    /// values, all zeros, count against the limit.
    void checkStored(const GltfPrimitive& primitive, const std::string& where) {
        const auto takeZeros = [&](const GltfIndex& accessor, const std::string& place) {
            if (accessor && !_accessors[*accessor].stored)
                _file.take(_accessors[*accessor].width * _accessors[*accessor].count, place);
        };
        if (primitive.indices) _accessors.requireValues(*primitive.indices, where + ".indices");
        takeZeros(primitive.indices, where + ".indices");
        takeZeros(primitive.positions, where + ".POSITION");
        takeZeros(primitive.normals, where + ".NORMAL");
        takeZeros(primitive.tangents, where + ".TANGENT");
        takeZeros(primitive.colours, where + ".COLOR_0");
        for (std::size_t set = 0; set < primitive.texCoords.size(); ++set)
            takeZeros(primitive.texCoords[set], where + "." + numbered("TEXCOORD_", set));
        for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
            const std::string place = where + "." + numbered("JOINTS_", set);
            if (primitive.joints[set]) _accessors.requireValues(*primitive.joints[set], place);
            takeZeros(primitive.joints[set], place);
            takeZeros(primitive.weights[set], where + "." + numbered("WEIGHTS_", set));
        }
    }

    void readTargets(const json& from, std::size_t vertices, const std::string& where,
                     GltfPrimitive& primitive) {
        const auto targets = from.find("targets");
        if (targets == from.end()) return;
        if (!targets->is_array()) _file.fail(where + ".targets", "a list");
        for (const json& target : *targets) {
            const auto attribute = [&](const char* name) -> GltfIndex {
                if (!target.contains(name)) return std::nullopt;
                const std::string place = where + ".targets." + name;
                const std::size_t accessor = _accessors.indexOf(target.at(name), place);
                _accessors.requireType(accessor, {"VEC3"}, place);
                if (_accessors[accessor].count != vertices)
                    _file.fail(place, std::to_string(vertices) + " elements, one a vertex");
                return accessor;
            };
            GltfPrimitive::Target& known = primitive.targets.emplace_back();
            known.positions = attribute("POSITION");
            known.normals = attribute("NORMAL");
            if (from.at("attributes").contains("TANGENT")) known.tangents = attribute("TANGENT");
            _file.addEntries(1);
        }
    }

    // --- skins and nodes ---

    void readSkins() {
        _file.forEach("skins", [&](const json& from, const std::string& where) {
            GltfSkin skin;
            skin.name = nameOf(from);
            const json& joints = from.at("joints");
            if (!joints.is_array() || joints.empty()) _file.fail(where + ".joints", "a list");
            std::unordered_set<std::size_t> named;
            for (const json& joint : joints) {
                const std::size_t node = _file.indexOf(joint, "nodes", where + ".joints");
                if (!named.insert(node).second)
                    _file.fail(where + ".joints",
                               "each node once, found " + std::to_string(node) + " again");
                skin.joints.push_back(node);
            }
            if (from.contains("inverseBindMatrices")) {
                const std::string place = where + ".inverseBindMatrices";
                skin.inverseBinds = _accessors.indexOf(from.at("inverseBindMatrices"), place);
                _accessors.requireType(*skin.inverseBinds, {"MAT4"}, place);
                _file.take(4 * _accessors[*skin.inverseBinds].count, place); // 16 numbers each
            }
            _file.addEntries(joints.size());
            _document.skins.push_back(std::move(skin));
        });
    }

    void readNodes() {
        std::vector<GltfNode>& nodes = _document.nodes;
        nodes.resize(_file.size("nodes"));
        std::set<std::size_t> shown; // meshes
        std::size_t index = 0;
        _file.forEach("nodes", [&](const json& from, const std::string& where) {
            GltfNode& node = nodes[index];
            node.name = nameOf(from);
            readTransform(from, where, node);
            node.weights = _file.weights(from, where);
            node.hasWeights = from.contains("weights") && from.at("weights").is_array();
            if (from.contains("mesh"))
                node.mesh = _file.indexOf(from.at("mesh"), "meshes", where + ".mesh");
            const std::size_t targets = node.mesh ? _costs[*node.mesh].targets : 0;
            if (node.weights.size() > targets) node.weights.resize(targets);
            if (targets == 0) node.hasWeights = false;
            if (node.mesh) { // every node that shows a mesh makes a copy of it
                const Cost& cost = _costs[*node.mesh];
                if (!shown.insert(*node.mesh).second) {
                    _file.addEntries(cost.allTargets);
                    _file.take(cost.elements, where + ".mesh");
                }
                _file.take(cost.drawn, where + ".mesh");
                _file.addEntries(_document.meshes[*node.mesh].primitives.size());
            }
            if (from.contains("skin"))
                node.skin = _file.indexOf(from.at("skin"), "skins", where + ".skin");
            if (node.mesh && node.skin) // each mesh has its own bones
                _file.addEntries(_document.meshes[*node.mesh].primitives.size() *
                                 _document.skins[*node.skin].joints.size());
            if (from.contains("children")) {
                const json& children = from.at("children");
                if (!children.is_array()) _file.fail(where + ".children", "a list");
                for (const json& child : children) {
                    const std::size_t below = _file.indexOf(child, "nodes", where + ".children");
                    if (nodes[below].parent)
                        _file.fail(where + ".children",
                                   "nodes without another parent, or recursive reference");
                    nodes[below].parent = index;
                    node.children.push_back(below);
                }
            }
            ++index;
        });
        checkDepths();
    }

    void readTransform(const json& from, const std::string& where, GltfNode& node) {
        const std::vector<double> matrix = _file.numbers(from, "matrix", 16, where);
        node.translation = _file.numbers(from, "translation", 3, where);
        node.rotation = _file.numbers(from, "rotation", 4, where);
        node.scale = _file.numbers(from, "scale", 3, where);
        if (!matrix.empty()) {
            if (!node.translation.empty() || !node.rotation.empty() || !node.scale.empty())
                ++_placedTwice;
            node.translation.clear();
            node.rotation.clear();
            node.scale.clear();
            node.hasMatrix = true;
            for (int k = 0; k < 16; ++k)
                node.matrix[k / 4][k % 4] = double(float(matrix[std::size_t(k)]));
            return;
        }
        makeUnit(node.rotation);
        // Clamp scales of 0, which hide a part, so that the joint's matrix stays invertible.
        constexpr double kMinScale = 1e-5;
        for (double& scale : node.scale)
            if (std::abs(scale) < kMinScale) scale = std::copysign(kMinScale, scale);
        // In single precision, like the file's numbers.
        glm::mat3 axes(1.0f);
        if (!node.rotation.empty())
            axes = glm::mat3_cast(glm::quat(float(node.rotation[3]), float(node.rotation[0]),
                                            float(node.rotation[1]), float(node.rotation[2])));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int column = static_cast<int>(axis);
            if (!node.scale.empty()) axes[column] *= float(node.scale[axis]);
            node.matrix[column] = glm::dvec4(glm::dvec3(axes[column]), 0.0);
            if (!node.translation.empty())
                node.matrix[3][column] = double(float(node.translation[axis]));
        }
    }

    /// Normalises rotations: a quaternion that is not of unit length would scale unevenly.
    static void makeUnit(std::vector<double>& rotation) {
        double squares = 0.0;
        for (const double number : rotation) squares += number * number;
        if (!(squares > 0.0) || std::abs(squares - 1.0) < 1e-6) return;
        for (double& number : rotation) number /= std::sqrt(squares);
    }

    /// Every node has at most one parent, so following parents ends unless there is a cycle.
    void checkDepths() const {
        const std::size_t count = _document.nodes.size();
        std::vector<std::size_t> depths(count, 0); // 0: not known yet
        std::vector<std::size_t> path;
        for (std::size_t n = 0; n < count; ++n) {
            path.clear();
            GltfIndex at = n;
            while (at && depths[*at] == 0 && path.size() <= count) {
                path.push_back(*at);
                at = _document.nodes[*at].parent;
            }
            const std::string where = "nodes[" + std::to_string(n) + "]";
            if (path.size() > count) _file.fail(where, "a tree, found a recursive reference");
            std::size_t depth = at ? depths[*at] : 0;
            while (!path.empty()) {
                depths[path.back()] = ++depth;
                path.pop_back();
            }
            if (depth > _file.limits.depth)
                _file.fail(where, "a node nested at most " + std::to_string(_file.limits.depth) +
                                      " deep (option maxDepth)");
        }
    }

    void readScenes() {
        std::vector<std::vector<std::size_t>> scenes;
        std::vector<bool> shown(_document.nodes.size(), false);
        _file.forEach("scenes", [&](const json& from, const std::string& where) {
            std::vector<std::size_t>& scene = scenes.emplace_back();
            std::fill(shown.begin(), shown.end(), false);
            for (const json& root : from.value("nodes", json::array())) {
                const std::size_t node = _file.indexOf(root, "nodes", where + ".nodes");
                if (_document.nodes[node].parent || shown[node])
                    _file.fail(where + ".nodes", "each a node without a parent, and once");
                shown[node] = true;
                scene.push_back(node);
            }
            _file.addEntries(scene.size());
        });
        if (_file.json.contains("scene")) {
            _document.roots = scenes[_file.indexOf(_file.json.at("scene"), "scenes", "scene")];
        } else if (!scenes.empty()) {
            _document.roots = scenes.front();
        } else { // a file of assets or clips without a scene
            for (std::size_t n = 0; n < _document.nodes.size(); ++n)
                if (!_document.nodes[n].parent) _document.roots.push_back(n);
        }
    }

    // --- animations ---

    /// Reads a channel of KHR_animation_pointer as an ordinary one if its pointer is
    /// "/nodes/3/rotation" or the like; else `path` becomes the pointer.
    static void takePointer(const json& target, std::string& path, json& node) {
        static const std::string start = "/nodes/";
        static const json::json_pointer place("/extensions/KHR_animation_pointer/pointer");
        if (!target.contains(place) || !target.at(place).is_string()) return;
        path = target.at(place).get<std::string>();
        const std::size_t slash = path.find('/', start.size());
        if (path.rfind(start, 0) != 0 || slash == std::string::npos) return;
        const std::string number = path.substr(start.size(), slash - start.size());
        if (number.empty() || number.size() > 9 ||
            number.find_first_not_of("0123456789") != std::string::npos)
            return;
        const std::string property = path.substr(slash + 1);
        for (const char* known : {"translation", "rotation", "scale", "weights"})
            if (property == known) {
                path = property;
                node = std::stoul(number);
            }
    }

    void readAnimations() {
        using Path = GltfAnimation::Path;
        using Interpolation = GltfAnimation::Interpolation;
        std::string otherPath; // the first unknown path of a channel
        std::size_t movedTwice = 0;
        _file.forEach("animations", [&](const json& from, const std::string& where) {
            GltfAnimation animation;
            animation.name = nameOf(from);
            animation.isNamed = from.contains("name") && from.at("name").is_string();
            const std::string input = where + ".samplers.input";
            const std::string output = where + ".samplers.output";
            const std::string channels = where + ".channels", sampled = channels + ".sampler";
            std::vector<std::size_t> keys;
            for (const json& sampler : from.at("samplers")) {
                GltfAnimation::Sampler known;
                known.input = _accessors.indexOf(sampler.at("input"), input);
                known.output = _accessors.indexOf(sampler.at("output"), output);
                _accessors.requireType(known.input, {"SCALAR"}, input);
                keys.push_back(_accessors[known.input].count + _accessors[known.output].count);
                const auto interpolation = sampler.find("interpolation");
                if (interpolation != sampler.end()) {
                    const std::string& name = interpolation->get_ref<const std::string&>();
                    if (name == "STEP")
                        known.interpolation = Interpolation::Step;
                    else if (name == "CUBICSPLINE")
                        known.interpolation = Interpolation::CubicSpline;
                    else if (name != "LINEAR")
                        _file.fail(where + ".samplers.interpolation",
                                   "LINEAR, STEP or CUBICSPLINE, found " + inQuotes(name));
                }
                animation.samplers.push_back(known);
            }
            std::set<std::pair<std::size_t, Path>> moved;
            for (const json& channel : from.at("channels")) {
                GltfAnimation::Channel known;
                known.sampler = _file.index(channel.at("sampler"), keys.size(), sampled);
                const json& target = channel.at("target");
                std::string path = target.at("path").get<std::string>();
                json node = target.value("node", json());
                if (path == "pointer") takePointer(target, path, node);
                if (path == "translation")
                    known.path = Path::Translation;
                else if (path == "rotation")
                    known.path = Path::Rotation;
                else if (path == "scale")
                    known.path = Path::Scale;
                else if (path != "weights") {
                    if (otherPath.empty()) otherPath = path.substr(0, 100);
                    continue;
                }
                if (!node.is_null()) {
                    known.node = _file.indexOf(node, "nodes", channels);
                    if (!moved.emplace(*known.node, known.path).second) ++movedTwice;
                }
                // Channels may share a sampler; each has its own copy of the keys.
                _file.take(keys[known.sampler], channels);
                animation.channels.push_back(known);
            }
            _file.addEntries(animation.channels.size());
            _document.animations.push_back(std::move(animation));
        });
        if (movedTwice > 0)
            warn(_file.path, "duplicate channels for one node property; the last is used, " +
                                 std::to_string(movedTwice) + " are ignored");
        if (!otherPath.empty())
            warn(_file.path, "unsupported channel paths ignored, the first " + inQuotes(otherPath) +
                                 "; supported: translation, rotation, scale and weights of nodes");
    }

    GltfDocument& _document;
    GltfFile& _file;
    GltfAccessors& _accessors;
    std::vector<Cost> _costs;     ///< of each mesh
    UniqueNames _targetLabels;    ///< that begin names of morph targets
    std::size_t _unfinished = 0;  ///< primitives with an incomplete last triangle
    std::size_t _placedTwice = 0; ///< nodes with both a matrix and other transforms
    /// Number of vertices that an accessor of indices uses, by accessor and number of vertices.
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> _named;
};

namespace {

/// Refuses lists that are too long before they are read.
GltfFile& withFewEntries(GltfFile& file) {
    file.checkEntries();
    return file;
}

} // namespace

GltfDocument::GltfDocument(GltfFile& from) : file(withFewEntries(from)), accessors(from) {
    DocumentReader(*this).run();
}

} // namespace osgSkin
