// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_SOLVEELASTIC_H
#define OSGSKINBINDER_ELASTIC_SOLVEELASTIC_H

#include <osgSkinBind/Progress>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgSkin {

/// A welded skin in rest space: triangles that touch share vertices. It may be open and have
/// several shells. Only references the arrays.
struct ElasticSkin {
    const std::vector<glm::dvec3>& positions;
    const std::vector<std::array<std::uint32_t, 3>>& triangles;
};

/// A bone near a joint, rest space.
struct ElasticBone {
    glm::dvec3 from{0.0}, to{0.0};
    bool moves = false; ///< with the joint, not with its parent
};

/// A joint whose flesh is solved as an elastic solid.
struct ElasticJoint {
    /// Radius of the solid, in radii of the limb. At a hinge's deepest bend, flesh meets beyond
    /// four.
    static constexpr double kHingeReach = 5.0, kBallReach = 4.0;

    std::string name;
    glm::dvec3 centre{0.0}; ///< rest space
    double radius = 0.0;    ///< r, of the limb at the joint; above 0
    bool hinge = false;     ///< elbow or knee: has a core that rotates by half the angle
    /// Bones of the skeleton; those out of reach are ignored.
    std::vector<ElasticBone> bones;
    /// The joint's bend ratio at each vertex of the skin, 0..1.
    std::vector<double> ratios;
    /// Rotations of the joint to solve for: rest space, about the centre, without twist.
    std::vector<glm::dquat> samples;
};

/// The elastic solid at one rotation of the joint.
struct ElasticSample {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    /// Empty if the shape is good. Otherwise why it must not be fitted: cells invert or the solid
    /// intersects itself; then `positions` is the best shape found, or empty.
    std::string reason;
    std::vector<glm::dvec3> positions; ///< of ElasticShapes::vertices, rest space, parent at rest

    int steps = 0; ///< of the minimiser, from the previous sample
    /// Pairs of intersecting triangles within reach beyond those at rest, and, where they are not
    /// few, those of the plain skin.
    std::size_t crossings = 0, plainCrossings = 0;
    double leastJacobian = 0.0; ///< smallest volume ratio at a Gauss point; above 0
    double volumeRatio = 0.0;   ///< of all flesh, posed over rest
    double seconds = 0.0;       ///< of the thread that solved it
};

/// The result of solveElasticJoint().
struct ElasticShapes {
    std::string joint;
    std::string reason; ///< empty if solved; otherwise why not, and the members below are not set

    std::vector<std::uint32_t> vertices; ///< of the skin, within reach; ascending
    std::vector<glm::dvec3> rest;        ///< their rest positions
    double reach = 0.0;                  ///< from the joint's centre to the pinned rim
    /// Those of ElasticJoint::samples, then additional ones at smaller bends that replace bad ones.
    std::vector<ElasticSample> samples;
    std::size_t cells = 0, nodes = 0; ///< of the lattice
    double seconds = 0.0;             ///< the sum of its samples'
};

/// The range and rest pose of a hinge, radians.
struct HingeRange {
    glm::dvec3 axis{1.0, 0.0, 0.0}; ///< unit; a rotation by a positive angle flexes
    double restFlexion = 0.0;       ///< total flexion in the rest pose: 0 is a straight limb
    double leastFlexion = 0.0;      ///< of the anatomical range
    double mostFlexion = 0.0;
};

/// The rotations to solve a hinge at: at most 15 degrees apart from the rest pose to both ends of
/// its range, which are included (otherwise self-intersections return there), and a few sideways
/// bends.
/// \param pole unit; from the joint to its child. All axes are perpendicular to it
std::vector<glm::dquat> hingeSamples(const HingeRange& range, const glm::dvec3& pole);

/// The rotations to solve a ball joint at: angles at most 30 degrees apart in each of eight
/// directions.
/// \param pole unit; from the joint to its child
/// \param across unit, perpendicular to the pole: the first direction's axis
/// \param most the largest angle, radians
std::vector<glm::dquat> ballSamples(const glm::dvec3& pole, const glm::dvec3& across, double most);

/// Finds the shapes of the flesh around a joint by an elastic solid of voxel cells, a third of the
/// limb's radius wide, with bones as soft cores and contact in the fold. Its rim is pinned to the
/// plain skin's shape. Deterministic on any number of threads.
///
/// Failures are reported in ElasticShapes::reason and ElasticSample::reason.
///
/// \param joint has a ratio for each of the skin's vertices
/// \param progress called after each sample, from the calling thread; its exceptions propagate
/// \return the shapes at the joint's samples
ElasticShapes solveElasticJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                                const Progress& progress = {});

/// The same for several joints, on all processors if oneTBB is built in. Of two joints that mirror
/// each other, with skin and bones, one is solved, and its shapes are mirrored for the other, which
/// has no progress of its own.
std::vector<ElasticShapes> solveElasticJoints(const ElasticSkin& skin,
                                              const std::vector<ElasticJoint>& joints,
                                              const Progress& progress = {});

} // namespace osgSkin

#endif
