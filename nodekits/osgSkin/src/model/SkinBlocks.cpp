// SPDX-License-Identifier: MIT
#include "model/SkinBlocks.h"

#include <osgSkin/GlmTypes>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// Of single precision, of a skin's coordinates.
constexpr double kRounding = 1e-7;

double largestCoordinate(const SkinModel& model) {
    float largest = 0.0f;
    for (const glm::vec3& p : model.positions())
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(largest);
}

bool isIdentity(const std::vector<std::uint32_t>& order) {
    for (std::uint32_t i = 0; i < order.size(); ++i)
        if (order[i] != i) return false;
    return true;
}

std::uint32_t frameOf(const SkinModel& model, const SkinModel::Group& group) {
    if (!isInJointFrame(model, group)) return SkinBlocks::kRestFrame;
    return model.links()[group.firstLink + group.linkCount - 1].joint;
}

/// Writes one vertex into its lane of its block.
void place(const SkinModel& model, const SkinModel::Group& group, std::uint32_t row,
           const glm::dmat3& frame, BlockRow* block) {
    const std::uint32_t v = model.order()[group.firstVertex + row];
    glm::dvec3 p = glm::dvec3(model.positions()[v]);
    if (isInJointFrame(model, group))
        p -= model.joints()[model.links()[group.firstLink + group.linkCount - 1].joint].centre;
    p = p * frame; // transposed: into the frame
    const glm::dvec3 n = glm::dvec3(model.normals()[v]) * frame;
    const std::size_t lane = row % kBlock;
    for (int axis = 0; axis < 3; ++axis) {
        block[axis].lane[lane] = static_cast<float>(p[axis]);
        block[3 + axis].lane[lane] = static_cast<float>(n[axis]);
    }
    const SkinModel::Ratio* ratios =
        model.ratios().data() + group.firstRatio + std::size_t(row) * group.partialCount;
    BlockRow* to = block + 6;
    for (std::size_t k = group.partialCount; k-- > 0; to += 2) {
        to[0].lane[lane] = ratios[k].bend;
        to[1].lane[lane] = ratios[k].twist;
    }
}

} // namespace

glm::dmat3 jointFrame(const BoundJoint& joint) {
    const glm::dvec3 w = glm::normalize(joint.twistAxis);
    const glm::dvec3 e1 = -anyPerpendicular(w);
    return {e1, glm::cross(w, e1), w};
}

glm::dmat3 restFrame(const SkinModel& model, const SkinModel::Group& group) {
    if (!isInJointFrame(model, group)) return glm::dmat3(1.0);
    return jointFrame(model.joints()[model.links()[group.firstLink + group.linkCount - 1].joint]);
}

SkinBlocks::SkinBlocks(const SkinModel& model)
    : plan(model), inOrder(isIdentity(model.order())),
      smallMove(kRounding * largestCoordinate(model)) {
    for (const BoundJoint& joint : model.joints()) jointFrames.push_back(jointFrame(joint));
    for (const SkinModel::Group& group : model.groups()) {
        const std::size_t blockRows = rowsPerBlock(group.partialCount);
        const glm::dmat3 frame = restFrame(model, group);
        const std::size_t first = rows.size();
        const std::size_t blocks = (group.vertexCount + kBlock - 1) / kBlock;
        const ChainPlan::Group& planned = plan.groups[groups.size()];
        groups.push_back({first, static_cast<std::uint32_t>(firstBlock.back()), group.firstVertex,
                          group.vertexCount, planned.firstLink, frameOf(model, group), planned.lead,
                          static_cast<std::uint16_t>(group.partialCount)});
        firstBlock.push_back(firstBlock.back() + blocks);
        rows.resize(first + blocks * blockRows, BlockRow{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row)
            place(model, group, row, frame, &rows[first + row / kBlock * blockRows]);
    }
}

} // namespace osgSkin
