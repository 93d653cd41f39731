// SPDX-License-Identifier: MIT
#include "assimp/AssimpScene.h"

#include "assimp/EditedFile.h"
#include "assimp/FbxMotion.h"
#include "files/FileText.h"
#include "scene/SceneMorphs.h"

#include <glm/geometric.hpp>
#include <osg/Math>
#include <osgDB/FileNameUtils>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

// --- materials ---

osg::Vec4 colour(const aiMaterial& material, const char* key, unsigned type, unsigned index,
                 const osg::Vec4& otherwise) {
    aiColor4D value;
    if (material.Get(key, type, index, value) != AI_SUCCESS) return otherwise;
    return {value.r, value.g, value.b, otherwise.a()};
}

/// An embedded texture of raw texels from the upper left, as in .mdl.
osg::ref_ptr<osg::Image> rawImage(const aiTexture& texture) {
    constexpr unsigned kMaxSide = 1u << 14;
    if (texture.mWidth == 0 || texture.mWidth > kMaxSide || texture.mHeight > kMaxSide)
        return nullptr;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), 1,
                         GL_RGBA, GL_UNSIGNED_BYTE);
    const aiTexel* texel = texture.pcData;
    for (unsigned row = texture.mHeight; row > 0; --row) {
        unsigned char* to = image->data(0, row - 1);
        for (unsigned column = 0; column < texture.mWidth; ++column, ++texel)
            for (const unsigned char part : {texel->r, texel->g, texel->b, texel->a}) *to++ = part;
    }
    return image;
}

SourceImage readImage(const aiTexture& texture) {
    SourceImage result;
    if (texture.mHeight != 0) {
        result.image = rawImage(texture);
        return result;
    }
    result.format = texture.achFormatHint;
    result.bytes.assign(reinterpret_cast<const char*>(texture.pcData), texture.mWidth);
    return result;
}

osg::Texture::WrapMode wrapOf(const aiMaterial& material, const char* key, aiTextureType type) {
    int mode = aiTextureMapMode_Wrap;
    material.Get(key, type, 0, mode);
    if (mode == aiTextureMapMode_Clamp) return osg::Texture::CLAMP_TO_EDGE;
    return mode == aiTextureMapMode_Mirror ? osg::Texture::MIRROR : osg::Texture::REPEAT;
}

/// The set of texture coordinates of one of a material's textures.
unsigned texCoordsOf(const aiMaterial& material, aiTextureType type) {
    int set = 0;
    material.Get(_AI_MATKEY_UVWSRC_BASE, type, 0, set);
    return static_cast<unsigned>(std::max(set, 0));
}

using TextureKind = std::pair<Material::Map, aiTextureType>;

/// Of several kinds with one meaning, the first that there is is drawn.
constexpr TextureKind kTextureKinds[] = {{Material::Diffuse, aiTextureType_DIFFUSE},
                                         {Material::Diffuse, aiTextureType_BASE_COLOR},
                                         {Material::Normal, aiTextureType_NORMALS},
                                         {Material::Normal, aiTextureType_NORMAL_CAMERA},
                                         {Material::Occlusion, aiTextureType_AMBIENT_OCCLUSION},
                                         {Material::Occlusion, aiTextureType_LIGHTMAP},
                                         {Material::Emission, aiTextureType_EMISSIVE},
                                         {Material::Emission, aiTextureType_EMISSION_COLOR}};

/// The textures that are drawn. All have the same texture coordinates.
std::vector<TextureKind> drawnTextures(const aiMaterial& source) {
    std::vector<TextureKind> result;
    std::array<bool, Material::kMaps> isKnown{};
    for (const auto& [map, type] : kTextureKinds) {
        if (isKnown[map] || source.GetTextureCount(type) == 0) continue;
        if (!result.empty() &&
            texCoordsOf(source, type) != texCoordsOf(source, result.front().second))
            continue;
        if (map == Material::Emission &&
            colour(source, AI_MATKEY_COLOR_EMISSIVE, Material().emission) == Material().emission)
            continue;
        isKnown[map] = true;
        result.emplace_back(map, type);
    }
    return result;
}

