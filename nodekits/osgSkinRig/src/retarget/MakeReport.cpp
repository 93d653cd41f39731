// SPDX-License-Identifier: MIT
#include "retarget/MakeReport.h"

#include "names/BodyParts.h"
#include "names/RoleTree.h"

#include <osgSkin/Error>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

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

} // namespace

void reportCopied(const RotationCopy& copy, const Motion& motion, const RestSkeleton& rig,
                  const JointPairs& map, double scale, RetargetReport& report) {
    fillReport(report, motion, rig, map.motionJoint,
               std::vector<glm::dquat>(rig.joints.size(), {1.0, 0.0, 0.0, 0.0}));
    report.scale = scale;
    report.rotation = {1.0, 0.0, 0.0, 0.0};
    report.offset = copy.offset();
    report.feet.clear();
    report.notes.clear();
}

void reportAligned(PoseTransfer& transfer, const Motion& motion, const RestSkeleton& rig,
                   RetargetReport& report) {
    const RetargetTarget& body = transfer.body();
    const std::vector<glm::dquat>& alignment = transfer.alignment();
    fillReport(report, motion, rig, body.map.motionJoint, alignment);
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        report.entries[j].flippedFrames = transfer.feetRoll().flippedFrames(j);
    report.notes.clear();
    if (doFeetDisagree(body.rigParts, alignment))
        report.notes.emplace_back("the rig's feet point backwards where the actor's do not, "
                                  "or the reverse: one has left and right exchanged, or is "
                                  "mirrored");
    if (transfer.root().movedToOrigin())
        report.notes.emplace_back("the motion begins far from the origin: it starts at the "
                                  "origin here");
    if (const double raised = transfer.root().raised(); raised != 0.0)
        report.notes.emplace_back("the motion's feet are on another floor than the body's: it is " +
                                  std::string(raised > 0.0 ? "raised" : "lowered") + " by " +
                                  std::to_string(std::lround(100.0 * std::abs(raised))) +
                                  " % of the hips' height");
    report.scale = transfer.root().scale();
    report.rotation = transfer.back() * transfer.frames().motionUpright;
    report.offset = transfer.back() * transfer.root().offset();
    report.feet.clear();
}

namespace {

std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t kMaxNames = 4;
    std::string result;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxNames); ++i)
        result += (i == 0 ? "\"" : ", \"") + names[i] + "\"";
    if (names.size() > kMaxNames)
        result += " and " + std::to_string(names.size() - kMaxNames) + " more";
    return result;
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

namespace {

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

} // namespace

void addNotes(const StandingPose& pose, const JointPairs& map, const Motion& motion,
              const RestSkeleton& rig, const RetargetOptions& options, RetargetReport& report) {
    report.notes.insert(report.notes.begin(), pose.notes.begin(), pose.notes.end());
    for (std::string& note : notesOf(map, rig, motion.skeleton, options))
        report.notes.push_back(std::move(note));
    if (!pose.isSame) noteMoves(motion, map.motionJoint, report.notes);
    report.rigNames = map.rig.family;
    report.motionNames = map.motion.family;
}

} // namespace osgSkin
