// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>

#include "deform/DeformKernel.h"
#include "deform/PosedChains.h"
#include "deform/RestCopy.h"
#include "model/SkinBlocks.h"
#include "pose/CorrectiveWeights.h"

#include <osgSkin/Error>
#include <osgSkin/SkinModel>

#include <algorithm>
#include <cstddef>

namespace osgSkin {
namespace {

/// Finds for the kernel which links tilt normals in one pose, and by how much; on the stack.
class KernelSlopes {
public:
    explicit KernelSlopes(const SkinModel& model) noexcept
        : _model(model), _blocks(SkinModelAccess::gradients(model)) {}

    /// Takes the joints of a section.
    ///
    /// \param joints must outlive this
    /// \param run its slopes are set, until the next call
    void take(const KernelJoints& joints, std::size_t jointCount, KernelRun& run) noexcept {
        const auto unit = static_cast<float>(_blocks->unit);
        for (std::size_t j = 0; j < jointCount; ++j) {
            _bendSlopes[j] = unit * joints.wholeBend[j]; // exact: a power of two
            _twistSlopes[j] = unit * joints.wholeTwist[j];
        }
        run.bendSlopes = _bendSlopes;
        run.twistSlopes = _twistSlopes;
        run.slopeUnit = unit;
        _joints = &joints;
    }

