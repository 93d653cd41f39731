// SPDX-License-Identifier: MIT
#include "gltf/ReadGltf.h"

#include "files/FileText.h"
#include "files/UniqueName.h"
#include "gltf/GltfDocument.h"

#include <osgSkinRig/JointRoles>

#include <osg/Math>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

// --- extensions ---

/// Required extensions that are supported or affect appearance only.
constexpr const char* kHarmless[] = {"KHR_draco_mesh_compression",
                                     "EXT_meshopt_compression",
                                     "KHR_meshopt_compression",
                                     "MESHOPT_compression",
                                     "KHR_mesh_quantization",
                                     "KHR_materials_",
                                     "KHR_texture_",
                                     "KHR_lights_",
                                     "EXT_texture_",
                                     "EXT_lights_",
                                     "MSFT_",
                                     "KHR_xmp",
                                     "KHR_animation_pointer",
                                     "VRM",
                                     "KHR_techniques",
                                     "AGI_"};

/// Extensions that affect positions or motion even if the file does not require them.
constexpr const char* kMissed[] = {"EXT_mesh_gpu_instancing", "KHR_node_visibility"};

bool isHarmless(const std::string& extension) {
    return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                       [&](const char* start) { return extension.rfind(start, 0) == 0; });
}

/// Reports unknown extensions that may affect shapes or motions.
void noteExtensions(const GltfFile& file) {
    const json none = json::array();
    const json required = file.json.value("extensionsRequired", none);
    std::set<std::string> unknown;
    for (const json& entry : required)
        if (!isHarmless(entry.get_ref<const std::string&>()))
            unknown.insert(entry.get<std::string>());
    if (unknown.size() == 1)
        warn(file.path, "requires the extension " + inQuotes(*unknown.begin()) +
                            ", which is not known; read without it");
    if (unknown.size() > 1)
        warn(file.path, "requires " + std::to_string(unknown.size()) + " extensions, " +
                            inQuotes(*unknown.begin()) +
                            " among them, which are not known; read without them");
    const json used = file.json.value("extensionsUsed", none);
    for (const char* missed : kMissed)
        if (std::find(used.begin(), used.end(), missed) != used.end() &&
            std::find(required.begin(), required.end(), missed) == required.end())
            warn(file.path, std::string("uses the extension \"") + missed +
                                "\", which is not known; read without it");
}

/// Whether the figure faces -Z, as in VRM 0, and not +Z, as in glTF.
bool facesBackwards(const GltfFile& file) {
    const auto extensions = file.json.find("extensions");
    return extensions != file.json.end() && extensions->contains("VRM");
}

// --- names ---

/// The priority of each node's name: joints, then animated nodes, then nodes without a mesh.
std::vector<int> ranksOf(const GltfDocument& document) {
    std::vector<int> ranks(document.nodes.size(), 2);
    for (std::size_t n = 0; n < ranks.size(); ++n)
        if (document.nodes[n].mesh) ranks[n] = 3;
    for (const GltfAnimation& animation : document.animations)
        for (const GltfAnimation::Channel& channel : animation.channels)
            if (channel.node) ranks[*channel.node] = std::min(ranks[*channel.node], 1);
    for (const GltfSkin& skin : document.skins)
        for (const std::size_t joint : skin.joints) ranks[joint] = 0;
    return ranks;
}

/// Names the nodes of a VRM animation after the human bones that it says they are.
void nameHumanBones(GltfDocument& document) {
    static const json::json_pointer bones("/extensions/VRMC_vrm_animation/humanoid/humanBones");
    if (!document.file.json.contains(bones)) return;
    for (const auto& [name, bone] : document.file.json.at(bones).items()) {
        const auto node = bone.at("node").get<std::size_t>();
        if (node < document.nodes.size()) document.nodes[node].name = name;
    }
}

