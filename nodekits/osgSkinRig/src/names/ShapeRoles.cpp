// SPDX-License-Identifier: MIT
#include "names/RoleTree.h"

#include "skeleton/SkeletonTree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgSkin {
namespace {

constexpr double kAlike = 0.15;        ///< largest difference of two limbs, in their length
constexpr double kShortestLimb = 0.15; ///< length of a limb, in the skeleton's reach
constexpr double kUpright = 0.64;      ///< cosine between trunk and legs: a quadruped's is near 0
constexpr double kApart = 0.12;     ///< least distance of both limbs' first joints, in their length
constexpr double kToesPoint = 0.05; ///< leg lengths
// Limits on the search. Chains of hair and skirts are many, but shorter than limbs.
constexpr std::size_t kMaxLimbs = 24;  ///< of one joint; the longest are kept
constexpr std::size_t kMaxPairs = 256; ///< the longest

using Chain = std::vector<int>;

struct Pair {
    int base;          ///< the joint that carries both
    Chain left, right; ///< either side first
    double length;
    std::size_t upper; ///< which joint of both chains begins the two long bones
};

class Shape {
public:
    explicit Shape(const RestSkeleton& skeleton)
        : _tree(skeleton), _length(skeleton.joints.size(), 0.0) {
        for (int j = _tree.size() - 1; j >= 0; --j) {
            const RestJoint& joint = _tree.joint(j);
            double& own = _length[static_cast<std::size_t>(j)];
            if (joint.tip) own = std::max(own, glm::distance(joint.centre, *joint.tip));
            for (const int child : _tree.children(j)) own = std::max(own, through(child));
        }
    }

    std::vector<std::string> roles() {
        findPairs();
        const Pair *legs = nullptr, *arms = nullptr;
        for (const Pair& lower : _pairs)
            for (const Pair& upper : _pairs) {
                if (!isFigure(lower, upper)) continue;
                const double sum = lower.length + upper.length;
                if (legs != nullptr && legs->length + arms->length >= sum) continue;
                legs = &lower;
                arms = &upper;
            }
        if (legs == nullptr) return {};
        const Chain head = headChain(*legs, *arms);
        if (head.empty()) return {};
        return named(*legs, *arms, head);
    }

private:
    /// From a joint's parent through it to the end of its longest chain.
    double through(int child) const {
        return glm::distance(_tree.centre(child), _tree.centre(_tree.joint(child).parent)) +
               _length[static_cast<std::size_t>(child)];
    }

    Chain chainFrom(int j) const {
        Chain chain{j};
        while (!_tree.children(chain.back()).empty()) {
            const std::vector<int>& children = _tree.children(chain.back());
            chain.push_back(*std::max_element(children.begin(), children.end(), [&](int a, int b) {
                return through(a) < through(b);
            }));
        }
        return chain;
    }

    /// Whether both chains are mirror images in a plane through the joint that carries them.
    bool mirror(int base, const Chain& a, const Chain& b, double length) const {
        const std::size_t count = std::min(a.size(), b.size());
        glm::dvec3 across(0.0);
        for (std::size_t i = 0; i < count; ++i) across += _tree.centre(a[i]) - _tree.centre(b[i]);
        if (!(glm::length(across) > kAlike * length)) return false;
        across = glm::normalize(across);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 apart = _tree.centre(a[i]) - _tree.centre(b[i]);
            const glm::dvec3 middle =
                0.5 * (_tree.centre(a[i]) + _tree.centre(b[i])) - _tree.centre(base);
            if (glm::length(apart - glm::dot(apart, across) * across) > kAlike * length ||
                std::abs(glm::dot(middle, across)) > kAlike * length)
                return false;
        }
        return true;
    }

