// SPDX-License-Identifier: MIT
#include "gltf/plain/GltfCheck.h"

#include "gltf/plain/GltfLooks.h"
#include "gltf/plain/GltfMoves.h"
#include "gltf/plain/GltfParts.h"
#include "gltf/plain/NamedVertices.h"
#include "text/Base64.h"
#include "text/FileText.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

/// A kind of attribute, and what its accessor may be.
struct AttributeKind {
    const char* name; ///< or the start of it, before a number
    int sets;         ///< 0: no number follows
    const char* types[2];
};
constexpr AttributeKind kAttributes[] = {
    {"POSITION", 0, {"VEC3", "VEC3"}},  {"NORMAL", 0, {"VEC3", "VEC3"}},
    {"TEXCOORD_", 8, {"VEC2", "VEC2"}}, {"COLOR_", 1, {"VEC3", "VEC4"}},
    {"JOINTS_", 4, {"VEC4", "VEC4"}},   {"WEIGHTS_", 4, {"VEC4", "VEC4"}},
};

// What takes 64 bytes is an element.
constexpr std::size_t kRead = 1;        ///< elements of a vertex that Assimp reads
constexpr std::size_t kDrawn = 12;      ///< of one that is bound and deformed
constexpr std::size_t kReadCorners = 4; ///< that are one
constexpr std::size_t kDrawnCorners = 2;

const AttributeKind* kindOfAttribute(const std::string& name) {
    for (const AttributeKind& kind : kAttributes) {
        if (kind.sets == 0 && name == kind.name) return &kind;
        for (int set = 0; set < kind.sets; ++set)
            if (name == kind.name + std::to_string(set)) return &kind;
    }
    return nullptr;
}

class GltfChecker {
public:
    explicit GltfChecker(const GltfFile& file) : _path(file.path), _parts(file) {}

    json run() {
        json result = {{"asset", {{"version", "2.0"}}}};
        _parts.checkEntries(); // before lists are gone through
        _parts.checkBuffers(result);
        _parts.checkAccessors(result);
        GltfLooks(_parts).check(result);
        addMeshes(result);
        // Assimp reads compressed meshes where the file says so, or says that it reads none.
        for (const char* said : {"extensionsUsed", "extensionsRequired"})
            if (_isCompressed) result[said] = json::array({"KHR_draco_mesh_compression"});
        addSkins(result);
        addNodes(result);
        addScenes(result);
        GltfMoves(_parts, _path).check(result);
        _parts.checkEntries();
        if (_unfinished > 0)
            tellOf(_path, "corners that make no whole triangle are left out, of " +
                              std::to_string(_unfinished) + " of the meshes' primitives");
        if (_placedTwice > 0)
            tellOf(_path, "translations, rotations and scales beside a matrix are left out, of " +
                              std::to_string(_placedTwice) + " of the nodes");
        for (auto part = result.begin(); part != result.end();)
            part = part->empty() ? result.erase(part) : std::next(part);
        return result;
    }

private:
    void addPrimitive(const json& from, const std::string& where, json& list) {
        json primitive = {{"attributes", json::object()}};
        const json& attributes = from.at("attributes");
        if (!attributes.is_object()) _parts.fail(where + ".attributes", "an object");
        if (!attributes.contains("POSITION")) return; // nothing to be drawn
        const std::size_t vertices =
            _parts.count(_parts.accessor(attributes.at("POSITION"), where + ".POSITION"));
        for (const char* fifth : {"JOINTS_4", "WEIGHTS_4"})
            if (attributes.contains(fifth))
                _parts.fail(where + "." + fifth, "four sets of joints and weights at most");
        for (const auto& [name, value] : attributes.items()) {
            const AttributeKind* kind = kindOfAttribute(name);
            if (kind == nullptr) continue;
            const std::string place = where + "." + name;
            const std::size_t accessor = _parts.accessor(value, place);
            _parts.requireType(accessor, {kind->types[0], kind->types[1]}, place);
            if (name.rfind("JOINTS_", 0) == 0) _parts.requireIndices(accessor, false, place);
            if (_parts.count(accessor) != vertices)
                _parts.fail(place, std::to_string(vertices) + " elements, as many as of POSITION");
            primitive["attributes"][name] = accessor;
        }
        for (const char* set : {"0", "1", "2", "3"}) // one without the other means nothing
            if (primitive["attributes"].contains(std::string("JOINTS_") + set) !=
                primitive["attributes"].contains(std::string("WEIGHTS_") + set)) {
                primitive["attributes"].erase(std::string("JOINTS_") + set);
                primitive["attributes"].erase(std::string("WEIGHTS_") + set);
            }
        std::size_t corners = 0;
        if (from.contains("indices")) {
            const std::size_t accessor = _parts.accessor(from.at("indices"), where + ".indices");
            _parts.requireType(accessor, {"SCALAR"}, where + ".indices");
            _parts.requireIndices(accessor, true, where + ".indices");
            corners = _parts.count(accessor);
            primitive["indices"] = accessor;
        }
        const json mode = from.value("mode", json(4u));
        primitive["mode"] = _parts.index(mode, 7, where + ".mode");
        if (from.contains("material"))
            primitive["material"] = _parts.indexOf(from.at("material"), "materials", where);
        _parts.addDraco(from, where, primitive);
        if (primitive.contains("extensions"))
            _isCompressed = true;
        else
            checkStored(primitive, where);
        if (!primitive.contains("extensions"))
            checkMode(primitive.contains("indices") ? corners : vertices, primitive);
        addTargets(from, vertices, where, primitive);
        const bool areNamed = primitive.contains("indices");
        const bool isDrawn = primitive["mode"] != 0; // no points
        const std::size_t all = areNamed ? corners : vertices;
        const std::size_t read = kRead * vertices + all / kReadCorners;
        _parts.take(read, where);
        _elements.back() += read;
        const std::size_t named =
            areNamed ? _named.count(primitive["indices"].get<std::size_t>(), vertices) : vertices;
        if (isDrawn) _drawn.back() += kDrawn * named + all / kDrawnCorners;
        list.push_back(primitive);
    }

