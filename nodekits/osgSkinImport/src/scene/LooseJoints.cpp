// SPDX-License-Identifier: MIT
// Attaches joints that an editor's constraints held in place.
#include "scene/SourceScene.h"

#include "files/FileText.h"
#include "scene/SceneSkeleton.h"
#include "scene/SceneTracks.h"

#include <osgSkinRig/JointRoles>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// Joints closer than this fraction of the skeleton's extent are at one point.
constexpr double kSamePoint = 1e-5;

/// Keys are added between those of the file, at most this many a second and this many at a time: a
/// foot that stays on the floor does not move along a straight line relative to its shin.
constexpr double kKeysPerSecond = 60.0;
constexpr double kMaxBetween = 8.0;

/// A joint and the one that it should follow; indices in the skeleton, then in the scene.
struct Loose {
    int joint, carrier;
};

bool areApart(const RestSkeleton& rest, int a, int b) {
    return !rest.isInSubtree(a, b) && !rest.isInSubtree(b, a);
}

double distanceOf(const RestSkeleton& rest, int a, int b) {
    return glm::distance(rest.joints[static_cast<std::size_t>(a)].centre,
                         rest.joints[static_cast<std::size_t>(b)].centre);
}

/// Where thighs hang on the rig's root beside the hips, as in Rigify's deformation bones, all
/// children of the root hang on the joint of the trunk that is nearest.
void findLooseParts(const RestSkeleton& rest, const JointRoles& roles, std::vector<Loose>& result) {
    const int hips = roles.joint("Hips"), left = roles.joint("LeftUpperLeg"),
              right = roles.joint("RightUpperLeg");
    if (hips < 0 || left < 0 || right < 0) return;
    const auto parent = [&rest](int joint) {
        return rest.joints[static_cast<std::size_t>(joint)].parent;
    };
    const int root = parent(hips);
    if (root < 0 || parent(left) != root || parent(right) != root) return;
    const int head = roles.joint("Head");
    for (const int child : rest.children(root)) {
        if (rest.isInSubtree(hips, child)) continue;
        const std::string& role = roles.roles[static_cast<std::size_t>(child)];
        const auto ends = [&role](const char* part) {
            return role.size() > 4 && role.find(part) != std::string::npos;
        };
        int carrier = hips;
        const auto offer = [&](const std::string& to) {
            constexpr double kLong = 0.5; // a head is longer than a vertebra
            const auto reach = [&](int joint) {
                return distanceOf(rest, child, joint) * (joint == head ? kLong : 1.0);
            };
            const auto found = roles.joints.find(to);
            if (found == roles.joints.end()) return;
            for (const int joint : found->second)
                if (reach(joint) < reach(carrier)) carrier = joint;
        };
        const bool isArm = ends("Collar") || ends("UpperArm");
        if (!ends("UpperLeg")) offer("Spine");
        if (!ends("UpperLeg") && !isArm) {
            offer("Neck");
            offer("Head");
        }
        const int collar = roles.joint(role.substr(0, role.find("Upper")) + "Collar");
        if (ends("UpperArm") && collar >= 0) carrier = collar;
        result.push_back({child, carrier});
    }
}

/// Joints of arms and legs that are not below their limb's previous bone.
void findLooseLimbs(const RestSkeleton& rest, const JointRoles& roles, std::vector<Loose>& result) {
    const std::vector<const char*> limbs[] = {{"UpperLeg", "LowerLeg", "Foot", "Toe"},
                                              {"UpperArm", "LowerArm", "Hand"}};
    for (const std::string side : {"Left", "Right"})
        for (const std::vector<const char*>& limb : limbs)
            for (std::size_t k = 1; k < limb.size(); ++k) {
                const auto above = roles.joints.find(side + limb[k - 1]);
                const auto below = roles.joints.find(side + limb[k]);
                if (above == roles.joints.end() || below == roles.joints.end()) continue;
                const auto isLoose = [&](int joint) {
                    return std::all_of(above->second.begin(), above->second.end(),
                                       [&](int other) { return areApart(rest, joint, other); });
                };
                if (std::all_of(below->second.begin(), below->second.end(), isLoose))
                    result.push_back({below->second.front(), above->second.front()});
            }
}

