// SPDX-License-Identifier: MIT
//
// A scene in memory, independent of its file format. Each reader (glTF, Assimp) fills it once;
// meshes, skeletons, rigs and motions are made from it.
#ifndef OSGSKINIMPORT_SCENE_SOURCESCENE_H
#define OSGSKINIMPORT_SCENE_SOURCESCENE_H

#include <osgSkinImport/ReadLimits>

#include "mesh/Material.h"

#include <osgSkin/MorphTargets>
#include <osgSkinMotion/Constraint>
#include <osgSkinMotion/SpringSettings>

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/ref_ptr>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
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
    std::vector<std::size_t> meshes; ///< shown by this node
    std::string role{};              ///< RestJoint::role
};

/// A bone of a mesh's skin.
struct SourceBone {
    struct Weight {
        std::uint32_t vertex = 0;
        float weight = 0.0f;
    };
    std::string name;       ///< of a node, which may be missing
    glm::dmat4 offset{1.0}; ///< inverse bind matrix: from the mesh to the node's own frame
    std::vector<Weight> weights;
};

/// Faces of one material. Each attribute has one value per vertex, or is empty.
struct SourceMesh {
    std::string name;
    std::size_t material = 0; ///< index in SourceScene::materials
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;      ///< as MeshPart::kTangentAttribute
    std::vector<glm::vec2> texCoords;     ///< of the material's textures, v up
    std::vector<glm::vec4> colours;       ///< linear or sRGB, like the material
    std::vector<std::uint32_t> faceSizes; ///< corners per face; below 3: points and lines
    std::vector<std::uint32_t> corners;   ///< vertex indices, face by face
    std::vector<SourceBone> bones;
    std::vector<MorphTarget> morphs; ///< offsets in the mesh's space
};

/// An image embedded in the file.
struct SourceImage {
    std::string format;             ///< extension of the reader that decodes `bytes`
    std::string bytes;              ///< encoded
    osg::ref_ptr<osg::Image> image; ///< if the file contains raw pixels instead
};

struct SourceTexture {
    std::string name;                 ///< file, or a name for `image`; empty: no texture
    std::optional<std::size_t> image; ///< index in SourceScene::images
};

struct SourceMaterial {
    Material material;     ///< without images
    bool isLinear = false; ///< vertex colours are linear, and multiplied with the material's
    std::array<SourceTexture, Material::kMaps> textures;
};

template <typename Value>
struct SourceKey {
    double time = 0.0; ///< in ticks
    Value value{};
};

/// One animation of one node: linear between keys, in increasing time.
struct SourceTrack {
    std::string node;
    std::vector<SourceKey<glm::vec3>> positions;
    std::vector<SourceKey<glm::quat>> rotations;
    std::vector<SourceKey<glm::vec3>> scales;
};

/// The weight of a morph target: linear between keys, in increasing time.
struct SourceMorphTrack {
    std::string morph; ///< MorphTarget::name
    int node = -1;     ///< whose mesh has the target; -1: an expression, of any
    std::vector<SourceKey<float>> weights;
};

struct SourceAnimation {
    std::string name;
    double ticksPerSecond = 25.0; ///< above 0
    std::vector<SourceTrack> tracks;
    /// Several may drive one target: in files, each mesh has weights of its own.
    std::vector<SourceMorphTrack> morphs;
    /// How the eyes look, as a rotation of +z about y, then x, in the head's space at rest.
    std::vector<SourceKey<glm::quat>> gaze;
};

/// Copies share the meshes, images and animations.
struct SourceScene {
    std::vector<SourceNode> nodes; ///< the first is the root
    bool isRootMade = true;        ///< it stands for the scene and is none of the file's nodes
    std::vector<std::shared_ptr<const SourceMesh>> meshes;
    std::vector<SourceMaterial> materials; ///< at least one
    std::vector<std::shared_ptr<const SourceImage>> images;
    std::vector<std::shared_ptr<const SourceAnimation>> animations;
    SpringSettings springs;              ///< of nodes in place of joints, in the nodes' pose
    std::vector<Constraint> constraints; ///< of nodes, without axes