    /// Finds the links that tilt normals, of as many groups as there is room for.
    ///
    /// \param endGroup the end of the wanted groups, in the section
    /// \param run its tilts are set, until the next call
    /// \return the end of the groups that were found
    std::size_t find(std::size_t firstGroup, std::size_t endGroup, KernelRun& run) noexcept {
        const SkinBlocks& blocks = SkinModelAccess::blocks(_model);
        const auto endOf = [&](std::size_t g) {
            return std::size_t(blocks.groups[g].firstLink) + blocks.groups[g].linkCount;
        };
        const std::size_t first = blocks.groups[firstGroup].firstLink;
        while (endOf(endGroup - 1) > first + LinkTilts::kMax) --endGroup;
        // `reach` is in the order of the plan's links.
        _tilts.find(blocks.plan.links.data() + first, _blocks->reach.data() + first,
                    endOf(endGroup - 1) - first, *_joints);
        run.tilts = &_tilts;
        run.firstTilt = first;
        return endGroup;
    }

private:
    const SkinModel& _model;
    const GradientBlocks* _blocks; ///< null where the model has none
    const KernelJoints* _joints;
    LinkTilts _tilts;
    float _bendSlopes[KernelJoints::kMax], _twistSlopes[KernelJoints::kMax];
};

constexpr std::size_t kPartBlocks = 256;

/// The group of a block.
std::size_t groupOf(const SkinBlocks& blocks, std::size_t block) noexcept {
    const auto behind = std::upper_bound(blocks.firstBlock.begin(), blocks.firstBlock.end(), block);
    return static_cast<std::size_t>(behind - blocks.firstBlock.begin()) - 1;
}

/// The first vertex of a block, in the model's order; their number for the end.
std::size_t firstVertexOf(const SkinModel& model, std::size_t block) noexcept {
    const SkinBlocks& blocks = SkinModelAccess::blocks(model);
    if (block >= blocks.firstBlock.back()) return model.vertexCount();
    const std::size_t group = groupOf(blocks, block);
    return model.groups()[group].firstVertex + (block - blocks.firstBlock[group]) * kBlock;
}

/// The part of a run that does not depend on the pose.
KernelRun runOf(const DeformJob& job, std::size_t endVertex) noexcept {
    const SkinBlocks& blocks = SkinModelAccess::blocks(*job.model);
    KernelRun run{};
    run.blocks = &blocks;
    run.rows = job.morphed ? job.morphed->rows() : blocks.rows.data();
    run.morphTilts = job.morphed ? job.morphed->tilts() : nullptr;
    if (job.tangents) {
        const BlockRow* const morphed = job.morphed ? job.morphed->tangentRows() : nullptr;
        run.tangentRows = morphed ? morphed : SkinModelAccess::blocks(*job.restTangents);
    }
    run.corrections = SkinModelAccess::correctives(*job.model);
    run.gradients = job.normals ? SkinModelAccess::gradients(*job.model) : nullptr;
    run.positions = &job.positions->x;
    run.normals = job.normals ? &job.normals->x : nullptr;
    run.tangents = job.tangents ? &job.tangents->x : nullptr;
    run.endVertex = endVertex;
    run.scatter = blocks.inOrder ? nullptr : job.model->order().data();
    return run;
}

/// Deforms the blocks from `first` to before `end` of group `g` and groups after it.
///
/// \param endGroup the end of the groups that may be deformed together
/// \return the end of the groups that were deformed
std::size_t runGroups(Kernel kernel, std::size_t g, std::size_t endGroup, std::size_t first,
                      std::size_t end, KernelRun& run) noexcept {
    const SkinBlocks& blocks = *run.blocks;
    run.firstGroup = g;
    run.skippedBlocks = 0;
    if (first <= blocks.firstBlock[g] && end >= blocks.firstBlock[g + 1]) {
        if (end < blocks.firstBlock[endGroup]) --endGroup; // only part of the last one: next
        run.groups = blocks.groups.data() + g;
        run.groupCount = endGroup - g;
        kernel(run);
        return endGroup;
    }
    const std::size_t from = std::max(first, blocks.firstBlock[g]) - blocks.firstBlock[g];
    const std::size_t to = std::min(end, blocks.firstBlock[g + 1]) - blocks.firstBlock[g];
    SkinBlocks::Group part = blocks.groups[g];
    part.firstRow += from * SkinBlocks::rowsPerBlock(part.linkCount);
    part.firstBlock += static_cast<std::uint32_t>(from);
    part.firstVertex += static_cast<std::uint32_t>(from * kBlock);
    part.vertexCount = static_cast<std::uint32_t>(
        std::min<std::size_t>(part.vertexCount, to * kBlock) - from * kBlock);
    run.groups = &part;
    run.groupCount = 1;
    run.skippedBlocks = from;
    kernel(run);
    return g + 1;
}

/// Deforms the blocks from `first` to before `end`; writes no other vertex.
void runBlocks(const DeformJob& job, std::size_t first, std::size_t end) noexcept {
    if (first >= end) return;
    const SkinModel& model = *job.model;
    if (!job.morphed && isAtRest(model, *job.pose))
        return copyRest(job, firstVertexOf(model, first), firstVertexOf(model, end));
    const SkinBlocks& blocks = SkinModelAccess::blocks(model);
    PosedChains chains;
    KernelRun run = runOf(job, firstVertexOf(model, end));
    run.joints = &chains.joints;
    run.outs = chains.outs;
    const std::size_t firstGroup = groupOf(blocks, first), endGroup = groupOf(blocks, end - 1) + 1;
    // Not std::optional: GCC 12 would fill it with zeros.
    CorrectiveWeights weights(model, *job.pose);
    if (run.corrections) weights.workOut(firstGroup, endGroup);
    run.weights = weights.known();
    KernelSlopes slopes(model);
    const Kernel kernel = kernelFor(job.normals, job.tangents, run.gradients);
    const ChainPlan::Section* section = blocks.plan.sections.data();
    for (std::size_t g = firstGroup; g < endGroup; ++section) {
        if (section[1].group <= g) continue;
        const std::size_t endOfSection = std::min<std::size_t>(section[1].group, endGroup);
        chains.set(model, *job.pose, *section, g, endOfSection);
        if (run.gradients) slopes.take(chains.joints, section[1].joint - section->joint, run);
        while (g < endOfSection)
            g = runGroups(kernel, g,
                          run.gradients ? slopes.find(g, endOfSection, run) : endOfSection, first,
                          end, run);
    }
}

/// Why a job cannot run; null where it can.
const char* reasonAgainst(const DeformJob& job) noexcept {
    if (!job.model) return "no model";
    const std::size_t vertices = job.model->vertexCount();
    if (!job.pose) return "no pose";
    if (job.pose->size() != job.model->joints().size())
        return "the pose is not one of the model's joints";
    if (job.morphed && job.morphed->model() != job.model)
        return "the morphed rest vertices are another model's";
    if (!job.positions) return "no output for positions";
    if (job.positionCount != vertices) return "as many positions as vertices are needed";
    if (job.normals && job.normalCount != vertices) return "as many normals as vertices are needed";
    if (!job.tangents) return nullptr;
    if (!job.normals) return "tangents are rotated beside normals only";
    if (!job.restTangents) return "no rest tangents";
    if (job.restTangents->model() != job.model) return "the rest tangents are another model's";
    if (job.tangentCount != vertices) return "as many tangents as vertices are needed";
    return nullptr;
}

} // namespace

void DeformJob::validate() const {
    if (const char* reason = reasonAgainst(*this))
        throw Error(std::string("deform job: ") + reason);
}

bool DeformJob::isValid() const noexcept {
    return !reasonAgainst(*this);
}

bool DeformJob::run() const noexcept {
    if (!isValid()) return false;
    runBlocks(*this, 0, SkinModelAccess::blocks(*model).firstBlock.back());
    return true;
}

std::size_t DeformJob::partCount() const noexcept {
    if (!isValid()) return 0;
    return (SkinModelAccess::blocks(*model).firstBlock.back() + kPartBlocks - 1) / kPartBlocks;
}

bool DeformJob::runPart(std::size_t part) const noexcept {
    if (part >= partCount()) return false;
    const std::size_t first = part * kPartBlocks;
    runBlocks(*this, first,
              std::min(first + kPartBlocks, SkinModelAccess::blocks(*model).firstBlock.back()));
    return true;
}

SurfaceSlopes surfaceSlopesOf(const SkinModel& model) {
    SurfaceSlopes result;
    const GradientBlocks* blocks = SkinModelAccess::gradients(model);
    if (!blocks) return result;
    const std::vector<RatioGradient> all = gradientsOf(model); // of full links, too
    std::size_t at = 0, reach = 0;
    for (const SkinModel::Group& group : model.groups()) {
        const SkinModel::Link* links = model.links().data() + group.firstLink;
        for (std::uint32_t row = 0; row < group.vertexCount; ++row)
            for (std::uint32_t i = 0; i < group.linkCount; ++i, ++at)
                if (links[i].partial) result.gradients.push_back(all[at]);
        for (std::uint32_t i = 0; i < group.linkCount; ++i) {
            const GradientBlocks::Reach most =
                links[i].partial ? blocks->reach[reach++] : GradientBlocks::Reach{};
            result.reach.emplace_back(most.bend, most.twist);
        }
    }
    return result;
}

void correctiveWeights(const SkinModel& model, const Pose& pose, std::uint32_t joint,
                       glm::vec2* weights) noexcept {
    CorrectiveWeights all(model, pose);
    const CorrectiveWeights::Weights* of = all.of(joint);
    for (std::size_t k = 0; k < all.modesOf(joint); ++k)
        weights[k] = of ? glm::vec2(of->positions[k], of->normals[k]) : glm::vec2(0.0f);
}

} // namespace osgSkin
