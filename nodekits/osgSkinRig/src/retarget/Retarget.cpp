// SPDX-License-Identifier: MIT
#include <osgSkinRig/Retarget>

#include "names/BodyParts.h"
#include "names/RoleTree.h"
#include "retarget/MotionSteps.h"
#include "retarget/Posture.h"
#include "retarget/RetargetTarget.h"
#include "skeleton/SkeletonTree.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>
#include <osgSkinRig/RetargetReport>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

std::string RetargetReport::text() const {
    std::ostringstream out;
    out << "names: rig " << (rigNames.empty() ? "of no known family" : rigNames) << ", motion "
        << (motionNames.empty() ? "of no known family" : motionNames) << "\n"
        << std::setprecision(4) << "root motion scaled by " << scale;
    const double degrees = glm::degrees(glm::angle(rotation.w < 0.0 ? -rotation : rotation));
    if (degrees > 1e-6) {
        const glm::dvec3 axis = glm::axis(rotation.w < 0.0 ? -rotation : rotation);
        out << ", rotated by " << degrees << " degrees about " << axis.x << " " << axis.y << " "
            << axis.z;
    }
    out << "\n";
    for (const std::string& note : notes) out << "note: " << onOneLine(note) << "\n";
    for (const Entry& entry : entries) {
        out << "joint " << onOneLine(entry.rigJoint) << ": ";
        if (entry.motionJoint.empty())
            out << "at rest";
        else
            out << onOneLine(entry.motionJoint) << ", aligned by " << entry.alignmentDegrees
                << " degrees";
        if (entry.flippedFrames > 0)
            out << ", upside down in " << entry.flippedFrames << " samples: corrected";
        if (entry.twistShared > 0)
            out << ", twisted by more than 90 degrees in " << entry.twistShared
                << " samples: the excess is distributed";
        out << "\n";
    }
    for (const std::string& joint : unusedMotionJoints)
        out << "not used: " << onOneLine(joint) << "\n";
    return out.str() + feetText();
}

std::string RetargetReport::feetText() const {
    std::ostringstream out;
    out << std::fixed;
    for (const FootSkate& foot : feet) {
        out << "foot " << onOneLine(foot.rigJoint) << ": ";
        const auto percent = [&](double length) {
            out << std::setprecision(1) << 100.0 * length / foot.leg << " %";
        };
        if (foot.contacts == 0) {
            out << "never planted\n";
            continue;
        }
        out << foot.contacts << (foot.contacts == 1 ? " contact" : " contacts") << ", slides by ";
        percent(foot.mean);
        out << " of the leg in the mean, ";
        percent(foot.worst);
        out << " at worst (from frame " << foot.worstFrame << "); the actor's own: ";
        percent(foot.actorMean);
        out << ", ";
        percent(foot.actorWorst);
        out << "\n";
    }
    return out.str();
}

namespace {

double degrees(const glm::dquat& q) {
    return glm::degrees(2.0 * std::atan2(glm::length(glm::dvec3(q.x, q.y, q.z)), std::abs(q.w)));
}

/// Degrees; no two bodies' feet differ by as much.
constexpr double kBackwards = 120.0;

/// Whether all feet of the rig point in other directions than the motion's.
bool doFeetDisagree(const BodyParts& parts, const std::vector<glm::dquat>& alignment) {
    return !parts.ankles.empty() &&
           std::all_of(parts.ankles.begin(), parts.ankles.end(), [&](int ankle) {
               return degrees(alignment[static_cast<std::size_t>(ankle)]) > kBackwards;
           });
}

void fillReport(RetargetReport& report, const Motion& motion, const RestSkeleton& rig,
                const std::vector<int>& motionJoint, const std::vector<glm::dquat>& alignment) {
    report.entries.clear();
    report.unusedMotionJoints.clear();
    std::vector<bool> used(motion.skeleton.joints.size(), false);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        RetargetReport::Entry entry{rig.joints[j].name, {}, 0.0, 0, 0};
        if (motionJoint[j] >= 0) {
            const auto m = static_cast<std::size_t>(motionJoint[j]);
            used[m] = true;
            entry.motionJoint = motion.skeleton.joints[m].name;
            entry.alignmentDegrees = degrees(alignment[j]);
        }
        report.entries.push_back(entry);
    }
    for (std::size_t m = 0; m < used.size(); ++m)
        if (!used[m]) report.unusedMotionJoints.push_back(motion.skeleton.joints[m].name);
}

