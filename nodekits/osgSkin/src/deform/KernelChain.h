// SPDX-License-Identifier: MIT
#pragma once

#include "deform/DeformKernel.h"

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace osgSkin {

/// Works out the groups' constants for one pose, group after group, on the stack.
///
/// Groups are sorted by their links, so neighbours share the outer ones: what those give is kept,
/// and each group costs only the links in which it differs from the group before it.
class KernelChain {
public:
    KernelChain(const SkinModel& model, const Pose& pose) noexcept : _model(model), _pose(pose) {}

    /// Sets the constants of `call` for a group; they are good until the next call.
    void prepare(const SkinModel::Group& group, KernelCall& call) noexcept;

private:
    /// x -> scale * turn x + move.
    struct Map {
        glm::dmat3 turn{1.0};
        glm::dvec3 move{0.0};
        double scale = 1.0;
    };

    /// State behind a link: the full turns since the last partial one, multiplied out, into that
    /// one's frame. Beyond kKept links nothing is kept, only carried along.
    struct State {
        Map map;
        std::uint32_t partialCount = 0;
    };
    static constexpr std::size_t kKept = 48;

    std::size_t sharedLinks(const SkinModel::Group& group) const noexcept;
    void append(const SkinModel::Link& link, State& state) noexcept;

    const SkinModel& _model;
    const Pose& _pose;
    const SkinModel::Group* _last = nullptr;
    std::array<State, kKept + 1> _states;
    std::array<KernelLink, SkinModel::kMaxPartialInfluences> _links;
    KernelMap _lead;
};

} // namespace osgSkin
