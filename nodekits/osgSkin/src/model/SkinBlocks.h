// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>
#include <osgSkin/SkinTangents>

#include <glm/mat3x3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace osgSkin {

/// Rounds to a float, and rounding errors to 0: their products would be denormal numbers, which are
/// many times slower.
inline float roundedToFloat(double x) {
    return static_cast<float>(std::fabs(x) < 1e-15 ? 0.0 : x);
}

/// x -> turn x + move, as the kernel reads it: columns of the rotation, then the translation and,
/// as last number, a scale to be applied before.
struct alignas(64) KernelMap {
    float column[4][4];

    const float& turn(std::size_t row, std::size_t at) const { return column[at][row]; }
    const float& move(std::size_t row) const { return column[3][row]; }
    const float& scale() const { return column[3][3]; }
};

/// A joint's fixed frame e1, e2, w, padded with zeros. A joint rotates vertices in part in the
/// frame (v, w x v, w) about its centre, where the bend axis v is at an azimuth from e1 towards e2.
struct alignas(64) PlannedFrame {
    float e1[4], e2[4], w[4];
    std::uint32_t joint; ///< of the section
};

/// The map from rest space to that frame, in double precision: constant + cosine * byCosine + sine
/// * bySine of the azimuth. Columns of four numbers, as KernelMap.
struct alignas(64) PlannedWideInto {
    double byCosine[16], bySine[16], constant[16];
    std::uint32_t joint; ///< of the section
};

/// The maps in the chains of a model's groups, and how to compute them for a pose, each once.
///
/// A group's chain, outermost first, is a map, a partial rotation, a map, a partial rotation, ...
/// Each map starts in rest space or in the frame of the partial joint before, goes through the full
/// rotations between, and ends in the frame of the next partial joint, or in rest space. Groups
/// whose chains begin alike share these maps.
///
/// Full rotations are multiplied in double precision: there may be many, about distant centres. The
/// kernel reads single precision.
///
/// A section is as much as fits on the stack; a body has one.
struct ChainPlan {
    using Index = std::uint16_t;

    static constexpr std::size_t kMaxJoints = 96;
    static constexpr std::size_t kMaxStates = 128;
    static constexpr std::size_t kMaxOuts = 192;
    static_assert(kMaxOuts > SkinModel::kMaxPartialInfluences &&
                  kMaxJoints > SkinModel::kMaxPartialInfluences);

    /// Map indices: identity, rest to joint frame, joint frame to rest (in single precision) or
    /// states (in double precision), which are products of a map to a frame and full rotations.
    static constexpr Index kIdentity = 0;
    static constexpr Index into(std::size_t joint) { return static_cast<Index>(1 + joint); }
    static constexpr Index state(std::size_t number) {
        return static_cast<Index>(1 + kMaxJoints + number);
    }
    static constexpr Index frame(std::size_t joint) {
        return static_cast<Index>(1 + kMaxJoints + joint);
    }
    /// A state in single precision. Translations in single precision are relative to a pivot of
    /// each map; into() moves it to 0.
    static constexpr Index narrowed(std::size_t number) {
        return static_cast<Index>(1 + 2 * kMaxJoints + number);
    }
    static constexpr std::size_t kWideMaps = 1 + kMaxJoints + kMaxStates;
    static constexpr std::size_t kMaps = 1 + 2 * kMaxJoints + kMaxOuts;

    /// In double precision: first the full rotation of a joint, then `from`.
    struct State {
        Index from, to;
        Index narrowed;      ///< of its copy in single precision; kIdentity: none
        Index narrowedLead;  ///< the same for leads
        std::uint32_t joint; ///< of the section, or kUncached and one of the model
        /// The pivot of `narrowed`, near what follows, since distant ones would lose digits. Rest
        /// space; the pivot of `narrowedLead` is the origin.
        std::array<double, 3> about;
    };
    /// A joint beyond those that fit, computed where it is needed.
    static constexpr std::uint32_t kUncached = 1u << 31;

    /// The maps that the kernel reads, in single precision: first `with`, then `from`.
    struct alignas(16) Out {
        float move[4]; ///< the origin of `with` relative to the pivot of `from`; and 1
        Index from, with;
    };

    /// A partial joint of a group's chain.
    struct Link {
        Index joint; ///< of the section
        Index out;   ///< from its frame outwards
    };
    struct Group {
        std::uint32_t firstLink; ///< in `links`, outermost first
        Index lead; ///< an out, applied first; kNoLead where the innermost link is partial
    };
    static constexpr Index kNoLead = 0xffff;

    /// The first indices of a section; it ends where the next one begins.
    struct Section {
        std::uint32_t group;
        std::uint32_t joint; ///< in `joints`
        std::uint32_t frame, wideInto, state, out;
    };

    explicit ChainPlan(const SkinModel& model);

    std::vector<Section> sections; ///< in the groups' order, and an end
    std::vector<Group> groups;     ///< the model's
    std::vector<Link> links;
    std::vector<std::uint32_t> joints;      ///< of the model
    std::vector<std::int32_t> arePartial;   ///< of `joints`, in any group; 0 or 1, padded with 0
    std::vector<PlannedFrame> frames;       ///< of joints that are partial in any group
    std::vector<PlannedWideInto> wideIntos; ///< of those that full rotations follow
    std::vector<State> states;
    std::vector<Out> outs;
    /// Whether each section's joints are the model's, in order, so that nothing is gathered.
    bool inOrder;
};