    void findPairs() {
        for (int base = 0; base < _tree.size(); ++base) {
            const std::vector<Chain> limbs = limbsOf(base);
            for (std::size_t i = 0; i < limbs.size(); ++i)
                for (std::size_t k = i + 1; k < limbs.size(); ++k) {
                    const Chain &a = limbs[i], &b = limbs[k];
                    const double length = std::min(through(a.front()), through(b.front()));
                    const double longer = std::max(through(a.front()), through(b.front()));
                    if (longer <= (1.0 + kAlike) * length && mirror(base, a, b, length))
                        _pairs.push_back({base, a, b, length, upperOf(a, b, length)});
                }
        }
        keepLongest(_pairs, kMaxPairs, [](const Pair& pair) { return pair.length; });
    }

    /// The chains below a joint that are long enough for limbs.
    std::vector<Chain> limbsOf(int base) const {
        std::vector<Chain> limbs;
        for (const int child : _tree.children(base))
            if (through(child) >= kShortestLimb * _tree.reach()) limbs.push_back({child});
        keepLongest(limbs, kMaxLimbs, [&](const Chain& limb) { return through(limb.front()); });
        for (Chain& limb : limbs) limb = chainFrom(limb.front());
        limbs.erase(std::remove_if(limbs.begin(), limbs.end(),
                                   [](const Chain& limb) { return limb.size() < 3; }),
                    limbs.end());
        return limbs;
    }

    /// Keeps only so many, the longest first; fewer stay in their order.
    template <typename Item, typename Length>
    static void keepLongest(std::vector<Item>& items, std::size_t most, const Length& length) {
        if (items.size() <= most) return;
        std::stable_sort(items.begin(), items.end(),
                         [&](const Item& a, const Item& b) { return length(a) > length(b); });
        items.erase(items.begin() + static_cast<std::ptrdiff_t>(most), items.end());
    }

    glm::dvec3 upOf(const Pair& legs) const {
        const glm::dvec3 ends =
            _tree.centre(legs.left[legs.upper + 2]) + _tree.centre(legs.right[legs.upper + 2]);
        const glm::dvec3 starts =
            _tree.centre(legs.left[legs.upper]) + _tree.centre(legs.right[legs.upper]);
        return glm::normalize(starts - ends);
    }

    /// The joint of a limb at which its two long bones begin. Collar bones and hip joints begin in
    /// the middle of the body.
    std::size_t upperOf(const Chain& chain, const Chain& twin, double length) const {
        std::size_t best = 0;
        double longest = -1.0;
        const std::size_t count = std::min(chain.size(), twin.size());
        for (std::size_t i = 0; i + 2 < count; ++i) {
            const double apart = glm::distance(_tree.centre(chain[i]), _tree.centre(twin[i]));
            if (apart < kApart * length && i + 3 < count) continue;
            const double sum =
                glm::distance(_tree.centre(chain[i]), _tree.centre(chain[i + 1])) +
                glm::distance(_tree.centre(chain[i + 1]), _tree.centre(chain[i + 2]));
            if (sum > longest * (1.0 + 1e-9)) {
                longest = sum;
                best = i;
            }
        }
        return best;
    }

    bool isFigure(const Pair& legs, const Pair& arms) const {
        if (legs.base == arms.base || _tree.rest().isInSubtree(legs.base, arms.base)) return false;
        for (const Pair* pair : {&legs, &arms})
            for (const Chain* limb : {&pair->left, &pair->right})
                if (_tree.rest().isInSubtree((pair == &legs ? arms : legs).base, limb->front()))
                    return false;
        const glm::dvec3 trunk = _tree.centre(arms.base) - _tree.centre(legs.base);
        return glm::dot(trunk, upOf(legs)) > kUpright * glm::length(trunk) &&
               glm::length(trunk) > 0.1 * legs.length;
    }

