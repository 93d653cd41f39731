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

/// Linear blend weights, for the software rig that we are compared with.
struct Weights {
    using Vertex = std::vector<std::pair<std::uint32_t, float>>; ///< (joint, weight), by joint
    std::string name;
    std::vector<Vertex> vertices;

    /// Vertices with the same joints and weights share a group; a rig's cost is their number.
    std::size_t groupCount() const;
};

/// The hand-painted weights of a MakeHuman file; empty where it is not there.
Weights readPaintedWeights(const std::string& file, const std::vector<osgSkin::BoundJoint>& joints,
                           std::size_t vertices);

/// Weights that say the same as our own ratios: a joint's less those of its children.
Weights weightsFromRatios(const osgSkin::Binding& binding);

Weights blend(const Weights& weights, const std::vector<Blend>& vertices);

/// A whole body (no rigid parts) in one motion, as finely meshed as asked for.
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

    /// Mean number of joints that a vertex follows in part: what the deformation's cost depends on.
    double partialPerVertex() const;
};

/// What a body is bound with: normals that turn with their vertices, those of the deformed surface,
/// and with those the shapes "fast".
enum class Kind { Turned, Surface, Shaped };

/// body4k_neutral in a walk where the third-party data is there, else our own thrower.
/// `parts` splits every edge (Subdivide.h); ratios, weights and normals are interpolated.
/// Made once for each kind and kept.
const Body& body(std::uint32_t parts, Kind kind = Kind::Turned);

/// The body under osgAnimation's own software rig.
class OsgRig {
public:
    explicit OsgRig(const Body& body);

    /// Puts the bones into a sample of the clip; not part of what is measured.
    void pose(std::size_t frame);
    /// The rig stands below it.
    osgAnimation::Skeleton* skeleton() const { return _skeleton.get(); }
    /// Skins the vertices and normals.
    void update() { _rig->update(); }

    /// Largest distance of a skinned vertex from linear blending worked out here: 0 where the rig
    /// does what it is measured for.
    double error(std::size_t frame) const;

private:
    const Body& _body;
    osg::ref_ptr<osgAnimation::Skeleton> _skeleton;
    osg::ref_ptr<osgAnimation::RigGeometry> _rig;
};

} // namespace bench

#endif
