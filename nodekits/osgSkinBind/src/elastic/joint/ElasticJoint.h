// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_ELASTICJOINT_H
#define OSGSKINBIND_ELASTIC_ELASTICJOINT_H

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace osgSkin {

/// A bone near a joint, rest space.
struct ElasticBone {
    glm::dvec3 from{0.0}, to{0.0};
    bool moves = false; ///< with the joint; else it stays with the joint's parent
};

/// A joint whose surroundings are to be solved as an elastic solid.
struct ElasticJoint {
    /// How far the solid reaches, in radii. Where a hinge is bent most, flesh meets flesh beyond
    /// four.
    static constexpr double kHingeReach = 5.0, kBallReach = 4.0;

    std::string name;
    glm::dvec3 centre{0.0}; ///< rest space
    double radius = 0.0;    ///< r, of the limb at the joint; above 0
    bool hinge = false;     ///< elbow, knee: a core at the joint turns by half the angle
    /// All bones of the skeleton; those out of reach do no harm.
    std::vector<ElasticBone> bones;
    /// The joint's bend ratio at each vertex of the skin, 0..1.
    std::vector<double> ratios;
    /// The joint's own rotations to solve for: rest space, about the centre, without twist.
    std::vector<glm::dquat> samples;
};

} // namespace osgSkin

#endif
