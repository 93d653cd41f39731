// SPDX-License-Identifier: MIT
#include "model/CorrectiveBlocks.h"

#include "model/GradientBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

const Correctives::Entry* entryOf(const Correctives& correctives, std::uint32_t vertex,
                                  std::uint32_t joint) {
    for (std::uint32_t i = correctives.firstEntry[vertex]; i < correctives.firstEntry[vertex + 1];
         ++i)
        if (correctives.entries[i].joint == joint) return &correctives.entries[i];
    return nullptr;
}

/// Resizes `rows` to `end` and writes shares into a lane of the last `count`.
void writeLane(const std::int16_t* shares, std::size_t count, std::size_t lane, std::size_t end,
               std::vector<CorrectiveRow>& rows) {
    rows.resize(end, CorrectiveRow{});
    for (std::size_t i = 0; i < count; ++i) rows[end - count + i].lane[lane] = shares[i];
}

/// Whether a lane of `count` rows is 0; so are null rows.
bool isEmpty(const CorrectiveRow* rows, std::size_t count, std::size_t lane) {
    return !rows || std::all_of(rows, rows + count,
                                [lane](const CorrectiveRow& row) { return row.lane[lane] == 0; });
}

/// Appends the shares in a lane of `count` rows.
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

CorrectiveTable::CorrectiveTable(const CorrectiveJoint& joint, const std::vector<BoundJoint>& bound)
    : stride((joint.modes + kAtOnce - 1) / kAtOnce * kAtOnce), restRow(joint.functionCount()) {
    rows.resize((restRow + 1) * stride, 0.0);
    for (std::size_t k = 0; k < joint.modes; ++k)
        for (std::size_t i = 0; i < restRow; ++i)
            rows[i * stride + k] = joint.coefficients[k * restRow + i];
    if (joint.basis == CorrectiveJoint::Basis::Input) return;
    const BoundJoint& of = bound[joint.joint];
    const glm::dmat3 frame = jointFrame(of);
    const glm::dvec3 second = glm::cross(of.twistAxis, joint.axis);
    toAxes = {{glm::dot(frame[0], joint.axis), glm::dot(frame[0], second)},
              {glm::dot(frame[1], joint.axis), glm::dot(frame[1], second)}};
    if (joint.basis == CorrectiveJoint::Basis::Ball) return;
    const std::size_t next = joint.basis == CorrectiveJoint::Basis::Round         ? 7
                             : joint.basis == CorrectiveJoint::Basis::TurnedHinge ? 3
                                                                                  : 1;
    double atRest[3];
    const std::size_t first = splinesAt(joint.knots, 0.0, atRest);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < joint.modes; ++k)
            rows[restRow * stride + k] += atRest[i] * row((first + i) * next)[k];
}

CorrectiveBlocks::CorrectiveBlocks(const SkinModel& model, const Binding& binding,
                                   const std::vector<std::uint32_t>& source)
    : joints(binding.correctives.joints), inputs(binding.correctives.inputs),
      hasNormals(binding.correctives.hasNormals()) {
    const Correctives& from = binding.correctives;
    addTables(model);
    firstRange.push_back(0);
    for (const SkinModel::Group& group : model.groups()) {
        for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
            Range range{joint, 0, 0, rows.size(), tilts.size()};
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
    addCorrected(model);
}

void CorrectiveBlocks::addTables(const SkinModel& model) {
    for (const CorrectiveJoint& joint : joints) tables.emplace_back(joint, model.joints());
    for (const glm::dmat3& axes : SkinModelAccess::blocks(model).jointFrames) {
        KernelMap& frame = frames.emplace_back(KernelMap{});
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                frame.column[column][row] = roundedToFloat(axes[row][column]);
    }
}

CorrectiveBlocks::CorrectiveBlocks(const SkinModel& model, Stored&& from)
    : joints(std::move(from.joints)), inputs(std::move(from.inputs)), hasNormals(from.hasNormals),
      ranges(std::move(from.ranges)), firstRange(std::move(from.firstRange)),
      rows(std::move(from.rows)), normalRows(std::move(from.normalRows)) {
    const auto refuse = [] { throw Error("skin model: its correctives do not fit its groups"); };
    if (firstRange.size() != model.groups().size() + 1) refuse();
    std::size_t rowCount = 0;
    for (std::size_t g = 0; g < model.groups().size(); ++g) {
        const std::size_t blocks = (model.groups()[g].vertexCount + kBlock - 1) / kBlock;
        for (std::size_t i = firstRange[g]; i < firstRange[g + 1]; ++i) {
            Range& range = ranges[i];
            if (range.joint >= joints.size() ||
                (i > firstRange[g] && range.joint <= ranges[i - 1].joint) ||
                range.blockCount == 0 || range.blockCount > blocks ||
                range.firstBlock > blocks - range.blockCount)
                refuse();
            range.firstRow = rowCount;
            rowCount += range.blockCount * rowsPerBlock(range.joint);
        }
    }
    if (rows.size() != rowCount || normalRows.size() != (hasNormals ? rowCount : 0)) refuse();
    for (const std::vector<CorrectiveRow>* list : {&rows, &normalRows})
        for (const CorrectiveRow& row : *list)
            if (*std::min_element(row.lane, row.lane + kBlock) < -Correctives::kUnit)
                throw Error("skin model: a share of its correctives is less than " +
                            std::to_string(-Correctives::kUnit));
    addTables(model);
    for (std::size_t g = 0; g < model.groups().size(); ++g)
        for (std::size_t i = firstRange[g]; i < firstRange[g + 1]; ++i) {
            ranges[i].firstTilt = tilts.size();
            addTilts(model, g, ranges[i]);
        }
    addCorrected(model);
}

bool CorrectiveBlocks::keepsTurned(const SkinModel& model, std::size_t group) const {
    return SkinModelAccess::blocks(model).groups[group].frame != SkinBlocks::kRestFrame &&
           std::all_of(
               ranges.begin() + firstRange[group], ranges.begin() + firstRange[group + 1],
               [this](const Range& range) { return joints[range.joint].modes <= kMaxTurnedModes; });
}

void CorrectiveBlocks::addTurned(const glm::dmat3& frame, const Range& range) {
    for (std::size_t row = 0; row < range.blockCount * rowsPerBlock(range.joint); row += 3) {
        const CorrectiveRow* const from = &rows[range.firstRow + row];
        turnedRows.resize(turnedRows.size() + 3);
        BlockRow* const to = &*(turnedRows.end() - 3);
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const glm::dvec3 share(from[0].lane[lane], from[1].lane[lane], from[2].lane[lane]);
            for (int axis = 0; axis < 3; ++axis)
                to[axis].lane[lane] = roundedToFloat(glm::dot(frame[axis], share));
        }
    }
}

