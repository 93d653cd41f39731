// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/BoneReader>
#include <osgSkin/Pose>
#include <osgSkinCharacter/Character>

#include <glm/vec3.hpp>

#include <vector>

namespace bake {

/// The posed body in the vertex order of the input mesh, assembled from the drawables that a viewer
/// shows: deformed skins and rigid parts.
struct PosedMesh {
    std::vector<glm::dvec3> positions; ///< rest space
    std::vector<glm::dvec3> normals;   ///< unit; the mean over a vertex's drawn copies
    double seamGap = 0.0;              ///< largest distance between two copies of a vertex

    /// Reads the character's drawables in the current pose of the bones.
    static PosedMesh read(const osgSkin::Character& character);

    /// The same in the bind pose, regardless of the bones.
    static PosedMesh rest(const osgSkin::Character& character);
};

/// Sets a pose to that of the bones and the inputs of correctives. Twists continue those that it
/// has.
void readPose(const osgSkin::Character& character, const osgSkin::BoneReader& reader,
              osgSkin::Pose& pose);

/// The joints' transforms in the current pose of the character's bones.
osgSkin::Pose currentPose(const osgSkin::Character& character);

} // namespace bake
