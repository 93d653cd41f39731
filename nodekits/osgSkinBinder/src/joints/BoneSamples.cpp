// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/JointRegions.h"
#include "mesh/SurfaceTree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgSkin {
namespace {

/// Distance between samples along a bone, over the body's extent; a finer one changes little. Even
/// a short bone has kMinSamples.
constexpr double kSpacing = 0.05;
constexpr int kMinSamples = 2;

/// A bone that is shorter than this share of the spacing, and as near to the last sample above it,
/// owns no skin. Chains may have thousands of links.
constexpr double kTiny = 0.02;

/// A bone is inside the skin if at least this share of its samples is.
constexpr double kInside = 0.5;

/// How far samples of a last bone may continue beyond its end, in its own lengths or, if it has
/// none, in lengths of the bone above; and how many there may be.
constexpr double kMaxExtension = 2.0;
constexpr double kMaxSteps = 10.0;

/// A joint with more children, as in an absurd file, has no samples along its bones.
constexpr std::size_t kMaxBones = 64;

/// If there are more samples, those that are near others are left out.
constexpr std::size_t kManySamples = 4096;

std::size_t indexOf(int index) {
    return static_cast<std::size_t>(index);
}

/// Twice the largest distance from the mean of all vertices: about a body's height in any pose.
double extentOf(const WeldedMesh& mesh) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& p : mesh.positions) sum += p;
    const glm::dvec3 mean = sum / static_cast<double>(mesh.vertexCount());
    double farthest = 0.0;
    for (const glm::dvec3& p : mesh.positions)
        farthest = std::max(farthest, glm::distance(p, mean));
    return 2.0 * farthest;
}

/// Removes samples close to those of earlier joints.
void thin(double distance, std::vector<std::vector<glm::dvec3>>& samples) {
    std::vector<glm::dvec3> kept;
    for (std::vector<glm::dvec3>& own : samples) {
        const auto isClose = [&](const glm::dvec3& p) {
            return std::any_of(kept.rbegin(), kept.rend(), [&](const glm::dvec3& other) {
                return glm::distance(p, other) < distance;
            });
        };
        own.erase(std::remove_if(own.begin(), own.end(), isClose), own.end());
        kept.insert(kept.end(), own.begin(), own.end());
    }
}

class BoneSampler {
public:
    BoneSampler(const RestSkeleton& skeleton, const WeldedMesh& mesh, const WindingTree& skin,
                const JointRoles& roles)
        : _skeleton(skeleton), _skin(skin), _roles(roles), _spacing(kSpacing * extentOf(mesh)) {}

    /// For each joint, the samples along its bones that are inside the skin. None for controls and
    /// bones that run outside.
    std::vector<std::vector<glm::dvec3>> sample(const std::vector<PlannedJoint>& joints) const {
        const std::size_t count = joints.size();
        std::vector<bool> isBody(count, false); // not a control, or above such a joint
        for (std::size_t j = count; j-- > 0;) {
            if (joints[j].region == RegionSource::Helper) continue;
            if (isLast(joints, j) && !isControl(joints, j)) isBody[j] = true;
            if (isBody[j] && joints[j].parent >= 0) isBody[indexOf(joints[j].parent)] = true;
        }
        std::vector<std::vector<glm::dvec3>> result(count);
        std::vector<std::optional<glm::dvec3>> last(count); // sample at or above each joint
        for (std::size_t j = 0; j < count; ++j) {
            if (joints[j].parent >= 0) last[j] = last[indexOf(joints[j].parent)];
            if (!isBody[j] || isTiny(joints[j], last[j])) continue;
            result[j] = samplesOf(joints, j, isBody);
            if (!result[j].empty()) last[j] = result[j].back();
        }
        std::size_t all = 0;
        for (const std::vector<glm::dvec3>& own : result) all += own.size();
        if (all > kManySamples) thin(kTiny * _spacing, result);
        return result;
    }

    bool isTiny(const PlannedJoint& joint, const std::optional<glm::dvec3>& last) const {
        return last && joint.boneLength > 0.0 && joint.boneLength < kTiny * _spacing &&
               glm::distance(*last, joint.centre) < kTiny * _spacing;
    }

private:
    std::vector<glm::dvec3> along(const glm::dvec3& from, const glm::dvec3& to) const {
        const double length = glm::distance(from, to);
        const int count = std::max(kMinSamples, static_cast<int>(std::ceil(length / _spacing)));
        std::vector<glm::dvec3> result;
        result.reserve(static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i) result.push_back(from + (i + 0.5) / count * (to - from));
        return result;
    }

    /// Whether nothing below a joint has a region: it is a leaf, or its children are skipped, such
    /// as the ends of fingers, which no vertex follows.
    bool isLast(const std::vector<PlannedJoint>& joints, std::size_t j) const {
        const std::vector<int> children = _skeleton.children(static_cast<int>(j));
        return std::all_of(children.begin(), children.end(),
                           [&](int child) { return joints[indexOf(child)].options.skip; });
    }

    bool isControl(const std::vector<PlannedJoint>& joints, std::size_t j) const {
        const PlannedJoint& joint = joints[j];
        if (joint.options.skip) return true;
        if (joint.parent < 0 || joint.boneLength > 0.0 || !_roles.roles[j].empty() ||
            joint.part != JointPart::Other)
            return false;
        const std::vector<glm::dvec3> above =
            along(joints[indexOf(joint.parent)].centre, joint.centre);
        return share(above) < kInside;
    }