/// World orientations of the rig's joints from the motion's.
void driveRig(const RestSkeleton& rig, const std::vector<int>& motionJoint,
              const std::vector<glm::dquat>& alignment, const std::vector<glm::dquat>& motionWorld,
              std::vector<glm::dquat>& world) {
    world.resize(rig.joints.size());
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = rig.joints[j].parent;
        if (motionJoint[j] >= 0)
            world[j] = motionWorld[static_cast<std::size_t>(motionJoint[j])] * alignment[j];
        else // at rest on its parent
            world[j] = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                  : world[static_cast<std::size_t>(parent)];
    }
}

/// Transforms the rotations to the space that `back` leads to.
void changeSpace(const glm::dquat& back, std::vector<glm::dquat>& rotations) {
    if (isIdentity(back)) return; // to the last bit
    for (glm::dquat& q : rotations) q = glm::normalize(back * q * glm::conjugate(back));
}

void addLocal(const RestSkeleton& rig, const std::vector<glm::dquat>& world, Clip& clip) {
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = rig.joints[j].parent;
        clip.rotations.push_back(glm::normalize(
            parent < 0 ? world[j]
                       : glm::conjugate(world[static_cast<std::size_t>(parent)]) * world[j]));
    }
}

/// Copies local rotations: nothing is aligned, nor put on the floor.
Clip copied(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
            const SameSkeleton& same, RetargetReport* report) {
    glm::dvec3 offset;
    Clip clip = copyRotations(motion, rig, map.motionJoint, same, offset);
    if (report != nullptr) {
        fillReport(*report, motion, rig, map.motionJoint,
                   std::vector<glm::dquat>(clip.joints, {1.0, 0.0, 0.0, 0.0}));
        report->scale = same.scale;
        report->rotation = {1.0, 0.0, 0.0, 0.0};
        report->offset = offset;
        report->feet.clear();
        report->notes.clear();
    }
    return clip;
}

/// \param motion relative to a pose in which the actor stands
/// \param bodyScale see StandingPose
Clip aligned(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
             std::optional<double> bodyScale, RetargetReport* report) {
    const std::vector<int>& motionJoint = map.motionJoint;
    const UprightFrames frames = findUprightFrames(rig, motion.skeleton, map);
    const RestSkeleton uprightRig = rotated(rig, frames.rigUpright);
    const RestSkeleton uprightMotion = rotated(motion.skeleton, frames.motionUpright);
    const RetargetTarget body(uprightRig, uprightMotion, map);
    const std::vector<glm::dquat> alignment = alignBones(body);
    const glm::dquat back = glm::conjugate(frames.rigUpright);

    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    clip.rotations.reserve(clip.frames * clip.joints);

    FootRoll feetRoll(body, alignment);
    RootPath root(body, bodyScale);
    MeasureFeet feet(body);
    StandingCheck standing(map.rig, map.motion);
    std::vector<glm::dquat> motionWorld;
    std::vector<glm::dquat> world;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        changeSpace(frames.motionUpright, motionWorld);
        driveRig(rig, motionJoint, alignment, motionWorld, world);
        feetRoll.straighten(world);
        root.add(frames.motionUpright * motion.rootPositions[f], motionWorld, world);
        feet.add({root.rigPositions(), world}, {root.motionPositions(), motionWorld});
        standing.add(root.rigPositions(), root.motionPositions());
        changeSpace(back, world);
        addLocal(rig, world, clip);
    }
    standing.finish();
    clip.rootPositions = root.finish();
    for (glm::dvec3& position : clip.rootPositions) position = back * position;

    if (report != nullptr) {
        fillReport(*report, motion, rig, motionJoint, alignment);
        for (std::size_t j = 0; j < clip.joints; ++j)
            report->entries[j].flippedFrames = feetRoll.flippedFrames(j);
        report->notes.clear();
        if (doFeetDisagree(body.rigParts, alignment))
            report->notes.emplace_back("the rig's feet point backwards where the actor's do not, "
                                       "or the reverse: one has left and right exchanged, or is "
                                       "mirrored");
        if (root.movedToOrigin())
            report->notes.emplace_back("the motion begins far from the origin: it starts at the "
                                       "origin here");
        report->scale = root.scale();
        report->rotation = back * frames.motionUpright;
        report->offset = back * root.offset();
        report->feet = feet.finish(motion.frameTime, root.scale());
    }
    return clip;
}

std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t kMaxNames = 4;
    std::string result;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxNames); ++i)
        result += (i == 0 ? "\"" : ", \"") + names[i] + "\"";
    if (names.size() > kMaxNames)
        result += " and " + std::to_string(names.size() - kMaxNames) + " more";
    return result;
}