    /// From the joint above the one that carries the arms to the head.
    Chain headChain(const Pair& legs, const Pair& arms) const {
        const glm::dvec3 up = upOf(legs);
        Chain best;
        double highest = 0.0;
        for (const int child : _tree.children(arms.base)) {
            if (child == arms.left.front() || child == arms.right.front()) continue;
            if (_tree.rest().isInSubtree(legs.base, child)) continue;
            const Chain chain = chainFrom(child);
            const RestJoint& last = _tree.joint(chain.back());
            const glm::dvec3 end = last.tip ? *last.tip : last.centre;
            const double height = glm::dot(end - _tree.centre(arms.base), up);
            if (height <= highest) continue;
            highest = height;
            best = chain;
        }
        // Eyes and a jaw are children of the head.
        for (std::size_t i = 0; i < best.size(); ++i)
            if (_tree.children(best[i]).size() > 1) best.resize(i + 1);
        // A last joint may only mark the crown.
        if (best.size() > 2 && !_tree.joint(best.back()).tip &&
            glm::distance(_tree.centre(best.end()[-1]), _tree.centre(best.end()[-2])) >
                1.2 * glm::distance(_tree.centre(best.end()[-2]), _tree.centre(best.end()[-3])))
            best.pop_back();
        return best;
    }

    /// Direction to the left, found by the toes; else +x, which is left for figures that face +z
    /// with +y up or -y with +z up.
    glm::dvec3 leftward(const Pair& legs) const {
        const glm::dvec3 up = upOf(legs);
        glm::dvec3 forward(0.0);
        for (const Chain* leg : {&legs.left, &legs.right}) {
            const int ankle = (*leg)[legs.upper + 2];
            const RestJoint& foot = _tree.joint(ankle);
            const RestJoint& last = _tree.joint(leg->back());
            const glm::dvec3 toes = (last.tip ? *last.tip : last.centre) - foot.centre;
            forward += toes - glm::dot(toes, up) * up;
        }
        if (glm::length(forward) < kToesPoint * legs.length) return {1.0, 0.0, 0.0};
        return glm::cross(up, glm::normalize(forward));
    }

    std::vector<std::string> named(const Pair& legs, const Pair& arms, const Chain& head) const {
        std::vector<std::string> roles(_length.size());
        const auto role = [&](int j) -> std::string& { return roles[static_cast<std::size_t>(j)]; };
        const int hips = commonAncestor(_tree.rest(), legs.base, arms.base);
        for (int j = arms.base; j != hips; j = _tree.joint(j).parent) role(j) = "Spine";
        role(hips) = "Hips";
        for (const int j : head) role(j) = "Neck";
        role(head.back()) = "Head";
        const glm::dvec3 left = leftward(legs);
        for (const Pair* pair : {&legs, &arms}) {
            const glm::dvec3 across = _tree.centre(pair->left[pair->upper + 1]) -
                                      _tree.centre(pair->right[pair->upper + 1]);
            const bool swapped = glm::dot(across, left) < 0.0;
            const bool isLeg = pair == &legs;
            nameLimb(swapped ? pair->right : pair->left, pair->upper, "Left", isLeg, roles);
            nameLimb(swapped ? pair->left : pair->right, pair->upper, "Right", isLeg, roles);
        }
        return roles;
    }

    void nameLimb(const Chain& chain, std::size_t upper, const std::string& side, bool isLeg,
                  std::vector<std::string>& roles) const {
        static const char* const kLeg[] = {"HipJoint", "UpperLeg", "LowerLeg", "Foot", "Toe"};
        static const char* const kArm[] = {"Collar", "UpperArm", "LowerArm", "Hand"};
        for (std::size_t part = 0; part < (isLeg ? 5u : 4u); ++part) {
            if (upper + part < 1 || upper + part - 1 >= chain.size()) continue;
            roles[static_cast<std::size_t>(chain[upper + part - 1])] =
                side + (isLeg ? kLeg[part] : kArm[part]);
        }
    }

    SkeletonTree _tree;
    std::vector<double> _length; ///< of the longest chain below, [joint]
    std::vector<Pair> _pairs;
};

} // namespace

std::vector<std::string> shapeRoles(const RestSkeleton& skeleton) {
    if (skeleton.joints.empty()) return {};
    return Shape(skeleton).roles();
}

} // namespace osgSkin
