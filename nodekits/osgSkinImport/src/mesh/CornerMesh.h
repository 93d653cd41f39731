// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CORNERMESH_H
#define OSGSKINIMPORT_CORNERMESH_H 1

#include <osgSkin/MorphTargets>
#include <osgSkinImport/BoneWeights>
#include <osgSkinRig/SkinMesh>

#include <osg/StateSet>
#include <osg/ref_ptr>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// A mesh as returned by the readers of all formats, before it is split into drawable parts.
/// Attributes are per face corner, in the order of mesh.faceVertices.
struct CornerMesh {
    SkinMesh mesh;
    std::vector<glm::vec3> normals;   ///< per corner
    std::vector<glm::vec2> texCoords; ///< per corner
    std::vector<glm::vec4> colours;   ///< per corner, or empty; sRGB
    /// Those in the file, see MeshPart::kTangentAttribute: per corner, zero where there is none;
    /// may end early.
    std::vector<glm::vec4> tangents;
    std::vector<std::uint32_t> materials; ///< per face: index in stateSets
    std::vector<osg::ref_ptr<osg::StateSet>> stateSets;
    std::vector<BoneWeights> weights; ///< per bone
    std::vector<MorphTarget> morphs;  ///< of mesh.positions
    bool hasTexCoords = false;        ///< whether any corner has some

    /// The weights of the bone called `name`, added if new.
    BoneWeights& weightsOf(const std::string& name) {
        for (BoneWeights& known : weights)
            if (known.bone == name) return known;
        weights.push_back({name, {}});
        return weights.back();
    }

    /// Begins a face with the given material; call addCorner() for each of its corners.
    void addFace(std::uint32_t material) {
        mesh.faceSizes.push_back(0);
        materials.push_back(material);
    }

    /// Adds a corner to the last face. A zero normal means that the file has none.
    void addCorner(std::uint32_t vertex, const glm::vec3& normal, const glm::vec2& texCoord) {
        ++mesh.faceSizes.back();
        mesh.faceVertices.push_back(vertex);
        normals.push_back(normal);
        texCoords.push_back(texCoord);
    }
};

} // namespace osgSkin

#endif
