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

/// Of required extensions, those that are read or have to do with looks only.
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

/// Of extensions that need not be required, those that say where things stand or how they move.
constexpr const char* kMissed[] = {"KHR_animation_pointer", "EXT_mesh_gpu_instancing",
                                   "KHR_node_visibility"};

bool isHarmless(const std::string& extension) {
    return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                       [&](const char* start) { return extension.rfind(start, 0) == 0; });
}

/// Says in a notice what the file requires that is not known to leave shapes and motions alone.
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

/// Whether the front of the file's figure is -Z: VRM 0 turned it so, where glTF has +Z.
bool facesBackwards(const GltfFile& file) {
    const auto extensions = file.json.find("extensions");
    return extensions != file.json.end() && extensions->contains("VRM");
}

// --- names ---

/// Whose name goes before: joints, then what moves, then nodes without a mesh.
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

/// Gives each node a name of its own: glTF knows nodes by their numbers, and two may be called
/// alike. Joints keep theirs before nodes that are none; what must change gets a counter, as
/// "Torso.001".
/// \return a name that no node has, for a root of several roots
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

/// Nodes with a mesh that the scene shows, those below a node before it.
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

/// Adds the scene's nodes from the root down; returns each node's index, -1 for those that it does
/// not have.
std::vector<int> addNodes(const GltfDocument& document, const std::string& rootName,
                          SourceScene& scene) {
    std::vector<int> indexOf(document.nodes.size(), -1);
    std::vector<std::size_t> open(document.roots.rbegin(), document.roots.rend());
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

} // namespace

bool isGltfName(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return extension == "gltf" || extension == "glb" || extension == "vrm";
}

SourceScene readGltf(const std::string& path, const ReadLimits& limits) {
    GltfFile file = GltfFile::read(path, limits);
    try {
        noteExtensions(file);
        unpackMeshopt(file);
        GltfDocument document(file);
        const std::string rootName = nameNodes(document);
        SourceScene scene;
        const std::vector<int> indexOf = addNodes(document, rootName, scene);
        addMeshes(document, shownMeshes(document), indexOf, scene);
        addAnimations(document, indexOf, scene);
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