void CorrectiveBlocks::addCorrected(const SkinModel& model) {
    const std::vector<SkinModel::Group>& groups = model.groups();
    std::vector<bool> turned;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        turned.push_back(keepsTurned(model, g));
        if (!turned.back()) continue;
        const glm::dmat3 frame = restFrame(model, groups[g]);
        for (std::size_t i = firstRange[g]; i < firstRange[g + 1]; ++i) addTurned(frame, ranges[i]);
    }
    // Rows do not move any more.
    const BlockRow* nextTurned = turnedRows.data();
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const std::uint32_t frame = SkinModelAccess::blocks(model).groups[g].frame;
        const bool isInFrame = turned[g] || frame == SkinBlocks::kRestFrame;
        shareFrames.push_back(isInFrame ? nullptr : &frames[frame]);
        for (std::size_t i = firstRange[g]; i < firstRange[g + 1]; ++i) {
            const Range& range = ranges[i];
            const std::size_t blockRows = rowsPerBlock(range.joint);
            corrected.push_back({rows[range.firstRow].lane, turned[g] ? nextTurned->lane : nullptr,
                                 hasNormals ? normalRows[range.firstRow].lane : nullptr,
                                 tilts.empty() ? nullptr : tilts[range.firstTilt].lane,
                                 blockRows * kBlock, range.firstBlock, range.blockCount,
                                 range.joint,
                                 static_cast<std::uint32_t>(joints[range.joint].modes)});
            if (turned[g]) nextTurned += range.blockCount * blockRows;
        }
    }
}

void CorrectiveBlocks::addTilts(const SkinModel& model, std::size_t group, const Range& range) {
    const GradientBlocks* gradients = SkinModelAccess::gradients(model);
    if (!hasNormals || !gradients) return;
    const SkinModel::Group& of = model.groups()[group];
    const glm::dmat3 frame = restFrame(model, of);
    const std::size_t modes = joints[range.joint].modes;
    tilts.resize(range.firstTilt + 2 * modes * range.blockCount, BlockRow{});
    for (std::uint32_t b = 0; b < range.blockCount; ++b) {
        const CorrectiveRow* from = normalRows.data() + range.firstRow + 3 * modes * b;
        BlockRow* const to = tilts.data() + range.firstTilt + 2 * modes * b;
        for (std::uint32_t lane = 0; lane < kBlock; ++lane) {
            const auto row = static_cast<std::uint32_t>((range.firstBlock + b) * kBlock + lane);
            if (row >= of.vertexCount) break;
            const SkinDirections at =
                skinDirections(model.normals()[model.order()[of.firstVertex + row]], frame,
                               gradients->acrossOf(model, group, row));
            for (std::size_t k = 0; k < modes; ++k) {
                const glm::dvec3 n(from[3 * k].lane[lane], from[3 * k + 1].lane[lane],
                                   from[3 * k + 2].lane[lane]);
                to[2 * k].lane[lane] = static_cast<float>(glm::dot(n, at.u));
                to[2 * k + 1].lane[lane] = static_cast<float>(glm::dot(n, at.v));
            }
        }
    }
}

Correctives correctivesOf(const SkinModel& model) {
    Correctives result;
    const CorrectiveBlocks* blocks = SkinModelAccess::correctives(model);
    if (!blocks) return result;
    result.joints = blocks->joints;
    result.inputs = blocks->inputs;
    struct Place { // of a vertex
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
