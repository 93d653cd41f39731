// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/Pose>
#include <osgSkinCharacter/Character>

#include <glm/vec3.hpp>

#include <vector>

namespace bake {

/// The posed body in the input mesh's own vertex order, put together from the drawables that a
/// viewer would show: deformed skins and rigid parts.
struct PosedMesh {
    std::vector<glm::dvec3> positions; ///< rest space
    std::vector<glm::dvec3> normals;   ///< unit; the mean over a vertex's drawn copies
    double seamGap = 0.0;              ///< largest distance between two copies of a vertex

    /// Reads the character's drawables in the pose that their bones are in now.
    static PosedMesh read(const osgSkin::Character& character);

    /// The same in the bind pose, whatever pose the bones are in.
    static PosedMesh rest(const osgSkin::Character& character);
};

/// The joints' transforms in the pose that the character's bones are in now.
osgSkin::Pose currentPose(const osgSkin::Character& character);

} // namespace bake
