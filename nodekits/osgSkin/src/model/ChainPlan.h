// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Which maps the chains of a model's groups consist of, and how a pose makes them: each once,
/// whatever groups it is in.
///
/// A group's chain, outermost first, is a map, a partial turn, a map, a partial turn, ... Each map
/// starts in rest space or in the frame of the partial joint before, goes through the full turns
/// between, and ends in the frame of the next partial joint; what is behind the last one ends in
/// rest space. Groups that begin alike share all that.
///
/// Sections hold as much as fits on a stack; a body has one.
struct ChainPlan {
    using Index = std::uint16_t;

    static constexpr std::size_t kMostJoints = 96;
    static constexpr std::size_t kMostStates = 128;
    static constexpr std::size_t kMostOuts = 192;
    static_assert(kMostOuts > SkinModel::kMaxPartialInfluences &&
                  kMostJoints > SkinModel::kMaxPartialInfluences);

    /// What maps are told by: the identity, what joints give, states, which are products of those.
    static constexpr Index kIdentity = 0;
    /// A joint's whole turn.
    static constexpr Index full(std::size_t joint) { return static_cast<Index>(1 + 3 * joint); }
    /// From the frame of its partial turn to rest space.
    static constexpr Index frame(std::size_t joint) { return static_cast<Index>(2 + 3 * joint); }
    /// Back into that.
    static constexpr Index into(std::size_t joint) { return static_cast<Index>(3 + 3 * joint); }
    static constexpr Index kFirstState = 1 + 3 * kMostJoints;
    static constexpr std::size_t kMaps = kFirstState + kMostStates;

    /// A map: first `with`, then `from`.
    struct Step {
        Index from;
        Index to;           ///< a state, or which of the outs
        bool isOut;         ///< the kernel reads it
        std::uint32_t with; ///< or kUncached and a joint of the model
    };
    /// More joints than fit: worked out where it is needed.
    static constexpr std::uint32_t kUncached = 1u << 31;

    /// A partial joint of a group's chain.
    struct Link {
        Index joint; ///< of the section
        Index out;   ///< from its frame outwards
    };
    struct Group {
        std::uint32_t firstLink; ///< in `links`, outermost first
        Index lead;              ///< an out, applied first; kNoLead where the innermost is partial
    };
    static constexpr Index kNoLead = 0xffff;

    struct Section {
        std::uint32_t endGroup;
        std::uint32_t firstStep, endStep;
        std::uint32_t firstJoint, jointCount; ///< in `joints`
    };

    explicit ChainPlan(const SkinModel& model);

    std::vector<Section> sections; ///< in the groups' order
    std::vector<Group> groups;     ///< the model's
    std::vector<Link> links;
    std::vector<Step> steps;
    std::vector<std::uint32_t> joints; ///< of the model
    /// Every section's joints are the model's: numbers, and nothing is gathered.
    bool inOrder;
};

} // namespace osgSkin