    osg::Matrixd toWorld;       ///< rotates up to Z and the front to -Y
    double metresPerUnit = 0.0; ///< 0 if the format does not state it
    std::size_t bytes = 0;      ///< size of the file and of those it names

    /// Adds a node below `parent`, or the root; returns its index.
    int addNode(std::string name, int parent, const glm::dmat4& matrix);
};

/// The names of all meshes' bones.
std::set<std::string> boneNames(const SourceScene& scene);

/// Joins vertices of a mesh that are equal in all attributes, weights and morph targets: Assimp's
/// readers make one for each corner of a face.
void joinEqualVertices(SourceScene& scene);

/// Leaves out coarser levels of detail: of meshes at nodes called "Body_LOD0", "Body_LOD1" and so
/// on, the lowest number is kept. Reports them in a notice.
void dropCoarseLevels(SourceScene& scene, const std::string& path);

/// Makes node names unique, because bones and tracks refer to nodes by name. Of several nodes with
/// one name, they mean one without a mesh, which keeps the name; the others get a counter.
///
/// FBX files may give a mesh and its bone the same name; Assimp then renames the second one to
/// "Torso001", but leaves the bone's reference to the first. If the first is the mesh, the two swap
/// names.
///
/// \param scene to change
/// \param path of the file, whose extension identifies FBX
void separateNames(SourceScene& scene, const std::string& path);

/// Adds a node for each weighted bone without one, so that its vertices can move. Its parent is the
/// bone of the same mesh with which it shares the most weight; it keeps its bind transform relative
/// to that parent. Reports each in a notice.
void addMissingBones(SourceScene& scene, const std::string& path);

/// Attaches joints that only an editor's constraints hold in place, so that they follow the body in
/// any motion, which consists of rotations:
/// - a foot, toe, hand, shin or forearm that is not below its limb's previous bone follows that
///   bone. Rigs with inverse kinematics hang feet on a control;
/// - in rigs whose thighs hang on a root beside the hips, all that hangs there follows the nearest
///   joint of the trunk, as in Rigify's deformation bones exported alone;
/// - MMD's "D" bones, which copy a leg's rotations, follow the leg.
///
/// They keep their place, and their motion in each of the scene's animations that moves them or a
/// node that they hung on. Reports them in one notice. Does nothing for more joints than the limit.
void attachLooseJoints(SourceScene& scene, const std::string& path, const ReadLimits& limits);

/// Gives nodes the scale that every clip replaces their own by, if it is constant and the same in
/// all: their bones are then scaled alike at rest and in motion.
void takeClipScales(SourceScene& scene);

/// A copy of a mesh all of whose vertices follow one joint.
/// \param toJoint from the mesh to the joint's node
std::shared_ptr<const SourceMesh> boundTo(const std::string& joint, const glm::dmat4& toJoint,
                                          const SourceMesh& mesh);

/// In a scene with a skin, decides about meshes that are neither skinned nor parented to a joint.
/// Scenery (a sky, a wall) is left out. If a clip moves the figure, the others follow their own
/// nodes: the nearest one that a clip moves becomes a joint, or else the scene's root does. If no
/// clip does, those inside the figure's bounds (eyes, hair) stay without weights, so that they get
/// some when the figure is bound, and others (a floor) are left out. Reports both in notices.
void bindFreeMeshes(SourceScene& scene, const std::string& path);

/// Makes a face without bones a figure: each mesh of a scene without a skin follows the nearest
/// node above that a clip moves, or else the scene's root.
/// \return false, without a change, if no mesh has a morph target
bool bindFace(SourceScene& scene);

/// A matrix without shear, decomposed: matrix = translation * rotation * scale.
struct NodeTransform {
    glm::dvec3 translation;
    glm::dquat rotation;
    glm::dvec3 scale; ///< x is negative if the matrix mirrors
};

NodeTransform decompose(const glm::dmat4& matrix);

/// The rotation of a matrix, without its scale, or its mirroring along x; the identity if the
/// matrix is singular.
glm::dquat rotationOf(const glm::dmat4& matrix);

} // namespace osgSkin

#endif
