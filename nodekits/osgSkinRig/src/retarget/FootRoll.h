// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/DrivenRig.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Rotates feet right side up that a motion rolls over.
///
/// How a foot is rolled about its own length hangs on one or two markers, and some clips have it
/// upside down for seconds, the toes still pointing where they should. An ankle can't do that, and
/// skin that follows wrings. A roll past 90 degrees from the shin's is taken back from there: 100
/// becomes 80, 180 becomes 0; so nothing jumps, and the toes point where they did.
class FootRoll {
public:
    /// \param body the rig and its motion; it must outlive this
    /// \param alignment for each rig joint, from its rest bone to the motion's
    FootRoll(const DrivenRig& body, const std::vector<glm::dquat>& alignment);

    /// Takes back what the feet roll too far, and rotates what hangs on them along.
    /// \param world rotations of the rig's joints from rest, one for each
    void straighten(std::vector<glm::dquat>& world);

    /// In how many poses a joint was rolled over so far; 0 for one that is no foot.
    std::size_t rolledOver(std::size_t joint) const { return _rolledOver[joint]; }

private:
    struct Foot {
        int joint;
        glm::dvec3 length; ///< unit, at rest: what the motion's foot points along
    };
    void rotate(int joint, const glm::dquat& by, std::vector<glm::dquat>& world) const;

    const SkeletonTree& _rig;
    std::vector<Foot> _feet;
    std::vector<std::size_t> _rolledOver; ///< [joint]
};

} // namespace osgSkin
