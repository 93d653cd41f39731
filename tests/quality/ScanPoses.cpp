// SPDX-License-Identifier: GPL-3.0-or-later
#include "ScanPoses.h"

#include "SampledSurface.h"
#include "Subject.h"

#include <osgSkinRig/ForwardKinematics>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace quality {

/// A point of a part and where it should be in the scan.
struct RigidParts::Target {
    std::size_t joint;
    glm::dvec3 rest, point;
    SampledSurface::Nearest foot;
    double pointWeight, footWeight;
};

struct RigidParts::Solved {
    Eigen::VectorXd parameters; ///< of ParametrisedPose
    std::vector<Target> targets;
    std::vector<double> priors; ///< for each group
};

namespace {

using compare::Points;
using osgSkin::RestSkeleton;

/// The part of a joint's region that is rigid: along the bone, in bone lengths.
struct PartRule {
    const char* joint; ///< behind Left and Right, but for the middle
    double from, to;
};
constexpr PartRule kMiddleParts[] = {
    {"Hips", -1.0, 1.0}, {"Spine1", -0.3, 0.7}, {"Head", 0.1, 2.0}};
constexpr PartRule kSideParts[] = {{"Arm", 0.4, 0.75},  {"ForeArm", 0.2, 0.6},
                                   {"Hand", 0.2, 1.5},  {"UpLeg", 0.4, 0.75},
                                   {"Leg", 0.33, 0.75}, {"Foot", -1.0, 1.0}};
constexpr std::size_t kMaxPoints = 60; ///< of a part

/// Joints that share one rotation.
const std::vector<std::vector<std::string>> kMiddleGroups = {
    {"Hips"}, {"LowerBack", "Spine", "Spine1"}, {"Neck", "Neck1", "Head"}};
const std::vector<std::string> kSideGroups = {"Shoulder", "Arm", "ForeArm", "Hand",
                                              "UpLeg",    "Leg", "Foot"};
const std::vector<std::string> kSides = {"Left", "Right"};

// Standard deviations, metres and radians.
constexpr double kCorrespondence = 0.010, kDistance = 0.004, kCollarBone = 0.1, kRotation = 1.0;
constexpr double kJointMove = 0.005;
constexpr int kRounds = 8, kSteps = 2; ///< of a pose: targets, steps to them
constexpr int kJointRounds = 3;

Eigen::Vector3d toEigen(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}
glm::dvec3 toGlm(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// End of a joint's bone: its first child elsewhere, or its tip.
glm::dvec3 endOf(const RestSkeleton& rig, std::size_t joint) {
    const glm::dvec3 centre = rig.joints[joint].centre;
    for (const int child : rig.children(static_cast<int>(joint))) {
        const glm::dvec3& end = rig.joints[static_cast<std::size_t>(child)].centre;
        if (glm::distance(end, centre) > 0.0) return end;
    }
    return rig.joints[joint].tip.value_or(centre + glm::dvec3(0, 1, 0));
}

/// The similarity that takes `from` to `to` best.
Eigen::Matrix4d similarity(const Points& from, const Points& to) {
    Eigen::Matrix3Xd a(3, from.size()), b(3, to.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        a.col(static_cast<Eigen::Index>(i)) = toEigen(from[i]);
        b.col(static_cast<Eigen::Index>(i)) = toEigen(to[i]);
    }
    return Eigen::umeyama(a, b, true);
}

Points chosen(const Points& points, const std::vector<std::uint32_t>& indices) {
    Points result;
    for (const std::uint32_t i : indices) result.push_back(points[i]);
    return result;
}

glm::dquat rotationOf(const Eigen::Vector3d& vector) {
    const double angle = vector.norm();
    if (angle < 1e-12) return {1.0, 0.0, 0.0, 0.0};
    return glm::angleAxis(angle, toGlm(vector / angle));
}

Eigen::Vector3d vectorOf(const Eigen::Matrix3d& rotation) {
    const Eigen::AngleAxisd turn(rotation);
    return turn.angle() * turn.axis();
}

std::vector<std::vector<std::size_t>> groupsOf(const RestSkeleton& rig) {
    std::vector<std::vector<std::string>> names = kMiddleGroups;
    for (const std::string& side : kSides)
        for (const std::string& name : kSideGroups) names.push_back({side + name});
    std::vector<std::vector<std::size_t>> groups;
    for (const std::vector<std::string>& group : names) {
        std::vector<std::size_t> joints;
        for (const std::string& name : group)
            if (const int joint = rig.find(name); joint >= 0)
                joints.push_back(static_cast<std::size_t>(joint));
        if (!joints.empty()) groups.push_back(joints);
    }
    return groups;
}

/// Parameters: a rotation vector for each group, the root's position, the scale.
class ParametrisedPose {
public:
    explicit ParametrisedPose(const RestSkeleton& rig) : _rig(rig), groups(groupsOf(rig)) {}

    std::vector<glm::dmat4> skinning(const Eigen::VectorXd& parameters) const {
        std::vector<glm::dquat> local(_rig.joints.size(), glm::dquat(1.0, 0.0, 0.0, 0.0)), world;
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (const std::size_t joint : groups[g])
                local[joint] = rotationOf(parameters.segment<3>(static_cast<Eigen::Index>(3 * g)));
        Points centres;
        osgSkin::worldRotations(_rig, local.data(), world);
        osgSkin::worldPositions(_rig, world, toGlm(parameters.segment<3>(rootAt())), centres);
        std::vector<glm::dmat4> skinning;
        for (std::size_t j = 0; j < world.size(); ++j) {
            glm::dmat4 matrix = glm::mat4_cast(world[j]);
            matrix[3] = glm::dvec4(centres[j] - world[j] * _rig.joints[j].centre, 1.0);
            skinning.push_back(matrix);
        }
        return skinning;
    }
    Eigen::Index rootAt() const { return static_cast<Eigen::Index>(3 * groups.size()); }

private:
    const RestSkeleton& _rig;

public:
    std::vector<std::vector<std::size_t>> groups;
};

double robust(double residual, double deviation) {
    const double ratio = residual / (2.5 * deviation);
    return 1.0 / (deviation * std::sqrt(1.0 + ratio * ratio));
}

Eigen::VectorXd residuals(const ParametrisedPose& pose,
                          const std::vector<RigidParts::Target>& targets,
                          const std::vector<double>& priors, const Eigen::VectorXd& parameters) {
    const std::vector<glm::dmat4> skinning = pose.skinning(parameters);
    const double scale = parameters[pose.rootAt() + 3];
    Eigen::VectorXd rows(static_cast<Eigen::Index>(4 * targets.size()) + pose.rootAt());
    Eigen::Index row = 0;
    for (const RigidParts::Target& target : targets) {
        const glm::dvec3 posed =
            scale * glm::dvec3(skinning[target.joint] * glm::dvec4(target.rest, 1.0));
        rows.segment<3>(row) = target.pointWeight * toEigen(posed - target.point);
        rows[row + 3] =
            target.footWeight * glm::dot(posed - target.foot.position, target.foot.normal);
        row += 4;
    }
    for (Eigen::Index k = 0; k < pose.rootAt(); ++k)
        rows[row + k] = parameters[k] * priors[static_cast<std::size_t>(k / 3)];
    return rows;
}

/// The slopes of a function's rows, by differences.
template <typename Rows>
Eigen::MatrixXd slopesOf(const Rows& rowsAt, const Eigen::VectorXd& at) {
    constexpr double kDifference = 1e-6;
    const Eigen::VectorXd now = rowsAt(at);
    Eigen::MatrixXd slopes(now.size(), at.size());
    for (Eigen::Index k = 0; k < at.size(); ++k) {
        Eigen::VectorXd moved = at;
        moved[k] += kDifference;
        slopes.col(k) = (rowsAt(moved) - now) / kDifference;
    }
    return slopes;
}

/// Nearly the unit matrix, for directions that nothing determines.
Eigen::MatrixXd ridge(Eigen::Index size) {
    return 1e-3 * Eigen::MatrixXd::Identity(size, size);
}

/// Indices of the joints of arms and legs.
std::vector<std::size_t> limbJoints(const RestSkeleton& rig) {
    std::vector<std::size_t> joints;
    for (const std::string& side : kSides)
        for (const PartRule& rule : kSideParts)
            if (const int joint = rig.find(side + rule.joint); joint >= 0)
                joints.push_back(static_cast<std::size_t>(joint));
    return joints;
}

/// \param moves three for each of `joints`
RestSkeleton moved(RestSkeleton rig, const std::vector<std::size_t>& joints,
                   const Eigen::VectorXd& moves) {
    for (std::size_t k = 0; k < joints.size(); ++k)
        rig.joints[joints[k]].centre += toGlm(moves.segment<3>(static_cast<Eigen::Index>(3 * k)));
    return rig;
}

} // namespace

RigidParts::RigidParts(const CapturedPerson& person, const RestSkeleton& rig,
                       const std::vector<std::uint32_t>& regions)
    : _person(person), _rig(rig) {
    const Points marks = correspondingPoints(person.rest, person.rest);
    const auto add = [&](const std::string& name, const PartRule& rule) {
        const int joint = rig.find(name);
        if (joint < 0) return;
        Part part{static_cast<std::size_t>(joint), {}};
        const glm::dvec3 centre = rig.joints[part.joint].centre;
        const glm::dvec3 bone = endOf(rig, part.joint) - centre;
        for (std::uint32_t v = 0; v < regions.size(); ++v) {
            const double along =
                glm::dot(person.rest.points[v] - centre, bone) / glm::dot(bone, bone);
            if (regions[v] == part.joint && along > rule.from && along < rule.to &&
                !std::isnan(marks[v].x))
                part.vertices.push_back(v);
        }
        if (part.vertices.size() < 8) return;
        std::vector<std::uint32_t> chosen;
        const std::size_t step = 1 + part.vertices.size() / kMaxPoints;
        for (std::size_t i = 0; i < part.vertices.size(); i += step)
            chosen.push_back(part.vertices[i]);
        part.vertices = chosen;
        _parts.push_back(part);
    };
    for (const PartRule& rule : kMiddleParts) add(rule.joint, rule);
    for (const std::string& side : kSides)
        for (const PartRule& rule : kSideParts) add(side + rule.joint, rule);
}

const RigidParts::Part* RigidParts::partOf(int joint) const {
    for (; joint >= 0; joint = _rig.joints[static_cast<std::size_t>(joint)].parent)
        for (const Part& part : _parts)
            if (part.joint == static_cast<std::size_t>(joint)) return &part;
    return nullptr;
}

RestSkeleton RigidParts::turnedJoints() const {
    RestSkeleton rig = _rig;
    const std::vector<std::size_t> joints = limbJoints(rig);
    const auto count = static_cast<Eigen::Index>(3 * joints.size());
    Eigen::VectorXd all = Eigen::VectorXd::Zero(count); // moves so far
    for (int round = 0; round < kJointRounds; ++round) {
        const double prior = 1.0 / (kJointMove * kJointMove);
        Eigen::MatrixXd sums = prior * Eigen::MatrixXd::Identity(count, count);
        Eigen::VectorXd rights = -prior * all;
        for (const Scan& scan : _person.poses) {
            const Solved solved = solvedPose(rig, scan);
            const auto rowsAt = [&](const RestSkeleton& at, const Eigen::VectorXd& parameters) {
                return residuals(ParametrisedPose(at), solved.targets, solved.priors, parameters);
            };
            const Eigen::VectorXd now = rowsAt(rig, solved.parameters);
            const Eigen::MatrixXd byPose = slopesOf(
                [&](const Eigen::VectorXd& x) { return rowsAt(rig, x); }, solved.parameters);
            const Eigen::MatrixXd byJoints = slopesOf(
                [&](const Eigen::VectorXd& moves) {
                    return rowsAt(moved(rig, joints, moves), solved.parameters);
                },
                Eigen::VectorXd::Zero(count));
            // The pose follows the joints.
            const Eigen::MatrixXd share = (byPose.transpose() * byPose + ridge(byPose.cols()))
                                              .ldlt()
                                              .solve(byPose.transpose() * byJoints)
                                              .transpose();
            sums += byJoints.transpose() * byJoints - share * byPose.transpose() * byJoints;
            rights -= byJoints.transpose() * now - share * byPose.transpose() * now;
        }
        const Eigen::VectorXd moves = sums.ldlt().solve(rights);
        all += moves;
        rig = moved(rig, joints, moves);
    }
    return rig;
}

RigidParts::Pose RigidParts::solve(const RestSkeleton& rig, const Scan& scan) const {
    const Solved solved = solvedPose(rig, scan);
    const ParametrisedPose pose(rig);
    return {pose.skinning(solved.parameters), solved.parameters[pose.rootAt() + 3]};
}

RigidParts::Solved RigidParts::solvedPose(const RestSkeleton& rig, const Scan& scan) const {
    const ParametrisedPose pose(rig);
    const Points points = correspondingPoints(_person.rest, scan);
    const SampledSurface surface(scan.points, scan.triangles);
    const Points normals = skinNormals(_person.rest.points, _person.rest.triangles);

    // Each part on its own, as a start.
    Eigen::VectorXd parameters = Eigen::VectorXd::Zero(pose.rootAt() + 4);
    const auto motionOf = [&](const Part& part) {
        return similarity(chosen(_person.rest.points, part.vertices),
                          chosen(points, part.vertices));
    };
    const auto turnOf = [&](const Part& part) -> Eigen::Matrix3d {
        const Eigen::Matrix3d turn = motionOf(part).topLeftCorner<3, 3>();
        return turn / std::cbrt(turn.determinant());
    };
    std::vector<double> priors;
    for (std::size_t g = 0; g < pose.groups.size(); ++g) {
        const std::vector<std::size_t>& group = pose.groups[g];
        const bool isCollarBone =
            rig.joints[group.back()].name.find("Shoulder") != std::string::npos;
        const int above = rig.joints[group.front()].parent;
        priors.push_back(above < 0 ? 0.0 : 1.0 / (isCollarBone ? kCollarBone : kRotation));
        const auto part = std::find_if(_parts.begin(), _parts.end(), [&](const Part& candidate) {
            return candidate.joint == group.back();
        });
        if (part == _parts.end()) continue;
        const Part* parent = partOf(above);
        const Eigen::Matrix3d turn =
            parent ? Eigen::Matrix3d(turnOf(*parent).transpose() * turnOf(*part)) : turnOf(*part);
        parameters.segment<3>(static_cast<Eigen::Index>(3 * g)) =
            vectorOf(turn) / double(group.size());
    }
    const Part& first = _parts.front();
    const Eigen::Matrix4d motion = motionOf(first);
    const double scale = std::cbrt(motion.topLeftCorner<3, 3>().determinant());
    parameters.segment<3>(pose.rootAt()) =
        (motion * toEigen(rig.joints[0].centre).homogeneous()).head<3>() / scale;
    parameters[pose.rootAt() + 3] = scale;

    std::vector<Target> targets;
    for (int round = 0; round < kRounds; ++round) {
        const std::vector<glm::dmat4> skinning = pose.skinning(parameters);
        const double grown = parameters[pose.rootAt() + 3];
        targets.clear();
        for (const Part& part : _parts)
            for (const std::uint32_t v : part.vertices) {
                const glm::dmat4& matrix = skinning[part.joint];
                const glm::dvec3 rest = _person.rest.points[v];
                const glm::dvec3 posed = grown * glm::dvec3(matrix * glm::dvec4(rest, 1.0));
                const auto foot = surface.nearest(posed, glm::dmat3(matrix) * normals[v]);
                targets.push_back({part.joint, rest, points[v], foot,
                                   robust(glm::distance(posed, points[v]), kCorrespondence),
                                   round < kRounds / 2 ? 0.0 : robust(foot.distance, kDistance)});
            }
        const auto rowsAt = [&](const Eigen::VectorXd& x) {
            return residuals(pose, targets, priors, x);
        };
        for (int step = 0; step < kSteps; ++step) { // Gauss and Newton's
            const Eigen::MatrixXd slopes = slopesOf(rowsAt, parameters);
            parameters -= (slopes.transpose() * slopes + ridge(slopes.cols()))
                              .ldlt()
                              .solve(slopes.transpose() * rowsAt(parameters));
        }
    }
    return {parameters, targets, priors};
}

} // namespace quality
