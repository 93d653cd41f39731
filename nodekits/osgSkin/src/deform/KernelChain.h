// SPDX-License-Identifier: MIT
#pragma once

#include "deform/DeformKernel.h"

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// Works out the groups' constants for one pose, group after group, on the stack.
///
/// Groups are sorted by their links, so neighbours share the outer ones: what those give is kept,
/// and each group costs only the links in which it differs from the group before it. What a joint
/// gives whatever its group is worked out once.
class KernelChain {
public:
    KernelChain(const SkinModel& model, const Pose& pose) noexcept;
    KernelChain(const KernelChain&) = delete; // its states point at each other
    KernelChain& operator=(const KernelChain&) = delete;

    /// Sets the constants of `call` for a group; they are good until the next call.
    void prepare(const SkinModel::Group& group, KernelCall& call) noexcept;

private:
    /// x -> scale * turn x + move. Not set where nothing is known: there are many of them.
    struct Map {
        Map() = default;
        Map(const glm::dmat3& t, const glm::dvec3& m, double s) noexcept
            : turn(t), move(m), scale(s) {}

        glm::dmat3 turn;
        glm::dvec3 move;
        double scale;
    };

    /// What a joint gives in any chain.
    struct Joint {
        Map full;
        Map intoFrame; ///< its partial turn's frame, about the joint centre
        glm::dmat3 frame;
        double bend, twist;
        double azimuthCosine, azimuthSine; ///< of v in the joint's fixed frame
        double move[3], growth;            ///< in the frame
        bool adjusted;                     ///< these are not 0
    };
    static constexpr std::size_t kMostJoints = 128; ///< more are worked out again and again

    /// State behind a link: the full turns since the last partial one, multiplied out, into that
    /// one's frame. Beyond kKept links nothing is kept, only carried along.
    struct State {
        const Map* map; ///< a joint's, or `own`
        Map own;
        std::uint32_t partialCount;
    };
    static constexpr std::size_t kKept = 48;

    const Joint& joint(std::uint32_t index) noexcept;
    void workOut(std::uint32_t index, Joint& joint) const noexcept;
    std::size_t sharedLinks(const SkinModel::Group& group) const noexcept;
    void append(const SkinModel::Link& link, const State& before, State& state) noexcept;

    const SkinModel& _model;
    const Pose& _pose;
    const SkinModel::Group* _last = nullptr;
    std::array<State, kKept + 2> _states; ///< behind as many links; the last: beyond kKept
    std::array<KernelLink, SkinModel::kMaxPartialInfluences> _links;
    KernelMap _lead;
    std::bitset<kMostJoints> _known;
    std::array<Joint, kMostJoints + 1> _joints; ///< the last: the one worked out last
};

} // namespace osgSkin