/// Makes node names unique: glTF refers to nodes by index, so several may share a name. Joints keep
/// their names before other nodes; duplicates get a counter, such as "Torso.001".
/// \return a name that no node has, for a common root of several roots
std::string nameNodes(GltfDocument& document) {
    std::vector<GltfNode>& nodes = document.nodes;
    const std::vector<int> ranks = ranksOf(document);
    std::vector<std::size_t> order(nodes.size()), twins;
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
    UniqueNames taken;
    for (const std::size_t n : order) {
        if (nodes[n].name.empty()) nodes[n].name = "nodes[" + std::to_string(n) + "]";
        if (!taken.take(nodes[n].name)) twins.push_back(n);
    }
    std::size_t renamed = 0;
    std::string first;
    for (const std::size_t n : twins) {
        nodes[n].name = taken.unique(nodes[n].name);
        if (ranks[n] == 0 && renamed++ == 0) first = nodes[n].name;
    }
    if (renamed > 0)
        warn(document.file.path, "joints share names; " + std::to_string(renamed) +
                                     " were renamed, the first to \"" + first + '"');
    return taken.unique("scene");
}

// --- the scene ---

/// The scene's nodes with a mesh, children before parents.
std::vector<std::size_t> shownMeshes(const GltfDocument& document) {
    std::vector<std::size_t> result;
    std::vector<std::pair<std::size_t, std::size_t>> open; // nodes, and their next child
    for (const std::size_t root : document.roots) {
        open.emplace_back(root, 0);
        while (!open.empty()) {
            const auto [n, child] = open.back();
            const GltfNode& node = document.nodes[n];
            if (child < node.children.size()) {
                ++open.back().second;
                open.emplace_back(node.children[child], 0);
                continue;
            }
            if (node.mesh) result.push_back(n);
            open.pop_back();
        }
    }
    return result;
}

/// The scene's roots, and those above joints of its skins: a file may leave the joints out of the
/// scene that shows their mesh.
std::vector<std::size_t> rootsWithJoints(const GltfDocument& document,
                                         const std::vector<std::size_t>& shown) {
    std::vector<std::size_t> result = document.roots;
    std::set<std::size_t> skins, known(result.begin(), result.end());
    for (const std::size_t n : shown)
        if (const GltfIndex skin = document.nodes[n].skin) skins.insert(*skin);
    for (const std::size_t skin : skins)
        for (std::size_t n : document.skins[skin].joints) {
            while (document.nodes[n].parent) n = *document.nodes[n].parent;
            if (known.insert(n).second) result.push_back(n);
        }
    return result;
}

/// Adds nodes, parents before children; returns each node's index, or -1 if it is not below a root.
std::vector<int> addNodes(const GltfDocument& document, const std::vector<std::size_t>& roots,
                          const std::string& rootName, SourceScene& scene) {
    std::vector<int> indexOf(document.nodes.size(), -1);
    std::vector<std::size_t> open(roots.rbegin(), roots.rend());
    int above = -1;
    scene.isRootMade = open.size() != 1;
    if (scene.isRootMade) above = scene.addNode(rootName, -1, glm::dmat4(1.0));
    while (!open.empty()) {
        const std::size_t n = open.back();
        const GltfNode& node = document.nodes[n];
        open.pop_back();
        indexOf[n] =
            scene.addNode(node.name, node.parent ? indexOf[*node.parent] : above, node.matrix);
        open.insert(open.end(), node.children.rbegin(), node.children.rend());
    }
    return indexOf;
}

// --- figures without a skin, made of rigid parts ---

/// The nodes that a VRM file or animation says are its human's bones, by VRM's names of these.
std::map<std::string, std::size_t> humanBones(const GltfDocument& document) {
    std::map<std::string, std::size_t> result;
    for (const std::string extension : {"VRM", "VRMC_vrm", "VRMC_vrm_animation"}) {
        const json::json_pointer bones("/extensions/" + extension + "/humanoid/humanBones");
        if (!document.file.json.contains(bones)) continue;
        for (const auto& [key, bone] : document.file.json.at(bones).items()) {
            const auto node = bone.find("node");
            if (node == bone.end() || !node->is_number_unsigned()) continue;
            const json name = bone.value("bone", json()); // VRM 0 has a list
            if (const auto n = node->get<std::size_t>(); n < document.nodes.size())
                result.emplace(name.is_string() ? name.get<std::string>() : key, n);
        }
    }
    return result;
}