    /// Points, lines and what has too few corners for a triangle becomes points, which are not
    /// drawn: Assimp reads beyond lists of corners that are empty, and asks for as many faces as
    /// there are corners, less two.
    void checkMode(std::size_t corners, json& primitive) {
        constexpr std::size_t kTriangles = 4;
        const auto mode = primitive.at("mode").get<std::size_t>();
        const bool isSurface = mode >= kTriangles;
        if (isSurface && (corners < 3 || (mode == kTriangles && corners % 3 != 0))) ++_unfinished;
        if (isSurface && corners >= 3) return;
        primitive["mode"] = 0;
        primitive.erase("indices");
    }

    /// What names vertices and joints is there, where Draco does not hold it, and the rest is not
    /// zeros without end.
    void checkStored(const json& primitive, const std::string& where) {
        if (primitive.contains("indices")) {
            _parts.requireValues(primitive.at("indices").get<std::size_t>(), where + ".indices");
            _parts.takeZeros(primitive.at("indices").get<std::size_t>(), where + ".indices");
        }
        for (const auto& [name, accessor] : primitive.at("attributes").items()) {
            if (name.rfind("JOINTS_", 0) == 0)
                _parts.requireValues(accessor.get<std::size_t>(), where + "." + name);
            _parts.takeZeros(accessor.get<std::size_t>(), where + "." + name);
        }
    }

    void addTargets(const json& from, std::size_t vertices, const std::string& where,
                    json& primitive) {
        const json targets = from.value("targets", json::array());
        if (!targets.is_array()) _parts.fail(where + ".targets", "a list");
        for (const json& target : targets) {
            json kept = json::object();
            for (const char* name : {"POSITION", "NORMAL"}) {
                if (!target.contains(name)) continue;
                const std::string place = where + ".targets." + name;
                const std::size_t accessor = _parts.accessor(target.at(name), place);
                _parts.requireType(accessor, {"VEC3"}, place);
                if (_parts.count(accessor) != vertices)
                    _parts.fail(place, std::to_string(vertices) + " elements, one a vertex");
                kept[name] = accessor;
            }
            _parts.addEntries(1);
            primitive["targets"].push_back(kept);
        }
    }

    void countTargets(const json& mesh) {
        std::size_t most = 0, all = 0;
        for (const json& primitive : mesh.at("primitives")) {
            const auto found = primitive.find("targets");
            if (found == primitive.end()) continue;
            most = std::max(most, found->size());
            all += found->size();
        }
        _targets.push_back(most);
        _allTargets.push_back(all);
    }

    /// Drops weights that no target of a mesh or node goes by.
    static void cutWeights(std::size_t targets, json& part) {
        const auto found = part.find("weights");
        if (found == part.end() || found->size() <= targets) return;
        if (targets == 0)
            part.erase(found);
        else
            found->get_ref<json::array_t&>().resize(targets);
    }