/// The name of the joint whose rotations MMD copies to this one: "左足" for "左足D", "Knee.L" for
/// "KneeD.L"; empty if the name has no such "D".
std::string copiedName(const std::string& name) {
    std::size_t end = name.size();
    if (end > 2 && (name[end - 1] == 'L' || name[end - 1] == 'R') &&
        (name[end - 2] == '.' || name[end - 2] == '_'))
        end -= 2;
    if (end < 2 || name[end - 1] != 'D') return {};
    std::size_t begin = end - 1;
    if (name[begin - 1] == '_' || name[begin - 1] == '.' || name[begin - 1] == ' ') --begin;
    return name.substr(0, begin) + name.substr(end);
}

void findLooseCopies(const RestSkeleton& rest, std::vector<Loose>& result) {
    const std::map<std::string, int> byName = rest.byName();
    double extent = 0.0;
    for (const RestJoint& joint : rest.joints)
        extent = std::max(extent, glm::distance(joint.centre, rest.joints[0].centre));
    for (std::size_t j = 0; j < rest.joints.size(); ++j) {
        const auto original = byName.find(copiedName(rest.joints[j].name));
        if (original == byName.end() || !areApart(rest, static_cast<int>(j), original->second))
            continue;
        const glm::dvec3& centre = rest.joints[static_cast<std::size_t>(original->second)].centre;
        if (glm::distance(rest.joints[j].centre, centre) <= kSamePoint * extent)
            result.push_back({static_cast<int>(j), original->second});
    }
}

using Tracks = std::map<std::string, const SourceTrack*>;

template <typename Value, typename Key>
Value valueOr(const std::vector<Key>& keys, double time, const Value& otherwise) {
    return keys.empty() ? otherwise : valueAt<Value>(keys, {time, 0.0});
}

class Attacher {
public:
    explicit Attacher(SourceScene& scene) : _scene(scene) {
        for (const auto& animation : scene.animations)
            _animations.push_back(std::make_shared<SourceAnimation>(*animation));
    }

    ~Attacher() { _scene.animations.assign(_animations.begin(), _animations.end()); }

    /// Attaches a node, which keeps its place and its motion; false if it cannot be attached.
    bool attach(const Loose& loose) {
        std::vector<int> own = pathTo(loose.joint), other = pathTo(loose.carrier);
        if (std::find(other.begin(), other.end(), loose.joint) != other.end()) return false;
        while (!own.empty() && !other.empty() && own.back() == other.back()) { // the common nodes
            own.pop_back();
            other.pop_back();
        }
        const glm::dmat4 local = glm::inverse(product(other, {}, 0.0)) * product(own, {}, 0.0);
        if (!std::isfinite(glm::determinant(local))) return false;
        for (const auto& animation : _animations) keepMotion(own, other, *animation);
        SourceNode& node = at(loose.joint);
        std::vector<int>& siblings = at(node.parent).children;
        siblings.erase(std::find(siblings.begin(), siblings.end(), loose.joint));
        at(loose.carrier).children.push_back(loose.joint);
        node.parent = loose.carrier;
        node.matrix = local;
        return true;
    }

private:
    SourceNode& at(int node) { return _scene.nodes[static_cast<std::size_t>(node)]; }

    /// A node and its ancestors, up to the root.
    std::vector<int> pathTo(int node) {
        std::vector<int> result;
        for (; node >= 0; node = at(node).parent) result.push_back(node);
        return result;
    }

    /// From the first node of a path to the parent of the last, at a time in ticks.
    glm::dmat4 product(const std::vector<int>& path, const Tracks& tracks, double time) {
        glm::dmat4 result(1.0);
        for (const int n : path) {
            const SourceNode& node = at(n);
            const auto track = tracks.find(node.name);
            if (track == tracks.end()) {
                result = node.matrix * result;
                continue;
            }
            const NodeTransform rest = decompose(node.matrix);
            const SourceTrack& keys = *track->second;
            glm::dmat4 local =
                glm::mat4_cast(glm::normalize(valueOr(keys.rotations, time, rest.rotation)));
            const glm::dvec3 scale = valueOr(keys.scales, time, rest.scale);
            for (int axis = 0; axis < 3; ++axis) local[axis] *= scale[axis];
            local[3] = glm::dvec4(valueOr(keys.positions, time, rest.translation), 1.0);
            result = local * result;
        }
        return result;
    }

