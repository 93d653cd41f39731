// SPDX-License-Identifier: MIT
// Springs of VRM files: secondaryAnimation of VRM 0, VRMC_springBone of VRM 1.
#include "gltf/GltfDocument.h"

#include "files/FileText.h"
#include "gltf/GltfMembers.h"

#include <osgSkinMotion/SpringBones>

#include <utility>

namespace osgSkin {
namespace {

using nlohmann::json;

constexpr double kLastLength = 0.07; ///< metres, of last bones in VRM 0
constexpr double kPlaneRadius = 1e5; ///< metres; a metre beside a point it is 5 micrometres off

/// A list of three numbers; `otherwise` if it is none.
glm::dvec3 listOf(const json& object, const char* name, const glm::dvec3& otherwise) {
    const json& list = memberOf(object, name);
    glm::dvec3 result;
    if (!list.is_array() || list.size() != 3) return otherwise;
    for (int i = 0; i < 3; ++i) {
        const json& number = list[static_cast<std::size_t>(i)];
        if (!number.is_number()) return otherwise;
        result[i] = number.get<double>();
    }
    return result;
}

/// VRM 0 has Unity's axes here, whose z is glTF's with the other sign.
glm::dvec3 unityVector(const json& object, const char* name, double otherwiseY) {
    const json& vector = memberOf(object, name);
    return {numberOf(vector, "x", 0.0), numberOf(vector, "y", otherwiseY),
            -numberOf(vector, "z", 0.0)};
}

class SpringReader {
public:
    SpringReader(GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene)
        : _document(document), _indexOf(indexOf), _scene(scene) {
        for (const SourceNode& node : scene.nodes) {
            const glm::dmat4 above =
                node.parent < 0 ? glm::dmat4(1.0) : _places[static_cast<std::size_t>(node.parent)];
            _places.push_back(above * node.matrix);
            _nodes.add(node.name, node.parent, glm::dvec3(_places.back()[3]));
        }
    }

    void run() {
        const json& extensions = memberOf(_document.file.json, "extensions");
        const json& second = memberOf(extensions, "VRMC_springBone");
        if (second.empty())
            readFirst(memberOf(memberOf(extensions, "VRM"), "secondaryAnimation"));
        else
            readSecond(second);
        if (_lost > 0)
            warn(_document.file.path, std::to_string(_lost) +
                                          " joints or colliders of springs name no node, or have "
                                          "no shape; ignored");
    }

private:
    void readFirst(const json& springs) {
        for (const json& group : memberOf(springs, "colliderGroups")) {
            _groups.emplace_back();
            for (const json& collider : memberOf(group, "colliders")) {
                const glm::dvec3 offset = unityVector(collider, "offset", 0.0);
                addCollider(nodeOf(group), offset, offset, numberOf(collider, "radius", 0.0));
                _groups.back().push_back(_scene.springs.colliders.size() - 1);
            }
        }
        for (const json& group : memberOf(springs, "boneGroups")) {
            SpringSettings::Joint joint;
            joint.stiffness = numberOf(group, "stiffiness", 1.0); // VRM spells it so
            joint.drag = numberOf(group, "dragForce", 0.4);
            joint.radius = numberOf(group, "hitRadius", 0.02);
            joint.gravity =
                numberOf(group, "gravityPower", 0.0) * unityVector(group, "gravityDir", -1.0);
            std::vector<std::string> names;
            for (const json& bone : memberOf(group, "bones"))
                if (const int node = nodeAt(osgSkin::indexOf(bone)); node >= 0)
                    names.push_back(_scene.nodes[static_cast<std::size_t>(node)].name);
            _document.file.addEntries(_nodes.joints.size());
            _document.file.checkEntries();
            addChain(springsBelow(_nodes, names, joint, kLastLength), group);
        }
    }