    void addMeshes(json& result) {
        _parts.forEach("meshes", [&](const json& from, const std::string& where) {
            json mesh = {{"primitives", json::array()}};
            _parts.copyName(from, mesh);
            _elements.push_back(0);
            _drawn.push_back(0);
            _parts.copyWeights(from, where, mesh);
            const json& primitives = from.at("primitives");
            if (!primitives.is_array()) _parts.fail(where + ".primitives", "a list");
            std::size_t number = 0;
            for (const json& primitive : primitives)
                addPrimitive(primitive, where + ".primitives[" + std::to_string(number++) + "]",
                             mesh["primitives"]);
            if (mesh["primitives"].empty())
                _parts.fail(where + ".primitives", "at least one with positions");
            countTargets(mesh);
            cutWeights(_targets.back(), mesh);
            _primitives.push_back(mesh["primitives"].size());
            _parts.addEntries(mesh["primitives"].size());
            result["meshes"].push_back(mesh);
        });
    }

    void addSkins(json& result) {
        _parts.forEach("skins", [&](const json& from, const std::string& where) {
            json skin = {{"joints", json::array()}};
            _parts.copyName(from, skin);
            const json& joints = from.at("joints");
            if (!joints.is_array() || joints.empty()) _parts.fail(where + ".joints", "a list");
            std::unordered_set<std::size_t> named;
            for (const json& joint : joints) {
                const std::size_t node = _parts.indexOf(joint, "nodes", where + ".joints");
                if (!named.insert(node).second)
                    _parts.fail(where + ".joints",
                                "each node once, found " + std::to_string(node) + " again");
                skin["joints"].push_back(node);
            }
            if (from.contains("inverseBindMatrices")) {
                const std::string place = where + ".inverseBindMatrices";
                const std::size_t accessor = _parts.accessor(from.at("inverseBindMatrices"), place);
                _parts.requireType(accessor, {"MAT4"}, place);
                skin["inverseBindMatrices"] = accessor;
                _parts.take(4 * _parts.count(accessor), place); // 16 numbers each
            }
            _joints.push_back(joints.size());
            _parts.addEntries(joints.size());
            result["skins"].push_back(skin);
        });
    }

    void addNodes(json& result) {
        const std::size_t nodes = _parts.size("nodes");
        _above.assign(nodes, -1);
        _parts.forEach("nodes", [&](const json& from, const std::string& where) {
            json node = json::object();
            _parts.copyName(from, node);
            _parts.copyNumbers(from, "matrix", 16, where, node);
            _parts.copyNumbers(from, "translation", 3, where, node);
            _parts.copyNumbers(from, "rotation", 4, where, node);
            _parts.copyNumbers(from, "scale", 3, where, node);
            makeUnit(node);
            clampTinyScale(node);
            if (node.contains("matrix")) _placedTwice += keepMatrix(node);
            _parts.copyWeights(from, where, node);
            if (from.contains("mesh"))
                node["mesh"] = _parts.indexOf(from.at("mesh"), "meshes", where + ".mesh");
            cutWeights(node.contains("mesh") ? _targets[node["mesh"].get<std::size_t>()] : 0, node);
            // Every node that shows a mesh makes a copy of it.
            if (node.contains("mesh")) {
                const auto mesh = node["mesh"].get<std::size_t>();
                if (!_shown.insert(mesh).second) {
                    _parts.addEntries(_allTargets[mesh]);
                    _parts.take(_elements[mesh], where + ".mesh");
                }
                _parts.take(_drawn[mesh], where + ".mesh");
                _parts.addEntries(_primitives[mesh]);
            }
            if (from.contains("skin"))
                node["skin"] = _parts.indexOf(from.at("skin"), "skins", where + ".skin");
            // Assimp makes bones for each mesh, of each skin that it is shown with.
            if (node.contains("mesh") && node.contains("skin"))
                _parts.addEntries(_primitives[node["mesh"].get<std::size_t>()] *
                                  _joints[node["skin"].get<std::size_t>()]);
            if (from.contains("children")) {
                const json& children = from.at("children");
                if (!children.is_array()) _parts.fail(where + ".children", "a list");
                for (const json& child : children) {
                    const std::size_t below = _parts.indexOf(child, "nodes", where + ".children");
                    if (_above[below] >= 0)
                        _parts.fail(where + ".children",
                                    "nodes without another parent, or recursive reference");
                    _above[below] = static_cast<std::ptrdiff_t>(result["nodes"].size());
                    node["children"].push_back(below);
                }
            }
            result["nodes"].push_back(node);
        });
        checkDepths(nodes);
    }