/// Tells nodes the roles that a VRM file says they have.
void setRoles(const GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene) {
    std::vector<std::string> names;
    std::vector<int> nodes;
    for (const auto& [name, node] : humanBones(document)) {
        if (indexOf[node] < 0) continue;
        names.push_back(name);
        nodes.push_back(indexOf[node]);
    }
    const std::vector<std::string> roles = recogniseNames(names);
    static const std::map<std::string, std::string> kFace{
        {"leftEye", "LeftEye"}, {"rightEye", "RightEye"}, {"jaw", "Jaw"}};
    for (std::size_t b = 0; b < nodes.size(); ++b) {
        const auto face = kFace.find(names[b]);
        scene.nodes[static_cast<std::size_t>(nodes[b])].role =
            face == kFace.end() ? roles[b] : face->second;
    }
}

/// The names of the nodes that are joints of a skin, or bones of a VRM's human, or that a clip
/// moves.
std::set<std::string> namedJoints(const GltfDocument& document, const SourceScene& scene) {
    std::set<std::string> result;
    for (const auto& animation : scene.animations)
        for (const SourceTrack& track : animation->tracks)
            if (!track.positions.empty() || !track.rotations.empty() || !track.scales.empty())
                result.insert(track.node);
    for (const GltfSkin& skin : document.skins)
        for (const std::size_t joint : skin.joints) result.insert(document.nodes[joint].name);
    for (const auto& [name, node] : humanBones(document)) result.insert(document.nodes[node].name);
    for (const Constraint& constraint : scene.constraints) result.insert(constraint.joint.name);
    return result;
}

/// The nearest node, at or above another, that is a joint; the root where none is.
const SourceNode& carrierOf(const SourceNode& node, const SourceScene& scene,
                            const std::set<std::string>& joints) {
    const SourceNode* result = &node;
    while (result->parent >= 0 && joints.count(result->name) == 0)
        result = &scene.nodes[static_cast<std::size_t>(result->parent)];
    return *result;
}

/// From a node's own frame to that of a node above it.
glm::dmat4 pathTo(const SourceNode& above, const SourceNode& node, const SourceScene& scene) {
    glm::dmat4 result(1.0);
    for (const SourceNode* at = &node; at != &above;
         at = &scene.nodes[static_cast<std::size_t>(at->parent)])
        result = at->matrix * result;
    return result;
}

/// Where no mesh has bones, gives each to the joint that carries it, or else to the root. Figures
/// of boxes and robots have no skin. Does nothing if no joint carries a mesh.
void bindRigidParts(const std::set<std::string>& joints, SourceScene& scene) {
    if (std::any_of(scene.meshes.begin(), scene.meshes.end(),
                    [](const auto& mesh) { return !mesh->bones.empty(); }))
        return;
    const auto isCarried = [&](const SourceNode& node) {
        return !node.meshes.empty() && joints.count(carrierOf(node, scene, joints).name) != 0;
    };
    if (std::none_of(scene.nodes.begin(), scene.nodes.end(), isCarried)) return;
    for (SourceNode& node : scene.nodes)
        for (std::size_t& mesh : node.meshes) {
            const SourceNode& joint = carrierOf(node, scene, joints);
            scene.meshes.push_back(
                boundTo(joint.name, pathTo(joint, node, scene), *scene.meshes[mesh]));
            mesh = scene.meshes.size() - 1;
        }
}

} // namespace

SourceScene readGltf(const std::string& path, const ReadLimits& limits) {
    GltfFile file = GltfFile::read(path, limits);
    try {
        noteExtensions(file);
        unpackMeshopt(file);
        countDraco(file);
        GltfDocument document(file);
        nameHumanBones(document);
        const std::string rootName = nameNodes(document);
        SourceScene scene;
        const std::vector<std::size_t> shown = shownMeshes(document);
        const std::vector<int> indexOf =
            addNodes(document, rootsWithJoints(document, shown), rootName, scene);
        setRoles(document, indexOf, scene);
        readSprings(document, indexOf, scene);
        readConstraints(document, indexOf, scene);
        addMeshes(document, shown, indexOf, scene);
        addAnimations(document, indexOf, scene);
        separateMorphs(scene, path);
        bindRigidParts(namedJoints(document, scene), scene);
        scene.toWorld = osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
        if (facesBackwards(file))
            scene.toWorld = osg::Matrixd::rotate(osg::PI, osg::Vec3d(0, 1, 0)) * scene.toWorld;
        scene.metresPerUnit = 1.0;
        scene.bytes = file.diskBytes;
        return scene;
    } catch (const json::exception& error) {
        failFile(path, "malformed glTF: " + reasonOf(error));
    }
}

} // namespace osgSkin