    void readSecond(const json& springs) {
        std::vector<std::size_t> known; // indices of the file's colliders
        for (const json& collider : memberOf(springs, "colliders")) {
            // For programs that do not know the extension, the collider's own shape is far away.
            const json& extended = memberOf(
                memberOf(memberOf(collider, "extensions"), "VRMC_springBone_extended_collider"),
                "shape");
            const json& shape = extended.empty() ? memberOf(collider, "shape") : extended;
            const json &capsule = memberOf(shape, "capsule"), &plane = memberOf(shape, "plane");
            const json& round = capsule.empty() ? memberOf(shape, "sphere") : capsule;
            if (round.empty() && plane.empty()) ++_lost;
            const glm::dvec3 start =
                listOf(plane.empty() ? round : plane, "offset", glm::dvec3(0.0));
            const bool isInside = numberOf(round, "radius", 0.0) > 0.0 && isTrue(round, "inside");
            if (!plane.empty())
                addPlane(nodeOf(collider), start,
                         listOf(plane, "normal", glm::dvec3(0.0, 0.0, 1.0)));
            else
                addCollider(round.empty() ? -1 : nodeOf(collider), start,
                            listOf(capsule, "tail", start),
                            (isInside ? -1.0 : 1.0) * numberOf(round, "radius", 0.0));
        }
        for (const json& group : memberOf(springs, "colliderGroups")) {
            _groups.emplace_back();
            for (const json& index : memberOf(group, "colliders"))
                _groups.back().push_back(osgSkin::indexOf(index));
        }
        for (const json& spring : memberOf(springs, "springs")) {
            SpringSettings::Chain chain;
            const json& joints = memberOf(spring, "joints");
            for (std::size_t i = 0; joints.is_array() && i + 1 < joints.size(); ++i) {
                const int head = nodeOf(joints[i]), tail = nodeOf(joints[i + 1]);
                if (head < 0 || tail < 0) continue;
                SpringSettings::Joint joint;
                joint.name = _scene.nodes[static_cast<std::size_t>(head)].name;
                joint.tip = _nodes.joints[static_cast<std::size_t>(tail)].centre;
                joint.stiffness = numberOf(joints[i], "stiffness", 1.0);
                joint.drag = numberOf(joints[i], "dragForce", 0.5);
                joint.radius = numberOf(joints[i], "hitRadius", 0.0);
                joint.gravity = numberOf(joints[i], "gravityPower", 0.0) *
                                listOf(joints[i], "gravityDir", glm::dvec3(0.0, -1.0, 0.0));
                chain.joints.push_back(joint);
            }
            addChain(std::move(chain), spring);
        }
    }

    static bool isTrue(const json& object, const char* name) {
        const auto found = object.find(name);
        return found != object.end() && *found == true;
    }

    /// A plane as a sphere of 100 km.
    void addPlane(int node, const glm::dvec3& point, const glm::dvec3& normal) {
        const double length = glm::length(normal);
        if (node < 0 || !(length > 0.0)) return addCollider(-1, point, point, 0.0);
        const glm::dmat4& place = _places[static_cast<std::size_t>(node)];
        const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(place))));
        const double radius = scale > 0.0 ? kPlaneRadius / scale : 0.0;
        const glm::dvec3 centre = point - normal * (radius / length);
        addCollider(node, centre, centre, radius);
    }

    /// \param node -1: it touches nothing
    void addCollider(int node, const glm::dvec3& start, const glm::dvec3& end, double radius) {
        SpringSettings::Collider collider;
        if (node >= 0) {
            const glm::dmat4& place = _places[static_cast<std::size_t>(node)];
            collider.joint = _scene.nodes[static_cast<std::size_t>(node)].name;
            collider.start = place * glm::dvec4(start, 1.0);
            collider.end = place * glm::dvec4(end, 1.0);
            collider.radius = radius * std::cbrt(std::abs(glm::determinant(glm::dmat3(place))));
        }
        _scene.springs.colliders.push_back(collider);
    }

    void addChain(SpringSettings::Chain chain, const json& from) {
        if (from.contains("center"))
            if (const int centre = nodeAt(osgSkin::indexOf(from, "center")); centre >= 0)
                chain.centre = _scene.nodes[static_cast<std::size_t>(centre)].name;
        for (const json& value : memberOf(from, "colliderGroups")) {
            const std::size_t group = osgSkin::indexOf(value);
            if (group >= _groups.size()) continue;
            // A frame looks at all pairs.
            _document.file.addEntries(chain.joints.size() * _groups[group].size());
            _document.file.checkEntries();
            chain.colliders.insert(chain.colliders.end(), _groups[group].begin(),
                                   _groups[group].end());
        }
        _scene.springs.chains.push_back(std::move(chain));
    }

    /// The index of a node in the scene; -1 where it has none.
    int nodeAt(std::size_t index) const { return index < _indexOf.size() ? _indexOf[index] : -1; }

    int nodeOf(const json& object) {
        const int node = nodeAt(osgSkin::indexOf(object, "node"));
        _lost += node < 0;
        return node;
    }

    GltfDocument& _document;
    const std::vector<int>& _indexOf;
    SourceScene& _scene;
    std::vector<glm::dmat4> _places; ///< from nodes to the scene
    RestSkeleton _nodes;             ///< all nodes as joints
    std::vector<std::vector<std::size_t>> _groups;
    std::size_t _lost = 0;
};

} // namespace

void readSprings(GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene) {
    SpringReader(document, indexOf, scene).run();
}

} // namespace osgSkin
