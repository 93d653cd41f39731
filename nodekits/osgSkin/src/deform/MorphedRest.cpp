// SPDX-License-Identifier: MIT
#include <osgSkin/MorphedRest>

#include "model/SkinBlocks.h"

#include <osgSkin/Error>

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

/// Rows of positions and normals in a block.
constexpr std::size_t kRestRows = 6;

void addTimes(float weight, const BlockRow& offset, BlockRow& to) {
    for (std::size_t lane = 0; lane < kBlock; ++lane) to.lane[lane] += weight * offset.lane[lane];
}

void normalise(BlockRow* n) {
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        float &x = n[0].lane[lane], &y = n[1].lane[lane], &z = n[2].lane[lane];
        // Padding has no normals.
        const float scale = 1.0f / std::sqrt(std::max(x * x + y * y + z * z, 1e-30f));
        x *= scale;
        y *= scale;
        z *= scale;
    }
}

} // namespace

/// Of a few arrays of blocks, 16 vertices each, so that adding them needs no index.
struct MorphedRest::Target {
    std::vector<Block> blocks; ///< increasing
    std::vector<BlockRow> positions, normals, tangents; ///< three rows a block; the last two may be empty
};

MorphedRest::MorphedRest(const osg::ref_ptr<const SkinModel>& model,
                         const osg::ref_ptr<const MorphTargets>& targets,
                         const osg::ref_ptr<const SkinTangents>& tangents)
    : _model(model), _targets(targets) {
    if (!model || !targets) throw Error("morphed rest: expected a model and morph targets");
    if (targets->vertexCount() != model->vertexCount())
        throw Error("morphed rest: the targets are of " + std::to_string(targets->vertexCount()) +
                    " vertices, expected the model's " + std::to_string(model->vertexCount()));
    _rows = SkinModelAccess::blocks(*model).rows;
    _blocks.resize(targets->targets().size());
    if (!tangents || std::all_of(targets->targets().begin(), targets->targets().end(),
                                 [](const MorphTarget& t) { return t.tangents.empty(); }))
        return;
    if (tangents->model() != model)
        throw Error("morphed rest: the tangents are another model's");
    _tangents = tangents;
    const BlockRow* const rows = SkinModelAccess::blocks(*tangents);
    _tangentRows.assign(rows, rows + SkinModelAccess::blocks(*model).firstBlock.back() *
                                         SkinBlocks::kTangentRows);
}

MorphedRest::~MorphedRest() = default;

const MorphedRest::Target& MorphedRest::target(std::size_t index) {
    if (_blocks[index]) return *_blocks[index];
    const MorphTarget& from = _targets->targets()[index];
    const SkinBlocks& blocks = SkinModelAccess::blocks(*_model);
    const std::vector<SkinModel::Group>& groups = _model->groups();
    std::vector<std::uint32_t> placeOf(_model->vertexCount()); // of each vertex in order()
    for (std::uint32_t i = 0; i < placeOf.size(); ++i) placeOf[_model->order()[i]] = i;
    std::vector<std::pair<std::uint32_t, std::size_t>> moved; // places, and entries of the target
    for (std::size_t i = 0; i < from.vertices.size(); ++i)
        moved.emplace_back(placeOf[from.vertices[i]], i);
    std::sort(moved.begin(), moved.end());

    auto result = std::make_unique<Target>();
    std::size_t g = 0;
    glm::dmat3 frame = restFrame(*_model, groups[g]);
    const auto put = [&](const std::vector<glm::vec3>& offsets, std::size_t i, std::size_t lane,
                         std::vector<BlockRow>& rows) {
        if (offsets.empty()) return;
        rows.resize(3 * result->blocks.size(), BlockRow{});
        const glm::dvec3 offset = glm::dvec3(offsets[i]) * frame; // transposed: into the frame
        for (std::size_t axis = 0; axis < 3; ++axis)
            rows[rows.size() - 3 + axis].lane[lane] =
                static_cast<float>(offset[static_cast<int>(axis)]);
    };
    for (const auto& [place, i] : moved) {
        while (place >= groups[g].firstVertex + groups[g].vertexCount)
            frame = restFrame(*_model, groups[++g]);
        const std::size_t row = place - groups[g].firstVertex;
        const std::size_t number = blocks.firstBlock[g] + row / kBlock;
        if (result->blocks.empty() || result->blocks.back().number != number)
            result->blocks.push_back(
                {number, blocks.groups[g].firstRow +
                             row / kBlock * SkinBlocks::rowsPerBlock(groups[g].partialCount)});
        put(from.positions, i, row % kBlock, result->positions);
        put(from.normals, i, row % kBlock, result->normals);
        put(from.tangents, i, row % kBlock, result->tangents);
    }
    _blocks[index] = std::move(result);
    return *_blocks[index];
}

/// Puts the blocks that were moved back to rest.
void MorphedRest::restore() {
    const BlockRow* const rest = SkinModelAccess::blocks(*_model).rows.data();
    for (const Block& block : _moved)
        std::copy(rest + block.firstRow, rest + block.firstRow + kRestRows,
                  _rows.begin() + static_cast<std::ptrdiff_t>(block.firstRow));
    if (_tangentRows.empty()) return;
    const BlockRow* const tangents = SkinModelAccess::blocks(*_tangents);
    for (const Block& block : _moved) {
        const std::size_t first = block.number * SkinBlocks::kTangentRows;
        std::copy(tangents + first, tangents + first + SkinBlocks::kTangentRows,
                  _tangentRows.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

void MorphedRest::set(const std::vector<float>& weights) {
    const std::vector<MorphTarget>& targets = _targets->targets();
    restore();
    _next.clear();
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (weights[i] != targets[i].initial) _next.push_back(i);
    if (_next != _active) {
        _moved.clear();
        for (const std::size_t i : _next)
            _moved.insert(_moved.end(), target(i).blocks.begin(), target(i).blocks.end());
        const auto byNumber = [](const Block& a, const Block& b) { return a.number < b.number; };
        const auto isSame = [](const Block& a, const Block& b) { return a.number == b.number; };
        std::sort(_moved.begin(), _moved.end(), byNumber);
        _moved.erase(std::unique(_moved.begin(), _moved.end(), isSame), _moved.end());
        std::swap(_active, _next);
    }
    bool turnsNormals = false;
    for (const std::size_t i : _active) {
        const Target& from = target(i);
        const float weight = weights[i] - targets[i].initial;
        for (std::size_t b = 0; b < from.blocks.size(); ++b) {
            const Block& block = from.blocks[b];
            BlockRow* const to = _rows.data() + block.firstRow;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                addTimes(weight, from.positions[3 * b + axis], to[axis]);
                if (!from.normals.empty())
                    addTimes(weight, from.normals[3 * b + axis], to[3 + axis]);
                if (!from.tangents.empty() && !_tangentRows.empty())
                    addTimes(weight, from.tangents[3 * b + axis],
                             _tangentRows[block.number * SkinBlocks::kTangentRows + axis]);
            }
        }
        turnsNormals = turnsNormals || !from.normals.empty();
    }
    if (turnsNormals)
        for (const Block& block : _moved) normalise(_rows.data() + block.firstRow + 3);
}

const BlockRow* MorphedRest::rows() const {
    return _rows.data();
}

const BlockRow* MorphedRest::tangentRows() const {
    return _tangentRows.empty() ? nullptr : _tangentRows.data();
}

} // namespace osgSkin
