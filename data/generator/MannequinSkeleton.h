// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace mannequin {

/// One joint of the mannequin in its rest pose.
///
/// World space: metres, Y up, facing +Z, left is +X, the floor is y = 0.
struct RestJoint {
    std::string name;   ///< CMU motion-capture name ("LeftForeArm")
    int parent;         ///< index of the parent joint, -1 for the root
    glm::dvec3 centre;  ///< joint centre
    glm::dvec3 endSite; ///< tip of the bone; meaningful for leaf joints only
    bool leaf;          ///< true if the joint has no child and ends in `endSite`
};

/// The skeleton of a standing man, 1.80 m tall; parents precede children.
///
/// Segment lengths follow Drillis & Contini (1966) as tabulated by D. A. Winter, *Biomechanics and
/// Motor Control of Human Movement*, 4th ed. (2009), fig. 4.1, as fractions of the stature: ankle
/// 0.039 to 0.042, knee 0.285, hip 0.52, upper arm 0.172 to 0.186, forearm 0.146, hand 0.108, foot
/// 0.152. The arms rest 40 degrees below the horizontal, which is the middle of the shoulder's
/// range.
std::vector<RestJoint> restSkeleton();

} // namespace mannequin
