// SPDX-License-Identifier: MIT
#ifndef QUALITY_SUBJECT_H
#define QUALITY_SUBJECT_H

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/BindReport>
#include <osgSkinBind/BindWeights>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <Blending.h>
#include <glm/mat4x4.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quality {

/// A body with a skeleton and painted weights, not bound yet.
struct PaintedBody {
    std::string name;
    osgSkin::SkinMesh mesh;
    osgSkin::RestSkeleton rig;
    osgSkin::VertexWeights painted; ///< one list for each vertex, over the rig's joints
};

/// \param body mesh file
/// \param rig skeleton file
/// \param weights JSON of painted weights
/// \throw osgSkin::Error if a file cannot be read or does not fit the others
PaintedBody loadBody(const std::string& body, const std::string& rig, const std::string& weights);

/// The source of our ratios.
enum class Ratios {
    Smooth,    ///< regions, made continuous: the default
    AsPrinted, ///< between boundary planes
    Painted    ///< the painted weights
};

struct SubjectFiles {
    std::string body, rig, weights;
    Ratios ratios = Ratios::Smooth;
};

/// A body to measure: bound with our ratios, and with its painted weights for the peers.
struct Subject {
    std::string name;
    osgSkin::SkinMesh mesh;
    osgSkin::RestSkeleton rig;
    osgSkin::Binding binding;
    osgSkin::BindReport report;
    std::optional<osgSkin::BindOptions> options; ///< unset if bound by weights
    compare::SkinWeights weights;                ///< over the rig's joints

    compare::Points rest;
    compare::Points normals; ///< at rest; zero for vertices that the measured skin does not use
    /// The measured skin: vertices at the same position are merged into the first one.
    std::vector<std::uint32_t> triangles;
    std::vector<compare::Edge> edges;
    osg::ref_ptr<const osgSkin::SkinModel> model; ///< with the mesh's vertices, one to one

    /// Index of the joint of that name in any of the usual rigs ("LeftForeArm" is "lowerarm_l"
    /// elsewhere), or -1.
    int joint(const std::string& name) const;

    /// The joint with the largest painted weight.
    std::uint32_t dominantJoint(std::size_t vertex) const;
};

/// \throw osgSkin::Error if a file cannot be read or does not fit the others
Subject loadSubject(const SubjectFiles& files);

/// Binds a body.
/// \throw osgSkin::Error if its parts do not fit each other
Subject makeSubject(PaintedBody body, Ratios ratios = Ratios::Smooth);

/// The model of the subject's binding.
osg::ref_ptr<const osgSkin::SkinModel> modelOf(const Subject& subject);

/// A posed skin with the method's own normals.
struct PosedSkin {
    compare::Points points, normals;
};

/// Area-weighted normals, unit; zero at vertices without triangles.
compare::Points skinNormals(const compare::Points& points,
                            const std::vector<std::uint32_t>& triangles);

/// The shapes of MakeHuman's bodies in the shared data.
inline const std::vector<std::string> kShapes{"neutral", "male",       "female",
                                              "child",   "female_old", "male_heavy"};

/// The files of a shape with about 4,000 vertices.
/// \param shape one of kShapes
/// \param rig "cmu_mb", "game_engine" or "default"
inline SubjectFiles makeHumanFiles(const std::string& shape, const std::string& rig = "cmu_mb") {
    const std::string folder = OSGSKIN_SHARED_DATA "/makehuman/";
    SubjectFiles files;
    files.body = folder + "body/body4k_" + shape + ".obj";
    files.rig = folder + "rig/" + rig + "_" + shape + ".bvh";
    files.weights = folder + "weights/body4k_weights_" + rig + ".json";
    return files;
}

/// The bone heat weights of a shape, for the rig "cmu_mb".
inline std::string makeHumanHeat(const std::string& shape) {
    return OSGSKIN_SHARED_DATA "/makehuman/heat/body4k_" + shape + ".json";
}

/// The shape that these files belong to; empty for another body.
inline std::string shapeOf(const SubjectFiles& files) {
    for (const std::string& shape : kShapes)
        if (makeHumanFiles(shape).body == files.body) return shape;
    return {};
}

struct NamedPose {
    std::string name;                 ///< clip:frame, numbered as in the file
    std::vector<glm::dmat4> skinning; ///< G_j of each joint of the rig
};

/// The standard poses: walk, pitch, climb and jump from the CMU motions in `folder`, 36 in all.
/// \throw osgSkin::Error if a file is missing or does not fit the rig
std::vector<NamedPose> standardPoses(const std::string& folder, const Subject& subject);

enum class Method { Linear, DualQuaternion, Ours };
constexpr std::array<Method, 3> kMethods{Method::Linear, Method::DualQuaternion, Method::Ours};

/// A value for each method, in the order of kMethods.
template <typename T>
struct PerMethod {
    std::array<T, 3> values{};
    T& operator[](Method method) { return values[static_cast<std::size_t>(method)]; }
    const T& operator[](Method method) const { return values[static_cast<std::size_t>(method)]; }
};

const char* nameOf(Method method);

/// The posed skin, one point per vertex of the mesh.
/// \param subject the skin
/// \param method of deformation
/// \param skinning G_j = bone matrix * inverse bind matrix for each joint of the rig
compare::Points deform(const Subject& subject, Method method,
                       const std::vector<glm::dmat4>& skinning);

/// The same with normals. Linear blending rotates normals by the blended matrix, as renderers do.
PosedSkin deformWithNormals(const Subject& subject, Method method,
                            const std::vector<glm::dmat4>& skinning);

/// One joint rotated about its centre, with its descendants; radians.
std::vector<glm::dmat4> singleTurn(const Subject& subject, std::size_t joint,
                                   const glm::dvec3& axis, double angle);

} // namespace quality

#endif