    double share(const std::vector<glm::dvec3>& points) const {
        const auto inside = std::count_if(points.begin(), points.end(),
                                          [this](const glm::dvec3& p) { return _skin.inside(p); });
        return static_cast<double>(inside) / static_cast<double>(points.size());
    }

    std::vector<glm::dvec3> samplesOf(const std::vector<PlannedJoint>& joints, std::size_t j,
                                      const std::vector<bool>& isBody) const {
        const PlannedJoint& joint = joints[j];
        std::vector<glm::dvec3> bones;
        if (_skeleton.children(static_cast<int>(j)).size() > kMaxBones)
            return joint.isInside() ? std::vector<glm::dvec3>{joint.centre}
                                    : std::vector<glm::dvec3>{};
        const bool isEnd = isLast(joints, j);
        for (const int child : _skeleton.children(static_cast<int>(j)))
            if (isEnd || isBody[indexOf(child)])
                append(along(joint.centre, joints[indexOf(child)].centre), bones);
        if (_skeleton.joints[j].tip) append(along(joint.centre, joint.boneEnd), bones);

        std::vector<glm::dvec3> inside;
        for (const glm::dvec3& point : bones)
            if (_skin.inside(point)) inside.push_back(point);
        if (isEnd) append(beyondLast(joint), inside);
        if (!joint.isInside() &&
            static_cast<double>(inside.size()) < kInside * static_cast<double>(bones.size()))
            inside.clear();
        return inside;
    }

    /// Samples from a last joint, or its tip, to where the skin ends.
    std::vector<glm::dvec3> beyondLast(const PlannedJoint& joint) const {
        std::vector<glm::dvec3> result;
        const bool hasBone = joint.boneLength > 0.0;
        const glm::dvec3& direction = hasBone ? joint.boneAxis : joint.comingFrom;
        const double length = hasBone ? joint.boneLength : joint.lengthAbove;
        const double step = std::min(0.5 * _spacing, 0.5 * length);
        const int count =
            step > 0.0 ? static_cast<int>(std::min(kMaxExtension * length / step, kMaxSteps)) : 0;
        for (int i = 0; i <= count; ++i) {
            const glm::dvec3 point = joint.boneEnd + i * step * direction;
            if (!_skin.inside(point)) break;
            result.push_back(point);
        }
        return result;
    }

    static void append(const std::vector<glm::dvec3>& more, std::vector<glm::dvec3>& all) {
        all.insert(all.end(), more.begin(), more.end());
    }

    const RestSkeleton& _skeleton;
    const WindingTree& _skin;
    const JointRoles& _roles;
    const double _spacing;
};

/// The joint that gets a joint's samples: itself, the one at the same point, or the nearest above;
/// -1 if none of them has a region.
int ownerOf(const std::vector<PlannedJoint>& joints, std::size_t joint, double tolerance) {
    if (joints[joint].holdsRegion()) return static_cast<int>(joint);
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (joints[j].holdsRegion() &&
            glm::distance(joints[j].centre, joints[joint].centre) <= tolerance)
            return static_cast<int>(j);
    int owner = joints[joint].parent;
    while (owner >= 0 && !joints[indexOf(owner)].holdsRegion())
        owner = joints[indexOf(owner)].parent;
    return owner;
}

} // namespace

void setSamples(const RestSkeleton& skeleton, const WeldedMesh& mesh, const JointRoles& roles,
                BindOptions::Method method, std::vector<PlannedJoint>& joints,
                std::vector<std::string>& notes) {
    const WindingTree skin(mesh.positions, mesh.triangles);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        PlannedJoint& joint = joints[j];
        if (!joint.holdsRegion()) continue;
        joint.inside = skin.inside(joint.centre);
        if (method == BindOptions::Method::Paper && joint.isInside())
            joint.samples = {joint.centre};
    }
    if (method != BindOptions::Method::Paper) {
        const std::vector<std::vector<glm::dvec3>> samples =
            BoneSampler(skeleton, mesh, skin, roles).sample(joints);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const int owner = ownerOf(joints, j, kCentreTolerance * mesh.size);
            if (owner < 0) continue;
            std::vector<glm::dvec3>& all = joints[indexOf(owner)].samples;
            all.insert(all.end(), samples[j].begin(), samples[j].end());
        }
    }
    if (std::all_of(joints.begin(), joints.end(),
                    [](const PlannedJoint& joint) { return joint.samples.empty(); })) {
        notes.emplace_back("no joint lies inside the skin: regions are by the nearest bone");
        return;
    }
    std::vector<bool> isBelowBody(joints.size(), false); // below a joint with samples
    for (std::size_t j = 0; j < joints.size(); ++j) {
        PlannedJoint& joint = joints[j];
        if (joint.parent >= 0)
            isBelowBody[j] = isBelowBody[indexOf(joint.parent)] ||
                             !joints[indexOf(joint.parent)].samples.empty();
        if (!joint.holdsRegion() || !joint.samples.empty()) continue;
        joint.region = RegionSource::None;
        if (!joint.isOutside(static_cast<int>(j))) continue;
        std::string note = "joint \"" + skeleton.joints[j].name + "\" lies outside the skin";
        if (isBelowBody[j] && joint.child >= 0) {
            joint.region = RegionSource::Nearest;
            note += ", its region is the nearest skin";
        }
        notes.push_back(std::move(note));
    }
}

} // namespace osgSkin
