// SPDX-License-Identifier: MIT
#include "gltf/ReadGltf.h"

#include "gltf/GltfDocument.h"
#include "text/FileText.h"
#include "text/UniqueName.h"

#include <osg/Math>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
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
                                     "VRM",
                                     "KHR_techniques",
                                     "AGI_"};

/// Extensions that affect positions or motion even if the file does not require them.
constexpr const char* kMissed[] = {"KHR_animation_pointer", "EXT_mesh_gpu_instancing",
                                   "KHR_node_visibility"};

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
        tellOf(file.path, "requires the extension " + inQuotes(*unknown.begin()) +
                              ", which is not known; read without it");
    if (unknown.size() > 1)
        tellOf(file.path, "requires " + std::to_string(unknown.size()) + " extensions, " +
                              inQuotes(*unknown.begin()) +
                              " among them, which are not known; read without them");
    const json used = file.json.value("extensionsUsed", none);
    for (const char* missed : kMissed)
        if (std::find(used.begin(), used.end(), missed) != used.end() &&
            std::find(required.begin(), required.end(), missed) == required.end())
            tellOf(file.path, std::string("uses the extension \"") + missed +
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
        tellOf(document.file.path, "joints are called alike; " + std::to_string(renamed) +
                                       " got a name of their own, as \"" + first + '"');
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
    if (open.size() != 1) above = scene.addNode(rootName, -1, glm::dmat4(1.0));
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

/// The names of the nodes that are joints of a skin, or bones of a VRM's human.
std::set<std::string> namedJoints(const GltfDocument& document) {
    std::set<std::string> result;
    for (const GltfSkin& skin : document.skins)
        for (const std::size_t joint : skin.joints) result.insert(document.nodes[joint].name);
    for (const std::string extension : {"VRM", "VRMC_vrm"}) {
        const json::json_pointer bones("/extensions/" + extension + "/humanoid/humanBones");
        if (!document.file.json.contains(bones)) continue;
        for (const json& bone : document.file.json.at(bones)) {
            const auto node = bone.find("node");
            if (node == bone.end() || !node->is_number_unsigned()) continue;
            if (const auto n = node->get<std::size_t>(); n < document.nodes.size())
                result.insert(document.nodes[n].name);
        }
    }
    return result;
}

} // namespace

bool isGltfName(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return extension == "gltf" || extension == "glb" || extension == "vrm" || extension == "vrma";
}

SourceScene readGltf(const std::string& path, const ReadLimits& limits) {
    GltfFile file = GltfFile::read(path, limits);
    try {
        noteExtensions(file);
        unpackMeshopt(file);
        GltfDocument document(file);
        nameHumanBones(document);
        const std::string rootName = nameNodes(document);
        SourceScene scene;
        const std::vector<std::size_t> shown = shownMeshes(document);
        const std::vector<int> indexOf =
            addNodes(document, rootsWithJoints(document, shown), rootName, scene);
        addMeshes(document, shown, indexOf, scene);
        addAnimations(document, indexOf, scene);
        scene.joints = namedJoints(document);
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
