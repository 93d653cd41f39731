// SPDX-License-Identifier: MIT
#include <osgSkin/Binding>

#include "model/SkinBlocks.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace osgSkin {
namespace {

bool isUnit(const glm::dvec3& v) {
    return std::abs(glm::dot(v, v) - 1.0) < 1e-9;
}
bool isRatio(float r) {
    return r >= 0.0f && r <= 1.0f;
} // false for NaN too

void validateJoints(const std::vector<BoundJoint>& joints) {
    if (joints.empty()) throw Error("binding: no joint");
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::string place = "binding: joint \"" + joints[j].name + "\"";
        const bool parentFits =
            j == 0 ? joints[j].parent == -1
                   : joints[j].parent >= 0 && joints[j].parent < static_cast<int>(j);
        if (!parentFits) throw Error(place + " does not come after its parent");
        if (!isUnit(joints[j].boneAxis) || !isUnit(joints[j].twistAxis))
            throw Error(place + " has an axis that is not a unit vector");
        if (!isInRange(joints[j].centre))
            throw Error(place + " has a centre that is not finite, or beyond -1e18 to 1e18");
    }
}

void validateGradients(const Binding& binding) {
    if (binding.gradients.empty()) return;
    if (binding.gradients.size() != binding.influences.size())
        throw Error("binding: expected a gradient of each influence or none at all");
    for (const RatioGradient& gradient : binding.gradients)
        if (!std::isfinite(glm::dot(gradient.bend, gradient.bend)) ||
            !std::isfinite(glm::dot(gradient.twist, gradient.twist)))
            throw Error("binding: a gradient is not finite");
}

using Indices = std::vector<std::uint32_t>;

/// How many joints each has in its subtree, itself too.
std::vector<std::size_t> subtreeSizes(const std::vector<BoundJoint>& joints) {
    std::vector<std::size_t> sizes(joints.size(), 1);
    for (std::size_t j = joints.size(); j-- > 1;)
        sizes[static_cast<std::size_t>(joints[j].parent)] += sizes[j];
    return sizes;
}

void sortSiblings(const std::vector<BoundJoint>& joints, const std::vector<std::size_t>& sizes,
                  Indices& siblings) {
    std::map<std::size_t, int> alike;
    for (const std::uint32_t j : siblings) ++alike[sizes[j]];
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const bool aHasTwin = alike[sizes[a]] > 1, bHasTwin = alike[sizes[b]] > 1;
        if (aHasTwin != bHasTwin) return bHasTwin;
        return joints[a].name < joints[b].name;
    };
    std::stable_sort(siblings.begin(), siblings.end(), before);
}

/// The direction from the joint above to the middle of each joint's subtree; zero where both are
/// at one place.
std::vector<glm::dvec3> branchDirections(const std::vector<BoundJoint>& joints,
                                         const std::vector<std::size_t>& sizes) {
    std::vector<glm::dvec3> result(joints.size(), glm::dvec3(0.0));
    for (std::size_t j = joints.size(); j-- > 1;) {
        result[j] += joints[j].centre;
        const auto parent = static_cast<std::size_t>(joints[j].parent);
        result[parent] += result[j];
        result[j] = result[j] / double(sizes[j]) - joints[parent].centre;
        const double length = glm::length(result[j]);
        if (length > 0.0) result[j] /= length;
    }
    return result;
}

/// Adds a joint to the first of a few groups whose first joint's branch has nearly its direction,
/// or as a group of its own.
void addAlongside(std::uint32_t joint, const std::vector<glm::dvec3>& directions,
                  std::vector<Indices>& groups) {
    constexpr double kAlongside = 0.5; // 60 degrees
    constexpr std::size_t kTried = 16; // no more branches are so far apart
    for (std::size_t i = 0; i < std::min(groups.size(), kTried); ++i) {
        if (glm::dot(directions[groups[i].front()], directions[joint]) < kAlongside) continue;
        groups[i].push_back(joint);
        return;
    }
    groups.push_back({joint});
}

Indices orderBranches(const std::vector<BoundJoint>& joints, const std::vector<std::size_t>& sizes,
                      const std::vector<glm::dvec3>& directions) {
    std::vector<Indices> children(joints.size());
    for (std::size_t j = 1; j < joints.size(); ++j)
        children[static_cast<std::size_t>(joints[j].parent)].push_back(
            static_cast<std::uint32_t>(j));
    Indices order;
    std::vector<Indices> open; // of joints of branches side by side
    if (!joints.empty()) open.push_back({0});
    while (!open.empty()) { // without recursion: chains may be long
        const Indices group = std::move(open.back());
        open.pop_back();
        order.insert(order.end(), group.begin(), group.end());
        std::vector<Indices> below;
        for (const std::uint32_t j : group) {
            sortSiblings(joints, sizes, children[j]);
            for (const std::uint32_t child : children[j]) addAlongside(child, directions, below);
        }
        open.insert(open.end(), std::make_move_iterator(below.rbegin()),
                    std::make_move_iterator(below.rend()));
    }
    return order;
}

} // namespace

void Binding::validate() const {
    validateJoints(joints);
    const std::size_t vertices = regions.size();
    if (firstInfluence.size() != vertices + 1 || firstInfluence.front() != 0 ||
        firstInfluence.back() != influences.size())
        throw Error("binding: the influences' offsets do not fit the vertices");
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::string place = "binding: vertex " + std::to_string(v);
        if (regions[v] >= joints.size()) throw Error(place + " has no region");
        if (firstInfluence[v] >= firstInfluence[v + 1] || firstInfluence[v + 1] > influences.size())
            throw Error(place + " has no influence, expected at least the root's");
        const Influence& root = influences[firstInfluence[v]];
        if (root.joint != 0 || root.bend != 1.0f || root.twist != 1.0f)
            throw Error(place + " does not follow the root with ratio 1");
        for (std::uint32_t i = firstInfluence[v]; i < firstInfluence[v + 1]; ++i) {
            const Influence& influence = influences[i];
            if (influence.joint >= joints.size())
                throw Error(place + " names a joint that is not there");
            if (i > firstInfluence[v] && influence.joint <= influences[i - 1].joint)
                throw Error(place + " lists its joints out of order");
            if (!isRatio(influence.bend) || !isRatio(influence.twist))
                throw Error(place + " has a ratio outside [0, 1]");
        }
    }
    validateGradients(*this);
    correctives.validate(joints, vertices);
}

std::vector<std::uint32_t> productOrder(const std::vector<BoundJoint>& joints) {
    const std::vector<std::size_t> sizes = subtreeSizes(joints);
    return orderBranches(joints, sizes, branchDirections(joints, sizes));
}

std::vector<std::uint32_t> subtreeOrder(const std::vector<BoundJoint>& joints) {
    const std::vector<glm::dvec3> apart(joints.size(), glm::dvec3(0.0));
    return orderBranches(joints, subtreeSizes(joints), apart);
}

std::vector<std::uint32_t> productPlaces(const std::vector<std::uint32_t>& order) {
    Indices places(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = static_cast<std::uint32_t>(i);
    return places;
}

} // namespace osgSkin