/// Vertices in a block; a multiple of every vector's number of floats.
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
    /// A group as the kernel reads it: adjacent numbers, since none is in the nearest cache.
    struct Group {
        std::size_t firstRow; ///< of its first block, in `rows`
        std::uint32_t firstBlock;
        std::uint32_t firstVertex; ///< in the model's order()
        std::uint32_t vertexCount;
        std::uint32_t firstLink; ///< in the plan's links
        std::uint32_t frame;     ///< the joint whose frame its blocks are in, or kRestFrame
        ChainPlan::Index lead;   ///< ChainPlan::Group's
        std::uint16_t linkCount; ///< partial ones
    };
    static constexpr std::uint32_t kRestFrame = ~0u;

    explicit SkinBlocks(const SkinModel& model);

    static std::size_t rowsPerBlock(std::size_t partialCount) { return 6 + 2 * partialCount; }

    /// Rows of a block of SkinTangents: x, y, z in the same frame, and the handedness.
    static constexpr std::size_t kTangentRows = 4;

    ChainPlan plan;
    std::vector<BlockRow> rows;
    std::vector<Group> groups;                 ///< the model's
    std::vector<std::size_t> firstBlock = {0}; ///< of each group; then their total number
    std::vector<glm::dmat3> jointFrames;       ///< jointFrame() of each joint
    bool inOrder; ///< whether the model's order() is the identity: output needs no scatter
    /// Translations of joints up to this are rounding errors: bones' offsets are single precision
    /// in most files and in osgAnimation.
    double smallMove;
};

/// Whether the group's innermost link is partial, so that its blocks are in that joint's frame.
inline bool isInJointFrame(const SkinModel& model, const SkinModel::Group& group) {
    return group.linkCount > 0 && model.links()[group.firstLink + group.linkCount - 1].partial;
}

/// e1, e2, w: a right-handed frame with the twist axis w.
glm::dmat3 jointFrame(const BoundJoint& joint);

/// The axes (columns, rest space) of the frame that a group's blocks are in.
glm::dmat3 restFrame(const SkinModel& model, const SkinModel::Group& group);

/// A bound vertex's influence by a joint; null where it has none.
///
/// \param binding valid
/// \param vertex of the binding
/// \param joint of the binding
const Influence* influenceOf(const Binding& binding, std::uint32_t vertex, std::uint32_t joint);

/// productOrder() as models had it that older versions have saved: each subtree as a whole.
std::vector<std::uint32_t> subtreeOrder(const std::vector<BoundJoint>& joints);

/// Each joint's position in the order in which a model's groups list theirs: productOrder(), or
/// else subtreeOrder().
std::vector<std::uint32_t> linkPlaces(const std::vector<BoundJoint>& joints,
                                      const std::vector<SkinModel::Group>& groups,
                                      const std::vector<SkinModel::Link>& links);

/// The internal data of a model and its tangents.
struct SkinModelAccess {
    /// A model as files have it. Of a group, `vertexCount` and `linkCount` count.
    struct Arranged {
        std::vector<BoundJoint> joints; ///< valid
        std::vector<glm::vec3> positions, normals;
        std::vector<std::uint32_t> order;
        std::vector<SkinModel::Group> groups;
        std::vector<SkinModel::Link> links;
        std::vector<SkinModel::Ratio> ratios;
    };
    /// A model of such data, with its blocks but nothing else.
    ///
    /// \throw osgSkin::Error where it cannot come from a model
    static osg::ref_ptr<SkinModel> make(Arranged&& from);

    static void setGradients(SkinModel& model, std::shared_ptr<const GradientBlocks> gradients) {
        model._gradients = std::move(gradients);
    }
    static void setCorrectives(SkinModel& model, std::shared_ptr<const CorrectiveBlocks> blocks) {
        model._correctives = std::move(blocks);
    }
    /// Finds the joint boxes of a model that has all else.
    static void addJointBoxes(SkinModel& model);

    /// The vertices as DeformJob's fast path reads them.
    static const SkinBlocks& blocks(const SkinModel& model) { return *model._blocks; }

    /// Null for a skin without vertices.
    static const JointBoxes* jointBoxes(const SkinModel& model) { return model._jointBoxes.get(); }

    /// Null where there are none.
    static const CorrectiveBlocks* correctives(const SkinModel& model) {
        return model._correctives.get();
    }

    /// Null where there are none.
    static const GradientBlocks* gradients(const SkinModel& model) {
        return model._gradients.get();
    }

    /// The tangents, SkinBlocks::kTangentRows rows for each of the model's blocks.
    static const BlockRow* blocks(const SkinTangents& tangents) { return tangents._rows.data(); }

    /// The model that fill() has copied to this one; null where there is none.
    static const SkinModel* original(const SkinModel& model) { return model._original.get(); }

    /// Copies `model` to `empty`, for file readers, which create the object first.
    static void fill(SkinModel& empty, const SkinModel& model) {
        empty._original = &model;
        empty._joints = model._joints;
        empty._positions = model._positions;
        empty._normals = model._normals;
        empty._order = model._order;
        empty._groups = model._groups;
        empty._links = model._links;
        empty._ratios = model._ratios;
        empty._blocks = model._blocks;
        empty._correctives = model._correctives;
        empty._gradients = model._gradients;
        empty._jointBoxes = model._jointBoxes;
    }
};

} // namespace osgSkin