/// \param unused counts textures that are not drawn, by Assimp's name of their type
SourceMaterial readMaterial(const aiScene& scene, const aiMaterial& source,
                            std::map<std::string, std::size_t>& unused) {
    SourceMaterial result;
    Material& surface = result.material;
    surface.diffuse = colour(source, AI_MATKEY_COLOR_DIFFUSE, surface.diffuse);
    surface.specular = colour(source, AI_MATKEY_COLOR_SPECULAR, surface.specular);
    surface.emission = colour(source, AI_MATKEY_COLOR_EMISSIVE, surface.emission);
    float opacity = 1.0f;
    if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS) surface.diffuse.a() = opacity;
    source.Get(AI_MATKEY_SHININESS, surface.shininess);
    for (const auto& [map, type] : drawnTextures(source)) {
        aiString name;
        if (source.GetTexture(type, 0, &name) != AI_SUCCESS) continue;
        result.textures[map].name = name.C_Str();
        const int embedded = scene.GetEmbeddedTextureAndIndex(name.C_Str()).second;
        if (embedded >= 0) result.textures[map].image = static_cast<std::size_t>(embedded);
        surface.textures[map].wrapS = wrapOf(source, _AI_MATKEY_MAPPINGMODE_U_BASE, type);
        surface.textures[map].wrapT = wrapOf(source, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
    }
    for (unsigned number = aiTextureType_NONE + 1; number <= AI_TEXTURE_TYPE_MAX; ++number) {
        const auto type = static_cast<aiTextureType>(number);
        if (source.GetTextureCount(type) == 0) continue;
        bool isDrawn = false;
        for (const TextureKind& kind : kTextureKinds)
            isDrawn = isDrawn || (kind.second == type && !result.textures[kind.first].name.empty());
        if (isDrawn) continue;
        ++unused[aiTextureTypeToString(type)];
        // Without its texture, the colour would make the whole surface glow.
        if (type == aiTextureType_EMISSIVE || type == aiTextureType_EMISSION_COLOR)
            surface.emission = Material().emission;
    }
    return result;
}

void readMaterials(const aiScene& scene, const std::string& path, SourceScene& result) {
    std::map<std::string, std::size_t> unused;
    for (unsigned m = 0; m < scene.mNumMaterials; ++m)
        result.materials.push_back(readMaterial(scene, *scene.mMaterials[m], unused));
    result.materials.emplace_back(); // for meshes without a material
    warnUnusedTextures(path, unused);
    for (unsigned t = 0; t < scene.mNumTextures; ++t)
        result.images.push_back(
            std::make_shared<const SourceImage>(readImage(*scene.mTextures[t])));
}

// --- nodes, meshes and animations ---

glm::vec3 toGlm(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

glm::quat toGlm(const aiQuaternion& q) {
    return {q.w, q.x, q.y, q.z};
}

glm::dmat4 toGlm(const aiMatrix4x4& m) {
    glm::dmat4 result; // columns
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            result[column][row] = static_cast<double>(m[static_cast<unsigned>(row)][column]);
    return result;
}

std::string toString(const aiString& text) {
    return {text.C_Str(), text.length};
}

/// The set of texture coordinates that the material's textures use.
unsigned texCoordsOf(const aiMesh& mesh, const aiMaterial* material) {
    unsigned wanted = 0;
    if (material != nullptr)
        if (const auto drawn = drawnTextures(*material); !drawn.empty())
            wanted = texCoordsOf(*material, drawn.front().second);
    return wanted < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.HasTextureCoords(wanted) ? wanted : 0;
}

SourceMesh readMesh(const aiScene& scene, const aiMesh& source) {
    SourceMesh result;
    result.name = source.mName.C_Str();
    result.material = std::min(source.mMaterialIndex, scene.mNumMaterials);
    const aiMaterial* const material = source.mMaterialIndex < scene.mNumMaterials
                                           ? scene.mMaterials[source.mMaterialIndex]
                                           : nullptr;
    const unsigned set = texCoordsOf(source, material), vertices = source.mNumVertices;
    for (unsigned v = 0; v < vertices; ++v) {
        result.positions.push_back(toGlm(source.mVertices[v]));
        if (source.HasNormals()) result.normals.push_back(toGlm(source.mNormals[v]));
        if (source.HasTextureCoords(set))
            result.texCoords.emplace_back(source.mTextureCoords[set][v].x,
                                          source.mTextureCoords[set][v].y);
        if (source.HasNormals() && source.HasTangentsAndBitangents() && set == 0) {
            const glm::vec3 along = toGlm(source.mTangents[v]);
            const glm::vec3 across = glm::cross(result.normals.back(), along);
            const bool isMirrored = glm::dot(across, toGlm(source.mBitangents[v])) < 0.0f;
            result.tangents.emplace_back(along, isMirrored ? -1.0f : 1.0f);
        }
        if (source.HasVertexColors(0)) {
            const aiColor4D& c = source.mColors[0][v];
            result.colours.emplace_back(c.r, c.g, c.b, c.a);
        }
    }
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        result.faceSizes.push_back(face.mNumIndices);
        result.corners.insert(result.corners.end(), face.mIndices,
                              face.mIndices + face.mNumIndices);
    }
    for (unsigned b = 0; b < source.mNumBones; ++b) {
        const aiBone& from = *source.mBones[b];
        SourceBone& bone = result.bones.emplace_back();
        bone.name = toString(from.mName);
        bone.offset = toGlm(from.mOffsetMatrix);
        for (unsigned w = 0; w < from.mNumWeights; ++w)
            bone.weights.push_back({from.mWeights[w].mVertexId, from.mWeights[w].mWeight});
    }
    return result;
}

