// SPDX-License-Identifier: MIT
#include "names/RoleTree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

class Settler {
public:
    Settler(const RestSkeleton& skeleton, std::vector<std::string>& roles)
        : _skeleton(skeleton), _roles(roles), _below(roles.size(), 1) {
        for (std::size_t j = roles.size(); j > 1; --j) {
            const int up = skeleton.joints[j - 1].parent;
            if (up >= 0) _below[static_cast<std::size_t>(up)] += _below[j - 1];
        }
    }

    void settle() {
        std::map<std::string, std::vector<int>> joints;
        for (std::size_t j = 0; j < _roles.size(); ++j)
            joints[_roles[j]].push_back(static_cast<int>(j));
        for (const auto& [role, members] : joints)
            if (!role.empty() && role != "Spine" && role != "Neck") keepOne(members);
        findHead();
        findHips();
        keepTrunk();
    }

private:
    std::string& role(int j) { return _roles[static_cast<std::size_t>(j)]; }

    int find(const std::string& wanted) const {
        const auto found = std::find(_roles.begin(), _roles.end(), wanted);
        return found == _roles.end() ? -1 : static_cast<int>(found - _roles.begin());
    }

    /// Several joints may have the same name; the one with most descendants is kept.
    void keepOne(const std::vector<int>& members) {
        int best = members[0];
        for (const int j : members) {
            const bool above = _skeleton.isInSubtree(best, j);
            const bool below = _skeleton.isInSubtree(j, best);
            if (above || (!below && _below[static_cast<std::size_t>(j)] >
                                        _below[static_cast<std::size_t>(best)]))
                best = j;
        }
        for (const int j : members)
            if (j != best) role(j).clear();
    }

    void findHips() {
        const int left = find("LeftUpperLeg"), right = find("RightUpperLeg");
        if (find("Hips") >= 0 || left < 0 || right < 0) return;
        const int above = commonAncestor(_skeleton, left, right);
        if (above < 0 || above == left || above == right) return;
        const int spine = spineNear(left, right, above);
        role(spine >= 0 ? spine : above) = "Hips";
    }

    /// Rigify's deformation bones exported alone all hang on the rig's root, on the floor: its hips
    /// are the spine's joint at the thighs.
    /// \return -1 unless the thighs' common ancestor is far from them, and such a joint is near
    int spineNear(int left, int right, int above) const {
        const auto centre = [&](int j) {
            return _skeleton.joints[static_cast<std::size_t>(j)].centre;
        };
        const glm::dvec3 middle = 0.5 * (centre(left) + centre(right));
        int best = -1;
        for (int j = 0; j < static_cast<int>(_roles.size()); ++j)
            if (_roles[static_cast<std::size_t>(j)] == "Spine" && _skeleton.isInSubtree(j, above) &&
                (best < 0 ||
                 glm::distance(centre(j), middle) < glm::distance(centre(best), middle)))
                best = j;
        constexpr double kFar = 4.0; // times as far as the spine's joint
        const bool isFar =
            best >= 0 && best != above &&
            glm::distance(centre(above), middle) > kFar * glm::distance(centre(best), middle);
        return isFar ? best : -1;
    }

    /// Rigify counts from the hips to the head: "spine.006" is its head.
    void findHead() {
        const int left = find("LeftUpperArm"), right = find("RightUpperArm");
        if (find("Head") >= 0 || left < 0 || right < 0) return;
        const int chest = commonAncestor(_skeleton, left, right);
        if (chest < 0 || role(chest).empty()) return; // a list of names has no order
        int head = -1;
        for (int j = 0; j < static_cast<int>(_roles.size()); ++j)
            if ((role(j) == "Spine" || role(j) == "Neck") && j != chest &&
                _skeleton.isInSubtree(j, chest))
                head = j;
        if (head < 0) return;
        for (int j = head; j >= 0 && j != chest; j = parent(j))
            if (role(j) == "Spine") role(j) = "Neck";
        role(head) = "Head";
    }

    /// Spine and neck lead from the hips to the head; joints of these names beside that line lose
    /// the role. Without a hierarchy (a list of names) all are kept.
    void keepTrunk() {
        int top = find("Head");
        if (top < 0) {
            const int left = find("LeftUpperArm"), right = find("RightUpperArm");
            if (left >= 0 && right >= 0) top = commonAncestor(_skeleton, left, right);
        }
        const auto isTrunk = [&](int j) { return role(j) == "Spine" || role(j) == "Neck"; };
        bool onLine = false;
        for (int j = top; j >= 0; j = parent(j)) onLine = onLine || isTrunk(j);
        if (!onLine) return;
        for (int j = 0; j < static_cast<int>(_roles.size()); ++j)
            if (isTrunk(j) && !_skeleton.isInSubtree(top, j)) role(j).clear();
    }

    int parent(int j) const { return _skeleton.joints[static_cast<std::size_t>(j)].parent; }

    const RestSkeleton& _skeleton;
    std::vector<std::string>& _roles;
    std::vector<std::size_t> _below; ///< joints in the subtree
};

} // namespace

int commonAncestor(const RestSkeleton& skeleton, int a, int b) {
    while (a >= 0 && !skeleton.isInSubtree(b, a))
        a = skeleton.joints[static_cast<std::size_t>(a)].parent;
    return a;
}

void settleRoles(const RestSkeleton& skeleton, std::vector<std::string>& roles) {
    Settler(skeleton, roles).settle();
}

} // namespace osgSkin
