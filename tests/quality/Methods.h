// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <array>

namespace quality {

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

/// The posed skin, one point for each vertex of the mesh.
/// \param skinning G_j = bone matrix * inverse bind matrix for each joint of the rig
compare::Points deform(const Subject& subject, Method method,
                       const std::vector<glm::dmat4>& skinning);

/// The same with normals. Those of linear blending are turned by the blended matrix, as renderers
/// do.
PosedSkin deformWithNormals(const Subject& subject, Method method,
                            const std::vector<glm::dmat4>& skinning);

/// Joint `joint` alone turned about its centre, with all that hangs on it; radians.
std::vector<glm::dmat4> singleTurn(const Subject& subject, std::size_t joint,
                                   const glm::dvec3& axis, double angle);

} // namespace quality