/// Reads morph targets, which Assimp calls animation meshes. It does not say with which weights
/// they begin, and reads none from Collada files.
class MorphReader {
public:
    /// Adds a mesh's targets.
    /// \param mesh with its positions
    void addMorphs(const aiMesh& source, SourceMesh& mesh) {
        const std::vector<const aiAnimMesh*> targets = targetsOf(source);
        std::vector<std::string> wanted;
        wanted.reserve(targets.size());
        for (const aiAnimMesh* target : targets)
            wanted.push_back(target->mName.length > 0
                                 ? nameOf(*target)
                                 : mesh.name + "-" + std::to_string(wanted.size()));
        const std::vector<std::string> names =
            _names.of(wanted, std::vector<float>(wanted.size(), 0.0f));
        const MorphFiller filler(mesh);
        for (std::size_t t = 0; t < targets.size(); ++t) {
            const auto offsets = [&](const aiVector3D* to, const aiVector3D* rest) {
                return offsetsOf(to, rest, std::min(targets[t]->mNumVertices, source.mNumVertices));
            };
            MorphTarget& target = mesh.morphs.emplace_back();
            target.name = names[t];
            filler.fill(offsets(targets[t]->mVertices, source.mVertices),
                        offsets(targets[t]->mNormals, source.mNormals),
                        offsets(targets[t]->mTangents, source.mTangents), target);
        }
    }

    /// Adds the tracks of an animation.
    /// \param scene with all meshes and nodes
    static void addTracks(const aiAnimation& source, const SourceScene& scene,
                          SourceAnimation& result) {
        for (unsigned c = 0; c < source.mNumMorphMeshChannels; ++c) {
            const aiMeshMorphAnim& from = *source.mMorphMeshChannels[c];
            const SourceMesh* mesh = nullptr;
            const int node = nodeOf(from.mName.C_Str(), scene, mesh);
            if (node < 0) continue;
            std::vector<SourceMorphTrack> tracks(mesh->morphs.size());
            for (unsigned k = 0; k < from.mNumKeys; ++k) {
                const aiMeshMorphKey& key = from.mKeys[k];
                for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i)
                    if (key.mValues[i] < tracks.size())
                        tracks[key.mValues[i]].weights.push_back(
                            {key.mTime, static_cast<float>(key.mWeights[i])});
            }
            for (std::size_t t = 0; t < tracks.size(); ++t) {
                if (tracks[t].weights.empty()) continue;
                tracks[t].morph = mesh->morphs[t].name;
                tracks[t].node = node;
                result.morphs.push_back(std::move(tracks[t]));
            }
        }
    }

    void warnLosses(const std::string& path) const {
        _names.warnRenamed(path);
        if (_between > 0)
            warn(path, std::to_string(_between) + " in-between shapes of morph targets ignored");
    }

