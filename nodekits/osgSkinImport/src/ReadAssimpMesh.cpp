// SPDX-License-Identifier: MIT
#include "AssimpScene.h"
#include "FileText.h"
#include "Materials.h"
#include "MeshReaders.h"
#include "PlyCheck.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <assimp/material.h>

#include <glm/matrix.hpp>

#include <limits>
#include <sstream>
#include <utility>

namespace osgSkin {
namespace {

osg::Vec4 colour(const aiMaterial& material, const char* key, unsigned type, unsigned index,
                 const osg::Vec4& otherwise) {
    aiColor4D value;
    if (material.Get(key, type, index, value) != AI_SUCCESS) return otherwise;
    return {value.r, value.g, value.b, otherwise.a()};
}

/// A texture that is packed into the scene's own file, as in .glb; null where it cannot be decoded.
osg::ref_ptr<osg::Image> embeddedImage(const aiTexture& texture) {
    if (texture.mHeight != 0) return nullptr; // raw texels: no format in use stores them
    osgDB::ReaderWriter* reader =
        osgDB::Registry::instance()->getReaderWriterForExtension(texture.achFormatHint);
    if (reader == nullptr) return nullptr;
    std::istringstream stream(
        std::string(reinterpret_cast<const char*>(texture.pcData), texture.mWidth));
    return reader->readImage(stream).getImage();
}

Look lookOf(const aiScene& scene, const aiMaterial& material, const std::string& path,
            const osgDB::Options* options) {
    Look look;
    look.diffuse = colour(material, AI_MATKEY_COLOR_DIFFUSE, look.diffuse);
    look.specular = colour(material, AI_MATKEY_COLOR_SPECULAR, look.specular);
    look.emission = colour(material, AI_MATKEY_COLOR_EMISSIVE, look.emission);
    float opacity = 1.0f;
    if (material.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS) look.diffuse.a() = opacity;
    material.Get(AI_MATKEY_SHININESS, look.shininess);
    aiString name;
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != AI_SUCCESS) return look;
    const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str());
    look.image =
        embedded != nullptr ? embeddedImage(*embedded) : readTexture(name.C_Str(), path, options);
    return look;
}

/// Adds one mesh of the scene, moved to its place.
void addMesh(const aiMesh& source, const glm::dmat4& place, const std::string& where,
             CornerMesh& result) {
    const std::size_t first = result.mesh.positions.size();
    if (first + source.mNumVertices > std::numeric_limits<std::uint32_t>::max())
        failFile(where, "more vertices than 32-bit indices reach");
    for (unsigned v = 0; v < source.mNumVertices; ++v)
        result.mesh.positions.emplace_back(place * glm::dvec4(toGlm(source.mVertices[v]), 1.0));

    const glm::dmat3 turn(place);
    const glm::dmat3 normalTurn = glm::transpose(glm::inverse(turn));
    const bool mirrored = glm::determinant(turn) < 0.0;
    const bool hasTexCoords = source.HasTextureCoords(0);
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        if (face.mNumIndices < 3) continue; // points and lines
        result.addFace(source.mMaterialIndex);
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            // A mirrored face keeps its outside when its corners run the other way round.
            const unsigned v = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
            if (v >= source.mNumVertices)
                failFile(where, "face " + std::to_string(f) + " names vertex " + std::to_string(v) +
                                    ", expected less than " + std::to_string(source.mNumVertices));
            glm::dvec3 normal(0.0);
            if (source.HasNormals()) normal = normalTurn * toGlm(source.mNormals[v]);
            glm::vec2 texCoord(0.0f);
            if (hasTexCoords)
                texCoord = {source.mTextureCoords[0][v].x, source.mTextureCoords[0][v].y};
            result.addCorner(static_cast<std::uint32_t>(first) + v, glm::vec3(normal), texCoord);
        }
        result.hasTexCoords = result.hasTexCoords || hasTexCoords;
    }
}

} // namespace

bool assimpReads(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return !extension.empty() && Assimp::Importer().IsExtensionSupported("." + extension);
}

CornerMesh readAssimpMesh(const std::string& path, const osgDB::Options* options) {
    if (osgDB::getLowerCaseFileExtension(path) == "ply") checkPly(path, readText(path));
    Assimp::Importer importer;
    const aiScene& scene = readAssimpScene(importer, path);
    CornerMesh result;
    for (unsigned m = 0; m < scene.mNumMaterials; ++m)
        result.stateSets.push_back(
            makeStateSet(lookOf(scene, *scene.mMaterials[m], path, options)));

    std::vector<std::pair<const aiNode*, glm::dmat4>> open{{scene.mRootNode, glm::dmat4(1.0)}};
    while (!open.empty()) {
        const auto [node, above] = open.back();
        open.pop_back();
        const glm::dmat4 place = above * toGlm(node->mTransformation);
        for (unsigned m = 0; m < node->mNumMeshes; ++m) {
            const aiMesh& mesh = *scene.mMeshes[node->mMeshes[m]];
            if (mesh.mMaterialIndex >= result.stateSets.size())
                result.stateSets.resize(mesh.mMaterialIndex + 1, makeStateSet(Look()));
            addMesh(mesh, place, path + ": mesh \"" + mesh.mName.C_Str() + "\"", result);
        }
        for (unsigned c = node->mNumChildren; c > 0; --c)
            open.emplace_back(node->mChildren[c - 1], place);
    }
    return result;
}

} // namespace osgSkin
