// SPDX-License-Identifier: MIT
#pragma once

#include "../PaintedBody.h"

#include <glm/vec3.hpp>

#include <map>
#include <string>

namespace quality {

/// Other bodies made of a body: the same faces and painted weights, its skin and joints elsewhere.

/// `from` moved on by `t` of the way to `to`: 0 is the one, 1 the other, and beyond both.
/// \pre both have the same faces and the same joints
PaintedBody blended(const PaintedBody& from, const PaintedBody& to, double t);

/// The skin moved out by `distance`, negative in, along normals that are smoothed so that creases
/// do not cross. Head, hands and feet take a fifth of it. The joints stay.
PaintedBody thickened(PaintedBody body, double distance);

/// Hollows and bumps: the skin moved along its normals by up to `depth`, in waves of `length`.
/// Head, hands and feet take a fifth of it.
PaintedBody uneven(PaintedBody body, double depth, double length);

/// How a bone's skin is scaled along the bone and across it.
struct BoneScale {
    double length = 1.0, girth = 1.0;
};

/// Bones of other proportions, by the names of their joints, which may stand for both sides: "Arm"
/// is "LeftArm" and "RightArm". What hangs on a bone moves with its end. Joints that are not named
/// take the girth of none and keep their length.
PaintedBody proportioned(const PaintedBody& body, const std::map<std::string, BoneScale>& bones);

/// Another rest pose, by linear blending with the painted weights: each named joint turned about x,
/// y and z through its centre, degrees, x first. The name of a side's joint without its side turns
/// both as mirror images, by the left one's angles.
PaintedBody standing(const PaintedBody& body, const std::map<std::string, glm::dvec3>& turns);

/// Each triangle made four, with the new vertices in the middle of the edges.
PaintedBody subdivided(const PaintedBody& body);

} // namespace quality
