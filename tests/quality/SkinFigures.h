// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef QUALITY_SKINFIGURES_H
#define QUALITY_SKINFIGURES_H

#include "Subject.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace quality {

/// Counts intersecting pairs of triangles, except those that intersect at rest.
class SelfIntersections {
public:
    explicit SelfIntersections(const Subject& subject);
    ~SelfIntersections();

    /// 0 if fewer pairs intersect than at rest.
    std::size_t beyondRest(const compare::Points& posed);

    /// The intersecting pairs as triangle indices, the smaller one first, sorted.
    std::vector<std::pair<std::size_t, std::size_t>> pairs(const compare::Points& posed);

private:
    struct Mesh;
    std::unique_ptr<Mesh> _mesh;
    std::size_t _atRest = 0;
};

/// Angles between a method's normals and those of the posed skin itself, degrees.
struct NormalError {
    double mean = 0.0, percentile95 = 0.0;
};

/// Over the vertices that the skin's triangles use.
NormalError normalError(const Subject& subject, const PosedSkin& posed);

/// Over those of `vertices` that the skin's triangles use.
NormalError normalError(const Subject& subject, const PosedSkin& posed,
                        const std::vector<std::uint32_t>& vertices);

/// How far limbs swell: the largest distance to the nearest posed bone over that to the nearest
/// rest bone, over the skin whose largest painted weight belongs to an upper arm, forearm, thigh or
/// shin.
class LimbBulge {
public:
    explicit LimbBulge(const Subject& subject);

    double of(const compare::Points& posed, const std::vector<glm::dmat4>& skinning) const;

private:
    const Subject& _subject;
    std::vector<std::uint32_t> _vertices;
    std::vector<compare::Segment> _bones; ///< at rest
    std::vector<std::size_t> _jointOfBone;
};

/// A point on an edge of the skin.
struct EdgePoint {
    std::uint32_t from, to;
    double share; ///< from the first vertex to the second
};

/// The loop in which a plane cuts the rest skin; if there are several, the one nearest to `centre`;
/// empty if the plane cuts nothing.
std::vector<EdgePoint> crossSection(const Subject& subject, const glm::dvec3& centre,
                                    const glm::dvec3& normal);

/// Cross-sections of a skin while a single joint rotates.
///
/// Each is measured twice. In the mesh's own section the points stay on their edges, so it also
/// shrinks when a coarse mesh's edges cut across a twist. In the method's section the points are
/// vertices with the mean ratios or weights of their edges' ends, as on an infinitely fine mesh.
class CrossSections {
public:
    /// \param subject the skin
    /// \param joint the only joint that will rotate
    /// \param loops the cross-sections at rest
    CrossSections(const Subject& subject, std::size_t joint,
                  const std::vector<std::vector<EdgePoint>>& loops);

    struct Least {
        double ofMethod = 1.0, ofMesh = 1.0; ///< smallest A'/A
    };
    /// `posed` is the whole skin, deformed by `method` under `skinning`.
    Least leastAreas(Method method, const std::vector<glm::dmat4>& skinning,
                     const compare::Points& posed) const;

private:
    std::vector<std::vector<std::uint32_t>> _loops; ///< of points
    std::vector<EdgePoint> _points;
    Subject _fine; ///< the points as vertices
};

/// Rigidity of the middle third of one limb: the mean share of the bend over its skin.
struct LimbRigidity {
    std::string limb;
    std::size_t vertices = 0;
    double own = 0.0, next = 0.0;               ///< ours: of the bone's own joint and of the next
                                                ///< one
    double paintedOwn = 0.0, paintedNext = 0.0; ///< the same for the painted weights
};

/// Upper arms, forearms, thighs and shins, left and right, if the rig has them. A limb's skin is
/// the skin whose largest painted weight belongs to its bone.
std::vector<LimbRigidity> measureRigidity(const Subject& subject);

/// The largest step of any vertex while one joint rotates by one degree, relative to a rigid arc:
/// the vertex's path if it followed the joint fully.
struct Sweep {
    double worst = 0.0;
    std::string joint; ///< with the largest step
};

struct Continuity {
    PerMethod<Sweep> bend, twist;
};

/// Rotates each joint alone over -179..179 degrees of bend, about two axes, and of twist.
Continuity measureContinuity(const Subject& subject);

/// The largest step of ours in bends, about four axes each, of the joints with corrective shapes.
Sweep measureShapedBends(const Subject& subject);

/// Properties of the binding itself.
struct BindFigures {
    /// Share of the vertices whose region is more than one joint away from the joint with the
    /// largest painted weight. Joints below a rigid one, and joints of no length, count as the one
    /// above.
    double farRegions = 0.0;
    double meanInfluences = 0.0; ///< joints that a vertex follows in part
    std::size_t mostInfluences = 0;
    double cappedShare = 0.0; ///< of the vertices
    double seconds = 0.0;
};

BindFigures measureBinding(const Subject& subject);

} // namespace quality

#endif
