// SPDX-License-Identifier: MIT
#include <osgSkin/MorphedRest>

#include "model/SkinBlocks.h"

#include <osgSkin/Error>

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kAxes = 3;

void addTimes(float weight, const BlockRow& offset, BlockRow& to) {
    for (std::size_t lane = 0; lane < kBlock; ++lane) to.lane[lane] += weight * offset.lane[lane];
}

/// Turns what is to be added to normals into what is perpendicular to them, so that the sum keeps
/// its direction.
void makeTilts(const BlockRow* normals, BlockRow* d) {
    constexpr float kMin = 0.05f; // a normal may turn by nearly 90 degrees
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const float x = normals[0].lane[lane], y = normals[1].lane[lane], z = normals[2].lane[lane];
        const float along = d[0].lane[lane] * x + d[1].lane[lane] * y + d[2].lane[lane] * z;
        const float scale = 1.0f / std::max(1.0f + along, kMin);
        d[0].lane[lane] = scale * (d[0].lane[lane] - along * x);
        d[1].lane[lane] = scale * (d[1].lane[lane] - along * y);
        d[2].lane[lane] = scale * (d[2].lane[lane] - along * z);
    }
}

} // namespace

/// Of a few arrays of blocks, 16 vertices each, so that adding them needs no index.
struct MorphedRest::Target {
    std::vector<Block> blocks; ///< increasing
    std::vector<BlockRow> positions, normals,
        tangents; ///< three rows a block; the last two may be empty
};

MorphedRest::MorphedRest(const osg::ref_ptr<const SkinModel>& model,
                         const osg::ref_ptr<const MorphTargets>& targets,
                         const osg::ref_ptr<const SkinTangents>& tangents)
    : _model(model), _targets(targets) {
    if (!model || !targets) throw Error("morphed rest: expected a model and morph targets");
    if (targets->vertexCount() != model->vertexCount())
        throw Error("morphed rest: the targets are of " + std::to_string(targets->vertexCount()) +
                    " vertices, expected the model's " + std::to_string(model->vertexCount()));
    const SkinBlocks& blocks = SkinModelAccess::blocks(*model);
    _rows = blocks.rows;
    _blocks.resize(targets->targets().size());
    bool haveNormals = false, haveTangents = false;
    for (const MorphTarget& target : targets->targets()) {
        haveNormals = haveNormals || !target.normals.empty();
        haveTangents = haveTangents || !target.tangents.empty();
    }
    if (haveNormals) _tilts.resize(kAxes * blocks.firstBlock.back(), BlockRow{});
    if (!tangents || !haveTangents) return;
    if (tangents->model() != model) throw Error("morphed rest: the tangents are another model's");
    _tangents = tangents;
    const BlockRow* const rows = SkinModelAccess::blocks(*tangents);
    _tangentRows.assign(rows, rows + blocks.firstBlock.back() * SkinBlocks::kTangentRows);
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
        rows.resize(kAxes * result->blocks.size(), BlockRow{});
        const glm::dvec3 offset = glm::dvec3(offsets[i]) * frame; // transposed: into the frame
        for (std::size_t axis = 0; axis < kAxes; ++axis)
            rows[rows.size() - kAxes + axis].lane[lane] =
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
    const BlockRow* const tangents = _tangents ? SkinModelAccess::blocks(*_tangents) : nullptr;
    for (const Block& block : _moved) {
        std::copy_n(rest + block.firstRow, kAxes, _rows.data() + block.firstRow);
        if (!_tilts.empty()) std::fill_n(_tilts.data() + kAxes * block.number, kAxes, BlockRow{});
        const std::size_t first = block.number * SkinBlocks::kTangentRows;
        if (tangents) std::copy_n(tangents + first, kAxes, _tangentRows.data() + first);
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
    for (const std::size_t i : _active) {
        const Target& from = target(i);
        const float weight = weights[i] - targets[i].initial;
        const auto add = [&](const std::vector<BlockRow>& offsets, std::size_t block,
                             BlockRow* to) {
            if (offsets.empty()) return;
            for (std::size_t axis = 0; axis < kAxes; ++axis)
                addTimes(weight, offsets[kAxes * block + axis], to[axis]);
        };
        for (std::size_t b = 0; b < from.blocks.size(); ++b) {
            const Block& block = from.blocks[b];
            add(from.positions, b, _rows.data() + block.firstRow);
            add(from.normals, b, _tilts.data() + kAxes * block.number);
            if (_tangents)
                add(from.tangents, b,
                    _tangentRows.data() + block.number * SkinBlocks::kTangentRows);
        }
    }
    if (_tilts.empty()) return;
    for (const Block& block : _moved)
        makeTilts(_rows.data() + block.firstRow + kAxes, _tilts.data() + kAxes * block.number);
}

const BlockRow* MorphedRest::rows() const {
    return _rows.data();
}

const BlockRow* MorphedRest::tilts() const {
    return _tilts.empty() ? nullptr : _tilts.data();
}

const BlockRow* MorphedRest::tangentRows() const {
    return _tangentRows.empty() ? nullptr : _tangentRows.data();
}

} // namespace osgSkin