    /// Rotations that are rounded or no unit quaternions otherwise would scale unevenly.
    static void makeUnit(json& node) {
        if (!node.contains("rotation")) return;
        double squares = 0.0;
        for (const json& number : node["rotation"])
            squares += number.get<double>() * number.get<double>();
        if (!(squares > 0.0) || std::abs(squares - 1.0) < 1e-6) return;
        for (json& number : node["rotation"]) number = number.get<double>() / std::sqrt(squares);
    }

    /// What is hidden by a scale of 0 is almost a point: a joint's matrix has an inverse then.
    static void clampTinyScale(json& node) {
        constexpr double kLeast = 1e-5;
        if (!node.contains("scale")) return;
        for (json& number : node["scale"]) {
            const auto scale = number.get<double>();
            if (std::abs(scale) < kLeast) number = std::copysign(kLeast, scale);
        }
    }

    /// A node is placed by its matrix alone. Whether it had more.
    static bool keepMatrix(json& node) {
        std::size_t dropped = 0;
        for (const char* name : {"translation", "rotation", "scale"}) dropped += node.erase(name);
        return dropped > 0;
    }

    /// Every node has one parent at most, so that going up ends, but in a ring.
    void checkDepths(std::size_t nodes) const {
        std::vector<std::size_t> depths(nodes, 0); // 0: not known yet
        std::vector<std::size_t> way;
        for (std::size_t n = 0; n < nodes; ++n) {
            way.clear();
            std::ptrdiff_t at = static_cast<std::ptrdiff_t>(n);
            while (at >= 0 && depths[std::size_t(at)] == 0 && way.size() <= nodes) {
                way.push_back(std::size_t(at));
                at = _above[std::size_t(at)];
            }
            const std::string where = "nodes[" + std::to_string(n) + "]";
            if (way.size() > nodes) _parts.fail(where, "a tree, found a recursive reference");
            std::size_t depth = at < 0 ? 0 : depths[std::size_t(at)];
            while (!way.empty()) {
                depths[way.back()] = ++depth;
                way.pop_back();
            }
            if (depth > _parts.limits().depth)
                _parts.fail(where, "a node nested at most " +
                                       std::to_string(_parts.limits().depth) +
                                       " deep (option maxDepth)");
        }
    }

    void addScenes(json& result) {
        std::vector<bool> shown(_above.size(), false);
        _parts.forEach("scenes", [&](const json& from, const std::string& where) {
            json scene = {{"nodes", json::array()}};
            _parts.copyName(from, scene);
            std::fill(shown.begin(), shown.end(), false);
            for (const json& root : from.value("nodes", json::array())) {
                const std::size_t node = _parts.indexOf(root, "nodes", where + ".nodes");
                if (_above[node] >= 0 || shown[node])
                    _parts.fail(where + ".nodes", "each a node without a parent, and once");
                shown[node] = true;
                scene["nodes"].push_back(node);
            }
            _parts.addEntries(scene["nodes"].size());
            result["scenes"].push_back(scene);
        });
        if (_parts.has("scene"))
            result["scene"] = _parts.indexOf(_parts.at("scene"), "scenes", "scene");
        else if (_parts.size("scenes") == 0)
            addWhole(result);
    }

    /// A scene of all nodes, where a file has none, as a library of things or of clips.
    void addWhole(json& result) const {
        json roots = json::array();
        for (std::size_t n = 0; n < _above.size(); ++n)
            if (_above[n] < 0) roots.push_back(n);
        result["scenes"] = {{{"nodes", roots}}};
        result["scene"] = 0;
    }

    const std::string& _path;
    GltfParts _parts;
    NamedVertices _named{_parts};
    std::size_t _unfinished = 0;  ///< primitives whose last triangle lacks corners
    std::size_t _placedTwice = 0; ///< nodes of a matrix and more
    std::vector<std::size_t> _primitives, _elements; ///< of each mesh
    std::vector<std::size_t> _drawn;      ///< of each mesh: elements where a node shows it
    std::vector<std::size_t> _targets;    ///< of each mesh: the most of a primitive
    std::vector<std::size_t> _allTargets; ///< of each mesh: those of all primitives
    std::set<std::size_t> _shown;         ///< meshes, by the nodes so far
    bool _isCompressed = false;           ///< some mesh, by Draco
    std::vector<std::size_t> _joints;     ///< of each skin
    std::vector<std::ptrdiff_t> _above;   ///< each node's parent
};

} // namespace

json checkedGltf(const GltfFile& file) {
    return GltfChecker(file).run();
}

} // namespace osgSkin
