// SPDX-License-Identifier: MIT
//
// A file of a rigged format as it stands in memory, whatever the format: each reader (glTF, Assimp)
// fills it once, and meshes, skeletons, rigs and motions are made of it.
#ifndef OSGSKINIMPORT_SCENE_SOURCESCENE_H
#define OSGSKINIMPORT_SCENE_SOURCESCENE_H

#include "mesh/Material.h"

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/ref_ptr>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {

struct SourceNode {
    std::string name;       ///< unique in its scene
    glm::dmat4 matrix{1.0}; ///< from its own frame to its parent's
    int parent = -1;        ///< index in SourceScene::nodes; -1 for the root
    std::vector<int> children;
    std::vector<std::size_t> meshes; ///< that it shows
};

/// A bone of a mesh's skin.
struct SourceBone {
    struct Weight {
        std::uint32_t vertex = 0;
        float weight = 0.0f;
    };
    std::string name;       ///< of a node, which need not be there
    glm::dmat4 offset{1.0}; ///< inverse bind matrix: from the mesh to the node's own frame
    std::vector<Weight> weights;
};

/// Faces of one material. Attributes stand at the vertices: one each, or none at all.
struct SourceMesh {
    std::string name;
    std::size_t material = 0; ///< index in SourceScene::materials
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> texCoords;     ///< of the material's texture, v up
    std::vector<glm::vec4> colours;       ///< linear or sRGB, as the material's
    std::vector<std::uint32_t> faceSizes; ///< corners of each face; below 3: points and lines
    std::vector<std::uint32_t> corners;   ///< vertices, face by face
    std::vector<SourceBone> bones;
};

/// A picture that stands in the file itself.
struct SourceImage {
    std::string format;             ///< extension of the reader that decodes `bytes`
    std::string bytes;              ///< encoded
    osg::ref_ptr<osg::Image> image; ///< where the file holds plain pixels instead
};

struct SourceMaterial {
    Material look;                    ///< but its picture
    bool isLinear = false;            ///< the vertices' colours are linear and multiplied with it
    std::string texture;              ///< file of its diffuse texture, or a name for `image`
    std::optional<std::size_t> image; ///< index in SourceScene::images
};

template <typename Value>
struct SourceKey {
    double time = 0.0; ///< in ticks
    Value value{};
};

/// What one animation does to one node: linear between keys, whose times rise.
struct SourceTrack {
    std::string node;
    std::vector<SourceKey<glm::vec3>> positions;
    std::vector<SourceKey<glm::quat>> rotations;
    std::vector<SourceKey<glm::vec3>> scales;
};

struct SourceAnimation {
    std::string name;
    double ticksPerSecond = 25.0; ///< above 0
    std::vector<SourceTrack> tracks;
};

/// Copies share the meshes, images and animations.
struct SourceScene {
    std::vector<SourceNode> nodes; ///< the first is the root
    std::vector<std::shared_ptr<const SourceMesh>> meshes;
    std::vector<SourceMaterial> materials; ///< at least one
    std::vector<std::shared_ptr<const SourceImage>> images;
    std::vector<std::shared_ptr<const SourceAnimation>> animations;

    osg::Matrixd toWorld;       ///< rotates up to Z and the front to -Y
    double metresPerUnit = 0.0; ///< 0 where the format does not say
    std::size_t bytes = 0;      ///< of the file and those it names

    /// Adds a node below another, or the root; returns its index.
    int addNode(std::string name, int parent, const glm::dmat4& matrix);
};

/// The names of all meshes' bones.
std::set<std::string> boneNames(const SourceScene& scene);

/// Makes the names of a scene's nodes unique, since bones and tracks know their nodes by name: of
/// several nodes, they mean one that holds no mesh. The others get a counter behind the name.
///
/// FBX files name a mesh and its bone alike; Assimp then calls the second of them "Torso001" and
/// lets the bone mean the first. Where that is the mesh, the two exchange names.
///
/// \param path of the file, whose extension tells FBX
void separateNames(SourceScene& scene, const std::string& path);

/// Gives a node to each bone that the file has painted weights for and no node, so that what hangs
/// on it can move: it follows, as its child, the bone of the same mesh that it shares most
/// weight with, and stands to it as in the bind pose. Says so in a notice.
void addMissingBones(SourceScene& scene, const std::string& path);

/// A matrix without shear, in its parts: matrix = translation * rotation * scale.
struct NodeTransform {
    glm::dvec3 translation;
    glm::dquat rotation;
    glm::dvec3 scale; ///< the first is negative where the matrix mirrors
};

NodeTransform decompose(const glm::dmat4& matrix);

/// The rotation of a matrix, without its scale; none where it mirrors or is flat.
glm::dquat rotationOf(const glm::dmat4& matrix);

} // namespace osgSkin

#endif