/// Moves the joints of a rig that is the motion's skeleton as the motion does.
/// \param report of the clip: where the motion's space is in the rig's
void addMoves(const Motion& motion, const RestSkeleton& rig, const std::vector<int>& motionJoint,
              const RetargetReport& report, Clip& clip) {
    std::vector<glm::dquat> motionWorld, world;
    std::vector<glm::dvec3> theirs, ours;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        worldPositions(motion.skeleton, motionWorld, motion.rootPositions[f], motion.moves, f,
                       theirs);
        worldRotations(rig, &clip.rotations[f * clip.joints], world);
        ours.assign(clip.joints, clip.rootPositions[f]);
        for (std::size_t j = 1; j < clip.joints; ++j) {
            const auto p = static_cast<std::size_t>(rig.joints[j].parent);
            const int driver = motionJoint[j];
            glm::dvec3 offset = rig.joints[j].centre - rig.joints[p].centre;
            if (driver >= 0 && motion.moves.count(static_cast<std::size_t>(driver)) != 0) {
                const glm::dvec3 place =
                    report.scale * (report.rotation * theirs[static_cast<std::size_t>(driver)]) +
                    report.offset;
                offset = glm::conjugate(world[p]) * (place - ours[p]);
                clip.moves[j].push_back(offset);
            }
            ours[j] = ours[p] + world[p] * offset;
        }
    }
}

/// Notes joints whose moves the joints that they drive do not get, on another skeleton.
void noteMoves(const Motion& motion, const std::vector<int>& drivers,
               std::vector<std::string>& notes) {
    std::vector<std::string> names;
    for (const auto& [joint, positions] : motion.moves)
        if (std::find(drivers.begin(), drivers.end(), static_cast<int>(joint)) != drivers.end())
            names.push_back(motion.skeleton.joints[joint].name);
    if (names.empty()) return;
    notes.push_back((names.size() == 1 ? "joint " : "joints ") + listed(names) +
                    (names.size() == 1 ? " is" : " are") +
                    " translated; only translations of the root are used on another skeleton");
}

const char* const kEssential[] = {
    "Hips",         "Spine",         "Head",          "LeftUpperArm",  "LeftLowerArm",
    "LeftHand",     "RightUpperArm", "RightLowerArm", "RightHand",     "LeftUpperLeg",
    "LeftLowerLeg", "LeftFoot",      "RightUpperLeg", "RightLowerLeg", "RightFoot"};

/// The joints of essential roles for all of whose joints `isIdle` holds: the first of each role.
template <typename Idle>
std::vector<std::string> idleJoints(const JointRoles& roles, const RestSkeleton& skeleton,
                                    const Idle& isIdle) {
    std::vector<std::string> result;
    for (const char* role : kEssential) {
        const auto found = roles.joints.find(role);
        if (found != roles.joints.end() &&
            std::all_of(found->second.begin(), found->second.end(), isIdle))
            result.push_back(skeleton.joints[static_cast<std::size_t>(found->second[0])].name);
    }
    return result;
}

/// Notes the roles that were found by the skeleton's shape, for a person to check.
void noteShape(const JointRoles& roles, const RestSkeleton& skeleton, const std::string& whose,
               std::vector<std::string>& notes) {
    if (roles.family != kInferredFromGeometry) return;
    std::string found;
    for (const auto& [role, joints] : roles.joints)
        for (const char* shown : {"Hips", "Head", "LeftUpperArm", "LeftUpperLeg"})
            if (role == shown)
                found += (found.empty() ? "" : ", ") + role + " is \"" +
                         skeleton.joints[static_cast<std::size_t>(joints[0])].name + "\"";
    notes.push_back(
        "the " + whose +
        "'s joint names are not known; its parts are inferred from its shape: " + found);
}

/// Where joints are matched by equal names alone, those left over on both sides may be the same
/// joints with other spellings.
void noteLeftOver(const JointPairs& map, const RestSkeleton& rig, const RestSkeleton& motion,
                  const RetargetOptions& options, const std::string& expected,
                  std::vector<std::string>& notes) {
    const std::vector<int>& drivers = map.motionJoint;
    std::vector<std::string> still, unused;
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        if (drivers[j] < 0 && options.joints.count(rig.joints[j].name) == 0)
            still.push_back(rig.joints[j].name);
    for (std::size_t m = 0; m < motion.joints.size(); ++m)
        if (std::find(drivers.begin(), drivers.end(), int(m)) == drivers.end())
            unused.push_back(motion.joints[m].name);
    if (!still.empty() && !unused.empty())
        notes.push_back("no motion data for " + listed(still) + " of the rig; " + listed(unused) +
                        " of the motion not used" + expected);
}