private:
    /// Assimp 5.4 calls an FBX shape "smile" of a channel "smile" "smile.smile".
    static std::string nameOf(const aiAnimMesh& target) {
        const std::string name = target.mName.C_Str();
        const std::string half = name.substr(0, name.size() / 2);
        return name == half + "." + half ? half : name;
    }

    /// An FBX channel may have several shapes, all with its name, of which the last one is that of
    /// its full weight. Channels are numbered without the others.
    std::vector<const aiAnimMesh*> targetsOf(const aiMesh& source) {
        std::vector<const aiAnimMesh*> result;
        for (unsigned t = 0; t < source.mNumAnimMeshes; ++t) {
            const aiAnimMesh* const target = source.mAnimMeshes[t];
            const bool isSame = !result.empty() && target->mName.length > 0 &&
                                target->mName == result.back()->mName;
            if (isSame) {
                result.back() = target;
                ++_between;
            } else {
                result.push_back(target);
            }
        }
        return result;
    }

    /// None where one of the lists is missing.
    static VertexOffsets offsetsOf(const aiVector3D* to, const aiVector3D* rest, unsigned count) {
        VertexOffsets result;
        for (unsigned v = 0; to != nullptr && rest != nullptr && v < count; ++v) {
            const glm::vec3 offset = toGlm(to[v]) - toGlm(rest[v]);
            if (offset == glm::vec3(0.0f)) continue;
            result.vertices.push_back(v);
            result.offsets.push_back(offset);
        }
        return result;
    }

    /// The node whose mesh a channel animates: "NODE*0" in FBX files, or a node's or a mesh's name;
    /// -1 where there is none.
    /// \param[out] mesh its mesh with the most targets
    static int nodeOf(const std::string& channel, const SourceScene& scene,
                      const SourceMesh*& mesh) {
        const std::string name = channel.substr(0, channel.rfind('*'));
        int result = -1;
        for (std::size_t n = 0; n < scene.nodes.size(); ++n)
            for (const std::size_t index : scene.nodes[n].meshes) {
                const std::string& own = scene.nodes[n].name;
                const SourceMesh& each = *scene.meshes[index];
                if ((own != name && own != channel && each.name != channel) ||
                    (result >= 0 && mesh->morphs.size() >= each.morphs.size()))
                    continue;
                mesh = &each;
                result = static_cast<int>(n);
            }
        return result;
    }

    MorphNames _names;
    std::size_t _between = 0;
};

template <typename Key, typename Value>
void readKeys(const Key* keys, unsigned count, std::vector<SourceKey<Value>>& result) {
    result.reserve(count);
    for (unsigned k = 0; k < count; ++k) result.push_back({keys[k].mTime, toGlm(keys[k].mValue)});
}

SourceAnimation readAnimation(const aiAnimation& source) {
    SourceAnimation result;
    result.name = source.mName.C_Str();
    if (source.mTicksPerSecond > 0.0) result.ticksPerSecond = source.mTicksPerSecond;
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
        const aiNodeAnim& from = *source.mChannels[c];
        SourceTrack& track = result.tracks.emplace_back();
        track.node = from.mNodeName.C_Str();
        readKeys(from.mPositionKeys, from.mNumPositionKeys, track.positions);
        readKeys(from.mRotationKeys, from.mNumRotationKeys, track.rotations);
        readKeys(from.mScalingKeys, from.mNumScalingKeys, track.scales);
    }
    return result;
}

/// The children that each node should have. Some of Assimp's readers leave null children in a node.
/// The reader of Half-Life's models lists all bones as children of one node, and only
/// mParent says which bone is below which.
std::unordered_map<const aiNode*, std::vector<const aiNode*>> childrenOf(const aiScene& scene) {
    std::unordered_map<const aiNode*, std::vector<const aiNode*>> result;
    std::vector<const aiNode*> open{scene.mRootNode};
    while (!open.empty()) {
        const aiNode* const node = open.back();
        open.pop_back();
        if (node->mChildren == nullptr) continue;
        const std::set<const aiNode*> listed(node->mChildren, node->mChildren + node->mNumChildren);
        const bool isBones = node->mName == aiString("<MDL_bones>");
        for (unsigned c = 0; c < node->mNumChildren; ++c) {
            const aiNode* const child = node->mChildren[c];
            if (child == nullptr) continue;
            open.push_back(child);
            result[isBones && listed.count(child->mParent) != 0 ? child->mParent : node].push_back(
                child);
        }
    }
    return result;
}

