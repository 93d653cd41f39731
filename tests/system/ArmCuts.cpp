// SPDX-License-Identifier: MIT
#include "ArmCuts.h"

#include "DrawnSkin.h"

#include <osg/BoundingBox>
#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <string>

namespace test {
namespace {

/// [joint], whether it descends from a joint of one of the roles.
std::vector<bool> below(const osgSkin::RestSkeleton& rest, const osgSkin::JointRoles& roles,
                        const std::vector<std::string>& wanted) {
    std::vector<bool> result(rest.joints.size());
    for (std::size_t j = 0; j < result.size(); ++j)
        result[j] =
            std::count(wanted.begin(), wanted.end(), roles.roles[j]) > 0 ||
            (rest.joints[j].parent >= 0 && result[static_cast<std::size_t>(rest.joints[j].parent)]);
    return result;
}

bool edgeCuts(const osg::Vec3d& from, const osg::Vec3d& to, const osg::Vec3d& a,
              const osg::Vec3d& b, const osg::Vec3d& c) {
    const osg::Vec3d normal = (b - a) ^ (c - a);
    const double before = normal * (from - a), behind = normal * (to - a);
    if (before * behind >= 0.0) return false;
    const osg::Vec3d way = to - from;
    const double u = way * ((a - from) ^ (b - from));
    const double v = way * ((b - from) ^ (c - from));
    const double w = way * ((c - from) ^ (a - from));
    return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

} // namespace

ArmCuts::ArmCuts(const osgSkin::Character& character)
    : _character(character), _places(character.body.mesh.positions.size()) {
    const osgSkin::JointRoles roles = osgSkin::recogniseJoints(character.rest);
    const std::vector<bool> forearm =
        below(character.rest, roles, {"LeftLowerArm", "RightLowerArm"});
    const std::vector<bool> limb = below(
        character.rest, roles, {"LeftUpperArm", "RightUpperArm", "LeftLowerLeg", "RightLowerLeg"});
    const std::vector<std::uint32_t> corners = character.body.mesh.triangles();
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const Triangle t{corners[i], corners[i + 1], corners[i + 2]};
        const auto in = [&](const std::vector<bool>& joints) {
            return std::count_if(t.begin(), t.end(), [&](std::uint32_t v) {
                return joints[character.binding.regions[v]];
            });
        };
        if (in(forearm) == 3) _arms.push_back(t);
        if (in(limb) == 0) _body.push_back(t);
    }
}

bool ArmCuts::cut(const Triangle& a, const Triangle& b) const {
    const auto cuts = [this](const Triangle& edges, const Triangle& face) {
        for (std::size_t k = 0; k < 3; ++k)
            if (edgeCuts(_places[edges[k]], _places[edges[(k + 1) % 3]], _places[face[0]],
                         _places[face[1]], _places[face[2]]))
                return true;
        return false;
    };
    return cuts(a, b) || cuts(b, a);
}

std::size_t ArmCuts::count() {
    forEachCopy(_character,
                [this](std::uint32_t v, const osg::Vec3d& place) { _places[v] = place; });
    const auto boxOf = [this](const Triangle& t) {
        osg::BoundingBoxd box;
        for (const std::uint32_t v : t) box.expandBy(_places[v]);
        return box;
    };
    osg::BoundingBoxd all;
    std::vector<osg::BoundingBoxd> arms;
    for (const Triangle& t : _arms) all.expandBy(arms.emplace_back(boxOf(t)));
    std::size_t result = 0;
    for (const Triangle& t : _body) {
        const osg::BoundingBoxd box = boxOf(t);
        if (!box.intersects(all)) continue;
        for (std::size_t a = 0; a < arms.size(); ++a)
            if (box.intersects(arms[a]) && cut(_arms[a], t)) ++result;
    }
    return result;
}

} // namespace test
