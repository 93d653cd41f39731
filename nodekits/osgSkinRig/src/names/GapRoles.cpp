// SPDX-License-Identifier: MIT
#include "names/GapRoles.h"

#include "names/BodyWord.h"
#include "names/NameWords.h"
#include "names/RoleTree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

class Filler {
public:
    Filler(const RestSkeleton& skeleton, std::vector<std::string>& roles)
        : _skeleton(skeleton), _roles(roles) {}

    void fill() {
        for (const std::string side : {"Left", "Right"}) {
            fillLimb(side + "UpperLeg", side + "LowerLeg", side + "Foot", {side + "Toe"});
            fillLimb(side + "UpperArm", side + "LowerArm", side + "Hand",
                     {side + "Middle1", side + "Index1", side + "Thumb1", side + "Fingers"});
        }
        fillTrunk();
    }

private:
    std::string& role(int j) { return _roles[static_cast<std::size_t>(j)]; }
    const RestJoint& joint(int j) const { return _skeleton.joints[static_cast<std::size_t>(j)]; }

    int find(const std::string& wanted) const {
        const auto found = std::find(_roles.begin(), _roles.end(), wanted);
        return found == _roles.end() ? -1 : static_cast<int>(found - _roles.begin());
    }

    bool isFree(int j) {
        const std::vector<std::string> words = nameWords(joint(j).name);
        return role(j).empty() && !isPivot(joint(j).name) &&
               std::none_of(words.begin(), words.end(), isForeign);
    }

    /// The free joints between two, the lower one first; none where `below` is not below `above`.
    std::vector<int> freeBetween(int above, int below) {
        std::vector<int> result;
        if (above < 0 || below < 0 || !_skeleton.isInSubtree(below, above)) return result;
        for (int j = joint(below).parent; j >= 0 && j != above; j = joint(j).parent)
            if (isFree(j)) result.push_back(j);
        return result;
    }

    /// Of the free joints between two the one that is nearest to the middle of the way.
    int middle(int above, int below) {
        int best = -1;
        double nearest = 0.0;
        for (const int j : freeBetween(above, below)) {
            const double off = std::abs(glm::distance(joint(j).centre, joint(above).centre) -
                                        glm::distance(joint(j).centre, joint(below).centre));
            if (best >= 0 && off >= nearest) continue;
            best = j;
            nearest = off;
        }
        return best;
    }

    /// The free joint right above what hangs on a hand or a foot, or else the only child.
    int endOf(int lower, const std::vector<std::string>& below) {
        for (const std::string& hung : below) {
            const std::vector<int> way = freeBetween(lower, find(hung));
            if (!way.empty()) return way.front();
        }
        int only = -1;
        for (const int child : _skeleton.children(lower)) {
            if (!isFree(child)) continue;
            if (only >= 0) return -1;
            only = child;
        }
        return only;
    }

    void fillLimb(const std::string& upper, const std::string& lower, const std::string& end,
                  const std::vector<std::string>& below) {
        const int top = find(upper);
        if (find(end) < 0 && find(lower) >= 0) give(endOf(find(lower), below), end);
        if (find(lower) < 0) give(middle(top, find(end)), lower);
    }

    void fillTrunk() {
        const int left = find("LeftUpperArm"), right = find("RightUpperArm");
        if (left < 0 || right < 0) return;
        const int hips = find("Hips"), chest = commonAncestor(_skeleton, left, right);
        if (chest < 0 || chest == hips) return;
        if (hips >= 0 && _skeleton.isInSubtree(chest, hips)) {
            for (const int j : freeBetween(hips, chest)) give(j, "Spine");
            if (isFree(chest)) give(chest, "Spine");
        }
        for (const int j : freeBetween(chest, find("Head"))) give(j, "Neck");
        for (const auto& [side, arm] : {std::make_pair("Left", left), {"Right", right}}) {
            const std::vector<int> way = freeBetween(chest, arm);
            const std::string collar = std::string(side) + "Collar";
            if (way.size() == 1 && find(collar) < 0) give(way[0], collar);
        }
    }

    void give(int j, const std::string& to) {
        if (j >= 0) role(j) = to;
    }

    const RestSkeleton& _skeleton;
    std::vector<std::string>& _roles;
};

} // namespace

void fillGaps(const RestSkeleton& skeleton, std::vector<std::string>& roles) {
    Filler(skeleton, roles).fill();
}

} // namespace osgSkin
