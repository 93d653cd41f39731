// SPDX-License-Identifier: MIT
// The legs of a figure at rest.
#pragma once

#include <osgSkin/GlmTypes>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace osgSkin {

/// The part of a vector along the ground, in a space with Z up.
inline glm::dvec3 level(const glm::dvec3& v) {
    return {v.x, v.y, 0.0};
}

inline glm::dvec3 transformPoint(const glm::dmat4& matrix, const glm::dvec3& point) {
    return glm::dvec3(matrix * glm::dvec4(point, 1.0));
}
inline glm::dvec3 transformDirection(const glm::dmat4& matrix, const glm::dvec3& direction) {
    return glm::dmat3(matrix) * direction;
}

/// \param matrix rotation, even scale and shift
inline glm::dquat rotationOf(const glm::dmat4& matrix) {
    glm::dmat3 axes(matrix);
    for (int i = 0; i < 3; ++i) axes[i] = glm::normalize(axes[i]);
    return glm::normalize(glm::quat_cast(axes));
}

/// At rest, in a space with Z up.
struct RestLeg {
    std::size_t hip = 0, knee = 0, ankle = 0; ///< joints of the skeleton
    std::size_t toe = 0;                      ///< the ankle if no joint bends the toes
    glm::dvec3 ankleCentre{0.0}, ball{0.0};   ///< without a toe's joint, where it would be
    glm::dvec3 heel{0.0}, tip{0.0};           ///< the ends of the sole, see measureSoles()
};

struct RestLegs {
    std::array<RestLeg, 2> sides;       ///< left, right
    double length = 0.0;                ///< from hip to ankle, the mean of both
    glm::dvec3 forward{0.0, -1.0, 0.0}; ///< unit, level: where the toes are
};

/// Finds the legs by their joints' roles; not the soles.
///
/// \param rest the skeleton
/// \param roles of its joints
/// \param toLevel from rest space to the result's, rotation, even scale and shift
/// \param forward known; else the toes say it
/// \param user begins the message of an error
/// \throw osgSkin::Error where a joint is not recognised
RestLegs findLegs(const RestSkeleton& rest, const JointRoles& roles, const glm::dmat4& toLevel,
                  const std::optional<glm::dvec3>& forward, const std::string& user);

/// Finds `heel` and `tip` of both legs by the vertices of the rest pose.
///
/// \param character its skins and rigid parts
/// \param toLevel from rest space to that of the legs
/// \param legs as findLegs() gives them
void measureSoles(const ClipCharacter& character, const glm::dmat4& toLevel, RestLegs& legs);

} // namespace osgSkin
