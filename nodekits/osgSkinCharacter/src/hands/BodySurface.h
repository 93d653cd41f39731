// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hands/SkinPoints.h"

#include <osgSkin/GlmTypes>

#include <vector>

namespace osgSkin {

/// Where joints are in a pose, skeleton space.
struct PosedJoints {
    std::vector<glm::dvec3> rest;      ///< their centres at rest
    std::vector<glm::dquat> rotations; ///< away from rest
    std::vector<glm::dvec3> centres;

    /// Where a point of the rest pose is, that moves with `joint`.
    glm::dvec3 place(const glm::dvec3& point, std::size_t joint) const {
        return centres[joint] + rotations[joint] * (point - rest[joint]);
    }
};

/// A closed piece of a body (trunk, head, thigh) as an implicit surface through points of its skin:
/// moving least squares with planes, "IMLS" (Shen, O'Brien, Shewchuk 2004; Kolluri 2005). It
/// follows its points as joints move them, and is smooth whatever they do.
class BodySurface {
public:
    /// How deep a point is, and which way leads out.
    struct Depth {
        double depth = 0.0;  ///< positive inside
        glm::dvec3 out{0.0}; ///< at most unit length; short where all ways out are as far
    };

    /// \param points of the whole piece, one at least
    explicit BodySurface(SkinPoints points);

    /// Moves the points.
    void pose(const PosedJoints& joints);

    /// Whether `place` is so near that depth() means something: within the ball around all points,
    /// wider by `margin`. What is farther away is outside.
    bool isNear(const glm::dvec3& place, double margin) const;

    /// How deep `place` is in the piece as it is posed.
    Depth depth(const glm::dvec3& place) const;

private:
    SkinPoints _points;
    double _softening = 0.0; ///< square of a length
    std::vector<glm::dvec3> _places, _normals;
    glm::dvec3 _centre{0.0};
    double _radius = 0.0;
};

} // namespace osgSkin