/// Notes for a person: arms, legs or hips that exist in only one of both skeletons' matches, and
/// skeletons of no known family of which less than half matches. Joints that the caller's map
/// leaves at rest are not noted.
std::vector<std::string> notesOf(const JointPairs& map, const RestSkeleton& rig,
                                 const RestSkeleton& motion, const RetargetOptions& options) {
    const std::vector<int>& drivers = map.motionJoint;
    const std::string expected =
        "; expected joints of the same names, names of a known family, or a map";
    std::vector<std::string> notes;
    noteShape(map.rig, rig, "rig", notes);
    noteShape(map.motion, motion, "motion", notes);
    if (const std::vector<int> tops = topsOfFigures(rig, options.names); !tops.empty())
        notes.push_back("the rig has " + std::to_string(tops.size()) +
                        " figures; the motion moves the first, and not that of joint " +
                        listed({rig.joints[static_cast<std::size_t>(tops[1])].name}) +
                        "; expected each in a file of its own");
    if (map.rig.known()) {
        const auto idle = idleJoints(map.rig, rig, [&](int j) {
            const auto joint = static_cast<std::size_t>(j);
            return drivers[joint] < 0 && options.joints.count(rig.joints[joint].name) == 0;
        });
        if (!idle.empty())
            notes.push_back("no motion data for " + listed(idle) +
                            " of the rig; they keep their rest pose" + expected);
    }
    if (map.motion.known()) {
        const auto idle = idleJoints(map.motion, motion, [&](int j) {
            return std::find(drivers.begin(), drivers.end(), j) == drivers.end();
        });
        if (!idle.empty())
            notes.push_back("the rig has no joint for " + listed(idle) + " of the motion" +
                            expected);
    }
    if (map.rig.known() || map.motion.known()) return notes;
    const auto driven = static_cast<std::size_t>(
        std::count_if(drivers.begin(), drivers.end(), [](int m) { return m >= 0; }));
    if (2 * driven < std::min(rig.joints.size(), motion.joints.size()))
        notes.push_back("only " + std::to_string(driven) + " of the rig's " +
                        std::to_string(rig.joints.size()) + " joints match one of the motion's " +
                        std::to_string(motion.joints.size()) + expected);
    else
        noteLeftOver(map, rig, motion, options, expected, notes);
    return notes;
}

} // namespace

Clip retarget(const Motion& motion, const RestSkeleton& rig, const RetargetOptions& options,
              RetargetReport* report) {
    rig.validate();
    motion.validate();
    const JointPairs map = mapJoints(rig, motion.skeleton, options);
    const StandingPose pose = findStandingPose(motion, rig, map, options.up);
    RetargetReport own;
    if (report == nullptr) report = &own;
    Clip clip = pose.copied ? copied(motion, rig, map, *pose.copied, report)
                            : aligned(pose.counted ? *pose.counted : motion, rig, map,
                                      pose.bodyScale, report);
    if (pose.isSame && !motion.moves.empty()) addMoves(motion, rig, map.motionJoint, *report, clip);
    if (options.shareTwist && !pose.copied) {
        const std::vector<std::size_t> shared = shareHingeTwist(rig, map.rig, clip);
        for (std::size_t j = 0; j < shared.size(); ++j) report->entries[j].twistShared = shared[j];
    }
    for (std::size_t f = 0; f < clip.frames; ++f)
        if (!isInRange(clip.rootPositions[f]))
            throw Error("retarget: frame " + std::to_string(f) +
                        ": the root's position is not finite, or beyond -1e18 to 1e18");
    for (const auto& [joint, positions] : clip.moves)
        for (const glm::dvec3& position : positions)
            if (!isInRange(position))
                throw Error("retarget: joint \"" + rig.joints[joint].name +
                            "\" has a position that is not finite, or beyond -1e18 to 1e18");
    report->notes.insert(report->notes.begin(), pose.notes.begin(), pose.notes.end());
    for (std::string& note : notesOf(map, rig, motion.skeleton, options))
        report->notes.push_back(std::move(note));
    if (!pose.isSame) noteMoves(motion, map.motionJoint, report->notes);
    report->rigNames = map.rig.family;
    report->motionNames = map.motion.family;
    return clip;
}

} // namespace osgSkin
