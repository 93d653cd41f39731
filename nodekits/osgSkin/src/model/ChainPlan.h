// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// What the maps between rest space and the frame (v, w x v, w) about a joint's centre, which its
/// partial turn is in, are made of: the joint's fixed frame, behind each axis a 0. v is at an
/// azimuth from e1 to e2.
struct alignas(64) PlannedFrame {
    float e1[4], e2[4], w[4];
    std::uint32_t joint; ///< of the section
};

/// The way into it in double precision: each number is constant + cosine * byCosine + sine * bySine
/// of the azimuth. Columns of four numbers, as KernelMap.
struct alignas(64) PlannedWideInto {
    double byCosine[16], bySine[16], constant[16];
    std::uint32_t joint; ///< of the section
};

/// Which maps the chains of a model's groups consist of, and how a pose makes them: each once,
/// whatever groups it is in.
///
/// A group's chain, outermost first, is a map, a partial turn, a map, a partial turn, ... Each map
/// starts in rest space or in the frame of the partial joint before, goes through the full turns
/// between, and ends in the frame of the next partial joint; what is behind the last one ends in
/// rest space. Groups that begin alike share all that.
///
/// Full turns are multiplied out in double precision: there may be many of them, about places far
/// apart. What the kernel reads are single numbers, and so is what goes once into a frame or out of
/// one.
///
/// Sections hold as much as fits on a stack; a body has one.
struct ChainPlan {
    using Index = std::uint16_t;

    static constexpr std::size_t kMostJoints = 96;
    static constexpr std::size_t kMostStates = 128;
    static constexpr std::size_t kMostOuts = 192;
    static_assert(kMostOuts > SkinModel::kMaxPartialInfluences &&
                  kMostJoints > SkinModel::kMaxPartialInfluences);

    /// What maps are told by: the identity, ways into joints' frames, and those ways back, or, in
    /// double precision, states, which are products of a way into a frame and full turns.
    static constexpr Index kIdentity = 0;
    static constexpr Index into(std::size_t joint) { return static_cast<Index>(1 + joint); }
    static constexpr Index state(std::size_t number) {
        return static_cast<Index>(1 + kMostJoints + number);
    }
    static constexpr Index frame(std::size_t joint) {
        return static_cast<Index>(1 + kMostJoints + joint);
    }
    /// A state in single precision. Moves in single precision are told of a place of each map's
    /// own; into() moves that to 0.
    static constexpr Index narrowed(std::size_t number) {
        return static_cast<Index>(1 + 2 * kMostJoints + number);
    }
    static constexpr std::size_t kWideMaps = 1 + kMostJoints + kMostStates;
    static constexpr std::size_t kMaps = 1 + 2 * kMostJoints + kMostOuts;

    /// In double precision: first the full turn of a joint, then `from`.
    struct State {
        Index from, to;
        Index narrowed;      ///< where it is put in single precision, too; kIdentity: nowhere
        Index narrowedLead;  ///< the same for leads
        std::uint32_t joint; ///< of the section, or kUncached and one of the model
        /// What `narrowed` moves is told of this place, near to what follows: digits of places far
        /// away would be lost. Rest space; `narrowedLead` is told of the origin.
        std::array<double, 3> about;
    };
    /// More joints than fit: worked out where it is needed.
    static constexpr std::uint32_t kUncached = 1u << 31;

    /// What the kernel reads, in single precision: first `with`, then `from`.
    struct alignas(16) Out {
        float move[4]; ///< `with` starts from here, as seen from where `from` is told of; and 1
        Index from, with;
    };

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

    /// The first ones of a section; the next section's are behind its last ones.
    struct Section {
        std::uint32_t group;
        std::uint32_t joint; ///< in `joints`
        std::uint32_t frame, wideInto, state, out;
    };

    explicit ChainPlan(const SkinModel& model);

    std::vector<Section> sections; ///< in the groups' order, and one behind the last
    std::vector<Group> groups;     ///< the model's
    std::vector<Link> links;
    std::vector<std::uint32_t> joints;      ///< of the model
    std::vector<std::int32_t> arePartial;   ///< of `joints`, somewhere; 0 or 1, and some 0 behind
    std::vector<PlannedFrame> frames;       ///< of joints that are partial somewhere
    std::vector<PlannedWideInto> wideIntos; ///< of those that full turns come behind
    std::vector<State> states;
    std::vector<Out> outs;
    /// Every section's joints are the model's: numbers, and nothing is gathered.
    bool inOrder;
};

} // namespace osgSkin