/// Reads all nodes.
void readNodes(const aiScene& scene, const std::string& path, const ReadLimits& limits,
               SourceScene& result) {
    struct Open {
        const aiNode* node;
        int parent;
        std::size_t depth;
    };
    const auto children = childrenOf(scene);
    std::vector<Open> open{{scene.mRootNode, -1, 1}};
    while (!open.empty()) {
        const Open at = open.back();
        const aiNode& node = *at.node;
        open.pop_back();
        if (at.depth > limits.depth)
            failFile(path, "node " + inQuotes(node.mName.C_Str()) + " is nested more than " +
                               std::to_string(limits.depth) + " deep (option maxDepth)");
        const int index =
            result.addNode(toString(node.mName), at.parent, toGlm(node.mTransformation));
        for (unsigned m = 0; m < node.mNumMeshes; ++m) {
            if (node.mMeshes[m] >= scene.mNumMeshes)
                failFile(path, "node " + inQuotes(node.mName.C_Str()) + " names mesh " +
                                   std::to_string(node.mMeshes[m]) + ", expected less than " +
                                   std::to_string(scene.mNumMeshes));
            result.nodes.back().meshes.push_back(node.mMeshes[m]);
        }
        const auto below = children.find(&node);
        if (below == children.end()) continue;
        for (auto child = below->second.rbegin(); child != below->second.rend(); ++child)
            open.push_back({*child, index, at.depth + 1});
    }
}

// --- the file ---

/// In OSG's world, Z is up and a figure faces -Y. Assimp converts most formats to Y up, but leaves
/// FBX files in the axes that they declare, and SMD files in Z up.
osg::Matrixd toWorld(const aiScene& scene, const std::string& path) {
    if (osgDB::getLowerCaseFileExtension(path) == "smd") return {};
    int up = 1;
    if (scene.mMetaData != nullptr && scene.mMetaData->Get("UpAxis", up) && up == 2) return {};
    return osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
}

double metresPerUnit(const aiScene& scene, const std::string& path) {
    double centimetres = 0.0;
    float single = 0.0f;
    // Assimp scales the root node of Collada files by their unit.
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension == "dae" || extension == "zae") return 1.0;
    if (scene.mMetaData == nullptr) return 0.0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return 0.01 * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", single)) return 0.01 * double(single);
    return 0.0;
}

} // namespace

SourceScene readAssimpScene(const std::string& path, const ReadLimits& limits) {
    Assimp::Importer importer;
    // Otherwise Assimp would add a mesh of its own to a file with only a skeleton.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    SourceScene result;
    result.bytes = requireReadable(path, limits);
    const std::string& fbx = editFile(path, limits, importer);
    FbxModels models(FbxDocument::read(fbx, path));
    models.checkNodes(path, limits);
    const aiScene* scene = nullptr;
    std::string reason;
    try {
        scene = importer.ReadFile(path, 0);
        if (scene == nullptr) reason = importer.GetErrorString();
    } catch (const std::exception& error) {
        reason = error.what();
    }
    if (scene == nullptr || scene->mRootNode == nullptr)
        failFile(path, (reason.empty() ? "cannot be read" : reason) + adviceFor(fbx));
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
        if (scene->mMeshes[m] == nullptr) failFile(path, "Assimp returned a null mesh");
    readNodes(*scene, path, limits, result);
    readMaterials(*scene, path, result);
    MorphReader morphs;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        SourceMesh mesh = readMesh(*scene, *scene->mMeshes[m]);
        morphs.addMorphs(*scene->mMeshes[m], mesh);
        result.meshes.push_back(std::make_shared<const SourceMesh>(std::move(mesh)));
    }
    for (unsigned a = 0; a < scene->mNumAnimations; ++a) {
        SourceAnimation animation = readAnimation(*scene->mAnimations[a]);
        MorphReader::addTracks(*scene->mAnimations[a], result, animation);
        result.animations.push_back(std::make_shared<const SourceAnimation>(std::move(animation)));
    }
    morphs.warnLosses(path);
    separateMorphs(result, path);
    correctFbx(models, path, limits, result);
    joinEqualVertices(result);
    result.toWorld = toWorld(*scene, path);
    result.metresPerUnit = metresPerUnit(*scene, path);
    return result;
}

} // namespace osgSkin
