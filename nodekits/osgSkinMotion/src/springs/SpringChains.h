// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// The motion of springs: tips of bones with inertia, which their joints carry.
///
/// A step follows the algorithm of VRMC_springBone, whose numbers are meant for 60 frames a second:
/// a tip keeps a part of its speed, gains speed towards its pose and by gravity, keeps its distance
/// from its joint, and is moved out of colliders. Here a frame has several steps, and what a tip
/// keeps and gains in a step is that of the step's share of 1/60 s.
///
/// The specification keeps the distance by a pull along the bone as it is after the frame. That
/// brakes the swing as much as gravity and stiffness do move it: at 60 frames a second most hair
/// would whip without it. Steps take the same part of the speed, by the pull in the step before.
///
/// A bone far shorter than the longest of its chain follows its parent: the least noise would turn
/// it by any angle.
///
/// All in metres and in one space: the world, or that of a centre.
class SpringChains {
public:
    struct Joint {
        int parent = -1; ///< the nearest joint above that swings, before this one; -1: none
        double stiffness = 0.0, drag = 0.0, radius = 0.0; ///< see SpringSettings::Joint
        glm::dvec3 gravity{0.0};
        std::vector<std::size_t> colliders; ///< indices in Frame::colliders
    };

    /// A bone in the pose without springs.
    struct Bone {
        glm::dvec3 head{0.0}, tip{0.0};
        glm::dquat axes{1.0, 0.0, 0.0, 0.0};
    };

    struct Collider {
        glm::dvec3 start{0.0}, end{0.0};
        double radius = 0.0; ///< negative: tips stay inside
    };

    struct Frame {
        std::vector<Bone> bones; ///< of each joint
        std::vector<Collider> colliders;
        glm::dquat fromWorld{1.0, 0.0, 0.0, 0.0}; ///< rotates gravity
    };

    struct State {
        std::size_t top = 0;        ///< the topmost joint of the chain
        glm::dvec3 frameSpeed{0.0}; ///< of a topmost joint, in the last frame
        bool isJump = false;        ///< of a topmost joint, as are the next two
        glm::dvec3 jumpFrom{0.0};
        glm::dquat jumpTurn{1, 0, 0, 0};
        double leastLength = 0.0; ///< of a bone that swings by itself
        double kept = 1.0;        ///< part of the speed, in a step
        double gainToPose = 0.0;  ///< of speed, as is `gain`
        glm::dvec3 gain{0.0};     ///< by gravity
        // After the last step:
        glm::dvec3 head{0.0}, headSpeed{0.0}, speed{0.0}; ///< of the joint, and of the tip
        double pull = 0.0;            ///< speed that the joint's pull along the bone has taken away
        glm::dvec3 bone{0.0};         ///< from the joint to the tip
        glm::dvec3 pose{0.0};         ///< its direction without its own swing
        glm::dquat swing{1, 0, 0, 0}; ///< from the pose without springs
    };

    /// \param joints with numbers of any value
    explicit SpringChains(std::vector<Joint> joints = {});

    /// Moves on to a frame; the first one begins at rest.
    /// \param seconds since the last frame
    /// \param maxRechecks how often in this frame a joint may look at one of its colliders again,
    ///        because another one has moved its tip
    /// \return false, and nothing changes, where a number is not finite
    bool move(const Frame& frame, double seconds, std::size_t maxRechecks = kMaxRechecks);

    /// How often joints looked at colliders in the last frame.
    std::size_t checks() const { return _checks; }
    std::size_t rechecks() const { return _rechecks; } ///< those after the first ones in each step

    static constexpr std::size_t kMaxRechecks = 1'000'000;

    /// Where the bones' tips are.
    const std::vector<glm::dvec3>& tips() const { return _tips; }
    /// Whether a bone is long enough to swing; the tip of one that follows its parent is its head.
    bool swings(std::size_t joint) const {
        const Bone& bone = _now.bones[joint];
        return glm::distance(bone.tip, bone.head) > _states[joint].leastLength;
    }

    // For files:
    const std::vector<State>& states() const { return _states; }
    const Frame& frame() const { return _now; } ///< the last one
    bool isMoving() const { return _isMoving; }
    /// Goes on from there in the next frame. All have as many entries as there are joints and
    /// colliders.
    /// \return false, and nothing changes, where a number is not finite or too large
    bool recall(const std::vector<State>& states, const std::vector<glm::dvec3>& tips,
                const Frame& frame);

private:
    void settle();
    void findLeastLengths();
    void carryOverJumps(double seconds, bool isPause);
    void prepare(double seconds, double leastDrag);
    void step(double share);
    glm::dvec3 outOfColliders(std::size_t joint, double length, glm::dvec3 tip, double share);

    std::vector<Joint> _joints;
    std::vector<State> _states;
    std::vector<glm::dvec3> _tips;
    Frame _before, _now;
    double _step = 0.0;     ///< seconds
    bool _isMoving = false; ///< after the first frame
    std::size_t _checks = 0, _rechecks = 0, _maxRechecks = kMaxRechecks;
};

} // namespace osgSkin
