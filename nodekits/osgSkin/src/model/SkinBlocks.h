// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>
#include <osgSkin/SkinTangents>

#include <glm/mat3x3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// What rounding errors are taken as: their products would be denormal numbers, which processors
/// are many times slower with.
inline float roundedToFloat(double x) {
    return static_cast<float>(std::fabs(x) < 1e-15 ? 0.0 : x);
}

/// x -> turn x + move, in single precision, as the kernel reads it: columns of the turn, then the
/// move. Behind that by how much positions are to be scaled before.
struct alignas(64) KernelMap {
    float column[4][4];

    const float& turn(std::size_t row, std::size_t at) const { return column[at][row]; }
    const float& move(std::size_t row) const { return column[3][row]; }
    const float& scale() const { return column[3][3]; }
};

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

/// Vertices a block holds; a multiple of every vector's number of floats.
constexpr std::size_t kBlock = 16;

/// One number of each vertex of a block.
struct alignas(64) BlockRow {
    float lane[kBlock];
};

/// A SkinModel's vertices as the kernel reads them: structure of arrays, group after group, each
/// group padded to whole blocks with zeros.
///
/// A block is rowsPerBlock(n) rows for n partial links: position x, y, z, normal x, y, z, then the
/// bend and twist ratio of each partial link, innermost (applied first) first. Where a group's
/// innermost link is a partial one, positions and normals are in that joint's fixed frame
/// (jointFrame()), which spares the kernel the change of frame; else in rest space.
struct SkinBlocks {
    /// A group as the kernel reads it: side by side, since an update finds none of it in the
    /// processor's nearest cache.
    struct Group {
        std::size_t firstRow; ///< of its first block, in `rows`
        std::uint32_t firstBlock;
        std::uint32_t firstVertex; ///< in the model's order()
        std::uint32_t vertexCount;
        std::uint32_t firstLink; ///< in the plan's links
        std::uint32_t frame;     ///< the joint that its blocks are in the frame of, or kRestFrame
        ChainPlan::Index lead;   ///< ChainPlan::Group's
        std::uint16_t linkCount; ///< partial ones
    };
    static constexpr std::uint32_t kRestFrame = ~0u;

    explicit SkinBlocks(const SkinModel& model);

    static std::size_t rowsPerBlock(std::size_t partialCount) { return 6 + 2 * partialCount; }

    /// SkinTangents has blocks of its own: x, y, z in the same frame, and the handedness.
    static constexpr std::size_t kTangentRows = 4;

    ChainPlan plan;
    std::vector<BlockRow> rows;
    std::vector<Group> groups;                 ///< the model's
    std::vector<std::size_t> firstBlock = {0}; ///< of each group; then the number of all blocks
    std::vector<glm::dmat3> jointFrames;       ///< jointFrame() of each joint
    bool inOrder; ///< the model's order() is the identity: output needs no scatter
    /// A joint's translation up to this is a rounding error: bones' offsets are single precision in
    /// most files and in osgAnimation, their bind matrices need not be.
    double smallMove;
};

/// True where the group's innermost link is partial, so that its blocks are in a joint's frame.
inline bool isInJointFrame(const SkinModel& model, const SkinModel::Group& group) {
    return group.linkCount > 0 && model.links()[group.firstLink + group.linkCount - 1].partial;
}

/// e1, e2, w: any two directions that make a right-handed frame with the twist axis w.
glm::dmat3 jointFrame(const BoundJoint& joint);

/// The axes, in rest space and as columns, of the frame that a group's blocks are in.
glm::dmat3 restFrame(const SkinModel& model, const SkinModel::Group& group);

/// A bound vertex's influence by a joint; null where it has none.
///
/// \param binding valid
/// \param vertex of the binding
/// \param joint of the binding
const Influence* influenceOf(const Binding& binding, std::uint32_t vertex, std::uint32_t joint);

/// What the deformation reads of a model and its tangents, and no application needs.
struct SkinModelAccess {
    /// The vertices as DeformJob's fast path reads them.
    static const SkinBlocks& blocks(const SkinModel& model) { return *model._blocks; }

    /// What computePoseBounds() poses; null for a skin without vertices.
    static const BoundsProxy* boundsProxy(const SkinModel& model) {
        return model._boundsProxy.get();
    }

    /// The correctives as DeformJob reads them; null where there are none.
    static const CorrectiveBlocks* correctives(const SkinModel& model) {
        return model._correctives.get();
    }

    /// The ratios' gradients as DeformJob reads them; null where there are none.
    static const GradientBlocks* gradients(const SkinModel& model) {
        return model._gradients.get();
    }

    /// The tangents, SkinBlocks::kTangentRows rows for each of the model's blocks.
    static const BlockRow* blocks(const SkinTangents& tangents) { return tangents._rows.data(); }

    /// Gives `empty`, which a reader of files had to make first, all that `model` holds.
    static void fill(SkinModel& empty, const SkinModel& model) {
        empty._joints = model._joints;
        empty._positions = model._positions;
        empty._normals = model._normals;
        empty._order = model._order;
        empty._groups = model._groups;
        empty._links = model._links;
        empty._ratios = model._ratios;
        empty._blocks = model._blocks;
        empty._boundsProxy = model._boundsProxy;
        empty._correctives = model._correctives;
        empty._gradients = model._gradients;
    }
};

} // namespace osgSkin
