// SPDX-License-Identifier: MIT
#pragma once

#include "springs/SpringChains.h"

#include <osg/Matrixd>

#include <string>
#include <vector>

namespace osgSkin {

/// The motion of springs, as files keep it.
struct SpringMemory {
    struct Bone {
        std::string name;
        osg::Matrixd base; ///< the bone's matrix before it swung
        SpringChains::State state;
        glm::dvec3 tip{0.0};
        SpringChains::Bone pose; ///< of the last frame
    };
    struct Group {
        std::vector<Bone> bones;
        std::vector<SpringChains::Collider> colliders; ///< of the last frame
    };
    std::vector<Group> groups;
};

} // namespace osgSkin
