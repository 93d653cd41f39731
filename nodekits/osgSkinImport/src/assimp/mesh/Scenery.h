// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENERY_H
#define OSGSKINIMPORT_SCENERY_H 1

#include "assimp/SceneBind.h"

#include <glm/vec3.hpp>

namespace osgSkin {

/// Tells what stands beside a figure in its file (a floor, a sky, a stand) from what belongs to it
/// and was not skinned (eyes, hair): it is apart from all skins, or half as large again.
class Scenery {
public:
    Scenery(const aiScene& scene, const SceneBind& bind);

    /// Whether one of a node's meshes is scenery. Never where the scene has no skin.
    /// \param mesh without bones, that hangs on no joint
    bool has(const aiNode& node, unsigned mesh) const;

private:
    struct Box {
        glm::dvec3 low{0.0}, high{0.0};
        bool valid = false;

        double size() const;
    };
    Box boxOf(const aiNode& node, unsigned mesh) const;

    const aiScene& _scene;
    const SceneBind& _bind;
    Box _skins;
};

} // namespace osgSkin

#endif
