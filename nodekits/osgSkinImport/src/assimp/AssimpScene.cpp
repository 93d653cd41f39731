// SPDX-License-Identifier: MIT
#include "assimp/AssimpScene.h"

#include "assimp/MissingBones.h"
#include "assimp/NodeNames.h"
#include "assimp/SceneFile.h"
#include "gltf/plain/PlainGltf.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <assimp/config.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

/// Refuses what Assimp would hang on, and what it would look into for itself: of a file whose name
/// says nothing to it, or that another reader here has, it asks each of its readers whether they
/// know the first bytes, and some read beyond those.
void checkBefore(const std::string& path, const ReadLimits& limits) {
    requireReadable(path, limits);
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    // Read by readBvh(): Assimp believes any number of frames.
    if (extension == "bvh")
        failFile(path, "no face in a BVH file: it holds a skeleton and no mesh with bones");
    if (!assimpReads(path))
        failFile(path, extension.empty()
                           ? std::string("its name has no extension, expected that of its format")
                           : "files named " + inQuotes("." + extension) +
                                 " are not read for this, expected .bvh, .fbx, .glb or another "
                                 "that Assimp reads");
}

/// Makes a scene safe to walk: some readers of Assimp's leave null among a node's children.
void checkAfter(aiScene& scene, const std::string& path, const ReadLimits& limits) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        if (scene.mMeshes[m] == nullptr) failFile(path, "Assimp reads a mesh that is not there");
    std::vector<std::pair<aiNode*, std::size_t>> open{{scene.mRootNode, 1}};
    while (!open.empty()) {
        const auto [above, depth] = open.back();
        aiNode& node = *above;
        open.pop_back();
        if (depth > limits.depth)
            failFile(path, "node " + inQuotes(node.mName.C_Str()) + " is nested more than " +
                               std::to_string(limits.depth) + " deep (option maxDepth)");
        for (unsigned m = 0; m < node.mNumMeshes; ++m)
            if (node.mMeshes[m] >= scene.mNumMeshes)
                failFile(path, "node " + inQuotes(node.mName.C_Str()) + " names mesh " +
                                   std::to_string(node.mMeshes[m]) + ", expected less than " +
                                   std::to_string(scene.mNumMeshes));
        if (node.mChildren == nullptr) node.mNumChildren = 0;
        aiNode** const end = node.mChildren + node.mNumChildren;
        aiNode** const kept = std::remove(node.mChildren, end, nullptr);
        node.mNumChildren = static_cast<unsigned>(kept - node.mChildren);
        for (aiNode** child = node.mChildren; child != kept; ++child)
            open.emplace_back(*child, depth + 1);
    }
}

} // namespace

bool holdsMeshesOnly(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return extension == "obj" || extension == "ply" || extension == "off" || extension == "stl";
}

const aiScene& readAssimpScene(Assimp::Importer& importer, const std::string& path,
                               const ReadLimits& limits) {
    // Assimp would add a mesh of its own to a file that holds a skeleton only.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    checkBefore(path, limits);
    std::string name = path;
    bool facesBackwards = false;
    if (isGltfName(path)) {
        PlainGltf plain = plainGltf(path, limits);
        name += ".glb"; // Assimp goes by the extension
        facesBackwards = plain.facesBackwards;
        importer.SetIOHandler(new SceneFile(name, std::move(plain.bytes))); // takes it over
    }
    const aiScene* scene = nullptr;
    std::string reason;
    try {
        scene = importer.ReadFile(name, 0);
        if (scene == nullptr) reason = importer.GetErrorString();
    } catch (const std::exception& error) {
        reason = error.what();
    }
    if (scene == nullptr || scene->mRootNode == nullptr)
        failFile(path, reason.empty() ? "cannot be read" : reason);
    auto& owned = const_cast<aiScene&>(*scene); // the importer's, which nobody else sees
    checkAfter(owned, path, limits);
    if (facesBackwards) {
        if (owned.mMetaData == nullptr) owned.mMetaData = new aiMetadata; // the scene's
        owned.mMetaData->Add(kFacesBackwards, true);
    }
    separateNames(owned, path);
    addMissingBones(owned, path);
    return owned;
}

glm::dvec3 toGlm(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

glm::dquat toGlm(const aiQuaternion& q) {
    return {q.w, q.x, q.y, q.z};
}

glm::dmat4 toGlm(const aiMatrix4x4& m) {
    glm::dmat4 result; // columns
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            result[column][row] = static_cast<double>(m[static_cast<unsigned>(row)][column]);
    return result;
}

bool assimpReads(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return isGltfName(path) ||
           (!extension.empty() && Assimp::Importer().IsExtensionSupported("." + extension));
}

} // namespace osgSkin
