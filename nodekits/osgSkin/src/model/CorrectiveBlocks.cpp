// SPDX-License-Identifier: MIT
#include "model/CorrectiveBlocks.h"

#include "model/GradientBlocks.h"
#include "model/SkinModelAccess.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

const Correctives::Entry* entryOf(const Correctives& correctives, std::uint32_t vertex,
                                  std::uint32_t joint) {
    for (std::uint32_t i = correctives.firstEntry[vertex]; i < correctives.firstEntry[vertex + 1];
         ++i)
        if (correctives.entries[i].joint == joint) return &correctives.entries[i];
    return nullptr;
}

/// Writes shares into one lane of the last `count` rows of `rows`, `end` of which there are then.
void writeLane(const std::int16_t* shares, std::size_t count, std::size_t lane, std::size_t end,
               std::vector<CorrectiveRow>& rows) {
    rows.resize(end, CorrectiveRow{});
    for (std::size_t i = 0; i < count; ++i) rows[end - count + i].lane[lane] = shares[i];
}

/// Whether nothing is in one lane of `count` rows; null: there are none.
bool isEmpty(const CorrectiveRow* rows, std::size_t count, std::size_t lane) {
    return !rows || std::all_of(rows, rows + count,
                                [lane](const CorrectiveRow& row) { return row.lane[lane] == 0; });
}

/// Appends the shares in one lane of `count` rows.
void readLane(const CorrectiveRow* rows, std::size_t count, std::size_t lane,
              std::vector<std::int16_t>& shares) {
    for (std::size_t i = 0; i < count; ++i) shares.push_back(rows[i].lane[lane]);
}

} // namespace

std::vector<std::uint32_t> correctedBy(const Binding& binding, std::uint32_t vertex) {
    std::vector<std::uint32_t> joints;
    const Correctives& correctives = binding.correctives;
    if (correctives.empty()) return joints;
    for (std::uint32_t i = correctives.firstEntry[vertex]; i < correctives.firstEntry[vertex + 1];
         ++i)
        joints.push_back(correctives.entries[i].joint);
    return joints;
}

CorrectiveBlocks::CorrectiveBlocks(const SkinModel& model, const Binding& binding,
                                   const std::vector<std::uint32_t>& source)
    : joints(binding.correctives.joints), inputs(binding.correctives.inputs),
      hasNormals(binding.correctives.hasNormals()) {
    const Correctives& from = binding.correctives;
    firstRange.push_back(0);
    for (const SkinModel::Group& group : model.groups()) {
        for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
            Range range{joint, 0, 0, rows.size(), tilts.size(), tiltUnits.size()};
            for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
                const Correctives::Entry* entry =
                    entryOf(from, source[model.order()[group.firstVertex + row]], joint);
                if (!entry) continue;
                const auto block = static_cast<std::uint32_t>(row / kBlock);
                if (range.blockCount == 0) range.firstBlock = block;
                range.blockCount = block - range.firstBlock + 1;
                const std::size_t end = range.firstRow + range.blockCount * rowsPerBlock(joint);
                writeLane(&from.shares[entry->firstShare], rowsPerBlock(joint), row % kBlock, end,
                          rows);
                if (hasNormals)
                    writeLane(&from.normalShares[entry->firstShare], rowsPerBlock(joint),
                              row % kBlock, end, normalRows);
            }
            if (range.blockCount == 0) continue;
            addTilts(model, static_cast<std::size_t>(&group - model.groups().data()), range);
            ranges.push_back(range);
        }
        firstRange.push_back(static_cast<std::uint32_t>(ranges.size()));
    }
}

void CorrectiveBlocks::addTilts(const SkinModel& model, std::size_t group, const Range& range) {
    const GradientBlocks* gradients = SkinModelAccess::gradients(model);
    if (!hasNormals || !gradients) return;
    const SkinModel::Group& of = model.groups()[group];
    const glm::dmat3 frame = restFrame(model, of);
    const std::size_t modes = joints[range.joint].modes;
    std::vector<double> along(2 * modes * kBlock); // of a block, as its rows
    for (std::uint32_t b = 0; b < range.blockCount; ++b) {
        const CorrectiveRow* from = normalRows.data() + range.firstRow + 3 * modes * b;
        std::fill(along.begin(), along.end(), 0.0);
        double most = 0.0;
        for (std::uint32_t lane = 0; lane < kBlock; ++lane) {
            const auto row = static_cast<std::uint32_t>((range.firstBlock + b) * kBlock + lane);
            if (row >= of.vertexCount) break;
            const SkinDirections at =
                skinDirections(model.normals()[model.order()[of.firstVertex + row]], frame,
                               gradients->acrossOf(model, group, row));
            for (std::size_t k = 0; k < modes; ++k) {
                const glm::dvec3 n(from[3 * k].lane[lane], from[3 * k + 1].lane[lane],
                                   from[3 * k + 2].lane[lane]);
                double* to = &along[2 * k * kBlock + lane];
                to[0] = glm::dot(n, at.u);
                to[kBlock] = glm::dot(n, at.v);
                most = std::max({most, std::abs(to[0]), std::abs(to[kBlock])});
            }
        }
        const auto unit = static_cast<float>(most > 1e-20 ? most / 32767.0 : 1.0);
        tiltUnits.push_back(unit);
        for (std::size_t i = 0; i < along.size(); ++i) {
            if (i % kBlock == 0) tilts.emplace_back();
            const double units = std::clamp(along[i] / double(unit), -32767.0, 32767.0);
            tilts.back().lane[i % kBlock] = static_cast<std::int16_t>(std::lrint(units));
        }
    }
}

Correctives correctivesOf(const SkinModel& model) {
    Correctives result;
    const CorrectiveBlocks* blocks = SkinModelAccess::correctives(model);
    if (!blocks) return result;
    result.joints = blocks->joints;
    result.inputs = blocks->inputs;
    struct Place { // of a vertex: its group and row there
        std::size_t group;
        std::uint32_t row;
    };
    std::vector<Place> places(model.vertexCount());
    for (std::size_t g = 0; g < model.groups().size(); ++g)
        for (std::uint32_t row = 0; row < model.groups()[g].vertexCount; ++row)
            places[model.order()[model.groups()[g].firstVertex + row]] = {g, row};
    result.firstEntry.push_back(0);
    for (const Place& place : places) {
        for (std::uint32_t i = blocks->firstRange[place.group];
             i < blocks->firstRange[place.group + 1]; ++i) {
            const CorrectiveBlocks::Range& range = blocks->ranges[i];
            const CorrectiveRow* block = blocks->blockOf(range, place.row);
            if (!block) continue;
            const CorrectiveRow* normals = blocks->normalBlockOf(range, place.row);
            const std::size_t count = blocks->rowsPerBlock(range.joint);
            const std::size_t lane = place.row % kBlock;
            if (isEmpty(block, count, lane) && isEmpty(normals, count, lane)) continue;
            result.entries.push_back(
                {range.joint, static_cast<std::uint32_t>(result.shares.size())});
            readLane(block, count, lane, result.shares);
            if (normals) readLane(normals, count, lane, result.normalShares);
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

} // namespace osgSkin