    /// The times of the keys on both paths, in ticks, and more between them.
    std::vector<double> timesOf(const std::vector<int>& own, const std::vector<int>& other,
                                const Tracks& tracks, double ticksPerSecond) {
        std::vector<double> times;
        const auto add = [&times](const auto& keys) {
            for (const auto& key : keys) // a single key is constant
                if (keys.size() > 1 && std::isfinite(key.time)) times.push_back(key.time);
        };
        for (const std::vector<int>* path : {&own, &other})
            for (const int n : *path) {
                const auto track = tracks.find(at(n).name);
                if (track == tracks.end()) continue;
                add(track->second->positions);
                add(track->second->rotations);
                add(track->second->scales);
            }
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
        if (times.empty()) return {0.0};
        std::vector<double> result;
        for (std::size_t i = 0; i + 1 < times.size(); ++i) {
            const double span = times[i + 1] - times[i];
            const double steps =
                std::clamp(std::ceil(span / ticksPerSecond * kKeysPerSecond), 1.0, kMaxBetween);
            for (double s = 0.0; s < steps; s += 1.0) result.push_back(times[i] + s / steps * span);
        }
        result.push_back(times.back());
        return result;
    }

    /// Rewrites the track of the first node of `own` for the first of `other` as its parent. A node
    /// that the animation does not move gets no track: it follows its new parent.
    void keepMotion(const std::vector<int>& own, const std::vector<int>& other,
                    SourceAnimation& animation) {
        Tracks tracks;
        for (const SourceTrack& track : animation.tracks) tracks.emplace(track.node, &track);
        if (std::none_of(own.begin(), own.end(),
                         [&](int n) { return tracks.count(at(n).name) != 0; }))
            return;
        SourceTrack result;
        result.node = at(own.front()).name;
        for (const double time : timesOf(own, other, tracks, animation.ticksPerSecond)) {
            const NodeTransform local =
                decompose(glm::inverse(product(other, tracks, time)) * product(own, tracks, time));
            result.positions.push_back({time, glm::vec3(local.translation)});
            result.rotations.push_back({time, glm::quat(local.rotation)});
            result.scales.push_back({time, glm::vec3(local.scale)});
        }
        const auto old =
            std::find_if(animation.tracks.begin(), animation.tracks.end(),
                         [&result](const SourceTrack& track) { return track.node == result.node; });
        if (old != animation.tracks.end())
            *old = std::move(result);
        else
            animation.tracks.push_back(std::move(result));
    }

    SourceScene& _scene;
    std::vector<std::shared_ptr<SourceAnimation>> _animations;
};

} // namespace

void attachLooseJoints(SourceScene& scene, const std::string& path, const ReadLimits& limits) {
    const SceneSkeleton skeleton = findSceneSkeleton(scene);
    if (skeleton.nodes.empty() || skeleton.nodes.size() > limits.joints) return;
    std::vector<Loose> loose;
    const JointRoles roles = recogniseJoints(skeleton.rest);
    findLooseParts(skeleton.rest, roles, loose);
    findLooseLimbs(skeleton.rest, roles, loose);
    findLooseCopies(skeleton.rest, loose);
    if (loose.empty()) return;
    const auto nodeOf = [&](int joint) {
        return static_cast<int>(skeleton.nodes[static_cast<std::size_t>(joint)] -
                                scene.nodes.data());
    };
    Attacher attacher(scene);
    std::size_t attached = 0;
    std::string first;
    for (const Loose& pair : loose) {
        if (!attacher.attach({nodeOf(pair.joint), nodeOf(pair.carrier)})) continue;
        const auto nameOf = [&](int joint) {
            return inQuotes(skeleton.rest.joints[static_cast<std::size_t>(joint)].name);
        };
        if (attached++ == 0) first = nameOf(pair.joint) + " follows " + nameOf(pair.carrier);
    }
    if (attached > 0)
        warn(path, std::to_string(attached) +
                       " joints are not below the limb that they belong to, and are attached "
                       "to it: " +
                       first);
}

} // namespace osgSkin
