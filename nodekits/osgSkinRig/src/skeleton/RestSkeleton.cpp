// SPDX-License-Identifier: MIT
#include <osgSkinRig/RestSkeleton>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>

#include <cmath>
#include <set>

namespace osgSkin {

int RestSkeleton::add(const std::string& name, int parent, const glm::dvec3& centre) {
    joints.push_back({name, parent, centre, {}});
    return static_cast<int>(joints.size()) - 1;
}

int RestSkeleton::add(const std::string& name, int parent, const osg::Vec3d& centre) {
    return add(name, parent, toGlm(centre));
}

int RestSkeleton::find(const std::string& name) const {
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].name == name) return static_cast<int>(j);
    return -1;
}

std::map<std::string, int> RestSkeleton::byName() const {
    std::map<std::string, int> result;
    for (std::size_t j = 0; j < joints.size(); ++j)
        result.emplace(joints[j].name, static_cast<int>(j));
    return result;
}

std::vector<int> RestSkeleton::children(int joint) const {
    std::vector<int> result;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].parent == joint) result.push_back(static_cast<int>(j));
    return result;
}

bool RestSkeleton::isInSubtree(int joint, int ancestor) const {
    while (joint >= 0 && joint != ancestor) joint = joints[static_cast<std::size_t>(joint)].parent;
    return joint == ancestor;
}

void RestSkeleton::validate() const {
    if (joints.empty()) throw Error("skeleton: no joint, expected at least one");
    std::set<std::string> names;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const RestJoint& joint = joints[j];
        const std::string label =
            "skeleton: joint " + std::to_string(j) + " \"" + joint.name + "\"";
        if (j == 0 && joint.parent != -1)
            throw Error(label + " comes first but has a parent, expected the root");
        if (j > 0 && (joint.parent < 0 || joint.parent >= static_cast<int>(j)))
            throw Error(label + " has parent " + std::to_string(joint.parent) +
                        ", expected one of the joints before it (one root, no cycle)");
        if (!names.insert(joint.name).second)
            throw Error(label + " has the name of another joint, expected unique names");
        if (!isFinite(joint.centre)) throw Error(label + " has a centre that is not finite");
        if (!isInRange(joint.centre)) throw Error(label + " has a centre beyond -1e18 to 1e18");
        if (joint.tip && !isInRange(*joint.tip))
            throw Error(label + " has a tip that is not finite, or beyond -1e18 to 1e18");
        if (!(std::abs(glm::dot(joint.frame, joint.frame) - 1.0) <= 2e-3)) // for NaN, too
            throw Error(label + " has axes whose rotation is not unit");
    }
}

void worldRotations(const RestSkeleton& skeleton, const glm::dquat* local,
                    std::vector<glm::dquat>& world) {
    world.resize(skeleton.joints.size());
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = skeleton.joints[j].parent;
        world[j] = parent < 0 ? local[j]
                              : glm::normalize(world[static_cast<std::size_t>(parent)] * local[j]);
    }
}

void worldPositions(const RestSkeleton& skeleton, const std::vector<glm::dquat>& world,
                    const glm::dvec3& root, std::vector<glm::dvec3>& positions) {
    worldPositions(skeleton, world, root, {}, 0, positions);
}

void worldPositions(const RestSkeleton& skeleton, const std::vector<glm::dquat>& world,
                    const glm::dvec3& root, const JointMoves& moves, std::size_t frame,
                    std::vector<glm::dvec3>& positions) {
    positions.resize(skeleton.joints.size());
    auto move = moves.begin();
    for (std::size_t j = 0; j < positions.size(); ++j) {
        const RestJoint& joint = skeleton.joints[j];
        if (joint.parent < 0) {
            positions[j] = root;
            continue;
        }
        const auto p = static_cast<std::size_t>(joint.parent);
        while (move != moves.end() && move->first < j) ++move;
        const bool moved = move != moves.end() && move->first == j;
        positions[j] = positions[p] + world[p] * (moved ? move->second[frame]
                                                        : joint.centre - skeleton.joints[p].centre);
    }
}

} // namespace osgSkin
