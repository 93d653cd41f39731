// SPDX-License-Identifier: MIT
#ifndef BENCH_BENCHBODY_H
#define BENCH_BENCHBODY_H

#include "Subdivide.h"

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>
#include <osgSkinRig/Clip>
#include <osgSkinRig/RestSkeleton>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <osg/ref_ptr>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace bench {

/// Linear blend weights, for osgAnimation's software rig.
struct Weights {
    using Vertex = std::vector<std::pair<std::uint32_t, float>>; ///< (joint, weight), by joint
    std::string name;
    std::vector<Vertex> vertices;

    /// Number of sets of vertices with the same joints and weights; it determines a rig's cost.
    std::size_t groupCount() const;
};

/// The hand-painted weights of a MakeHuman file; empty if the file is missing.
Weights readPaintedWeights(const std::string& file, const std::vector<osgSkin::BoundJoint>& joints,
                           std::size_t vertices);

/// The weights that are equivalent to our ratios: a joint's ratio less those of its children.
Weights weightsFromRatios(const osgSkin::Binding& binding);

Weights blend(const Weights& weights, const std::vector<Blend>& vertices);

/// A whole body (no rigid parts) in one motion, at the requested mesh resolution.
struct Body {
    std::string name;
    osgSkin::RestSkeleton rig;
    osgSkin::Clip clip;
    osgSkin::Binding binding;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> triangles;
    Weights weights;
    /// Skinning matrices of every sample of the clip, [frame][joint].
    std::vector<std::vector<glm::dmat4>> skinning;

    osg::ref_ptr<const osgSkin::SkinModel> model() const;

    /// Mean number of joints that a vertex follows in part; the deformation's cost depends on it.
    double partialPerVertex() const;
};

/// Binding: normals that rotate with their vertices, normals of the deformed surface, or surface
/// normals with the shapes "fast".
enum class Kind { Turned, Surface, Shaped };

/// body4k_neutral in a walk, or our own thrower if the third-party data is missing. `parts` splits
/// every edge (Subdivide.h); ratios, weights and normals are interpolated. Each kind is made once
/// and cached.
const Body& body(std::uint32_t parts, Kind kind = Kind::Turned);

/// The body under osgAnimation's own software rig.
class OsgRig {
public:
    explicit OsgRig(const Body& body);

    /// Poses the bones at a sample of the clip; not part of the measurement.
    void pose(std::size_t frame);
    /// The rig's parent.
    osgAnimation::Skeleton* skeleton() const { return _skeleton.get(); }
    /// Skins the vertices and normals.
    void update() { _rig->update(); }

    /// Largest distance of a skinned vertex from linear blending computed here; 0 if the rig works.
    double error(std::size_t frame) const;

private:
    const Body& _body;
    osg::ref_ptr<osgAnimation::Skeleton> _skeleton;
    osg::ref_ptr<osgAnimation::RigGeometry> _rig;
};

} // namespace bench

#endif
