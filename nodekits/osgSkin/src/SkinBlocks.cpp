// SPDX-License-Identifier: MIT
#include "SkinBlocks.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// e1, e2, w: any two directions that make a right-handed frame with the twist axis w.
glm::dmat3 frameAbout(const glm::dvec3& axis) {
    const glm::dvec3 w = glm::normalize(axis);
    const glm::dvec3 helper = std::abs(w.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 e1 = glm::normalize(glm::cross(helper, w));
    return {e1, glm::cross(w, e1), w};
}

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

/// Writes one vertex into its lane of its block.
void place(const SkinModel& model, const SkinModel::Group& group, std::uint32_t row,
           const std::vector<glm::dmat3>& frames, BlockRow* block) {
    const std::uint32_t v = model.order()[group.firstVertex + row];
    glm::dvec3 p = glm::dvec3(model.positions()[v]);
    glm::dvec3 n = glm::dvec3(model.normals()[v]);
    if (isInJointFrame(model, group)) {
        const std::uint32_t joint = model.links()[group.firstLink + group.linkCount - 1].joint;
        p = (p - model.joints()[joint].centre) * frames[joint]; // transposed: into the frame
        n = n * frames[joint];
    }
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

SkinBlocks::SkinBlocks(const SkinModel& model)
    : inOrder(isIdentity(model.order())), smallMove(1e-9 * largestCoordinate(model)) {
    for (const BoundJoint& joint : model.joints())
        jointFrames.push_back(frameAbout(joint.twistAxis));
    for (const SkinModel::Group& group : model.groups()) {
        const std::size_t blockRows = rowsPerBlock(group.partialCount);
        const std::size_t first = rows.size();
        firstRow.push_back(first);
        rows.resize(first + (group.vertexCount + kBlock - 1) / kBlock * blockRows, BlockRow{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row)
            place(model, group, row, jointFrames, &rows[first + row / kBlock * blockRows]);
    }
}

} // namespace osgSkin
