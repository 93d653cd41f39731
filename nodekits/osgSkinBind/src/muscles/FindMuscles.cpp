// SPDX-License-Identifier: GPL-3.0-or-later
#include "muscles/Muscles.h"

#include "shapes/ShapedJoint.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgSkin {
namespace {

using Options = BindOptions::Muscle;

/// The biceps' growth is the growth of 383 junior rowers' arms when tensed and flexed. The other
/// muscles grow less, since more of their limb does not shorten.
const struct {
    const char* name;
    const char* hinge; ///< role, without its side
    Options::Side side;
    double from, to, growth, tension;
} kMuscles[] = {
    {"Triceps", "LowerArm", Options::Side::Extensor, 0.1, 0.95, 0.04, 0.07},
    {"Biceps", "LowerArm", Options::Side::Flexor, 0.1, 0.95, 0.104, 0.075},
    {"Quadriceps", "LowerLeg", Options::Side::Extensor, 0.1, 0.95, 0.03, 0.06},
    {"Hamstrings", "LowerLeg", Options::Side::Flexor, 0.15, 0.95, 0.05, 0.06},
    {"Calf", "Foot", Options::Side::Extensor, 0.02, 0.7, 0.06, 0.06},
};

/// The axis, perpendicular to the twist axis, of a bend that turns `along` towards `way`.
std::optional<glm::dvec3> axisTowards(const glm::dvec3& way, const glm::dvec3& along,
                                      const glm::dvec3& twistAxis) {
    const glm::dvec3 across = glm::cross(along, way);
    const glm::dvec3 axis = across - twistAxis * glm::dot(across, twistAxis);
    if (!(glm::length(axis) > 1e-3 * glm::length(way))) return std::nullopt;
    return glm::normalize(axis);
}

/// Sets a muscle, except its radius. Returns a reason if it cannot be made, else an empty string.
std::string make(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                 const std::vector<BoundJoint>& bound, const Options& options, std::size_t joint,
                 Muscle& muscle) {
    const PlannedJoint& hinge = joints[joint];
    const std::size_t above = joint > 0 ? regionAbove(joints, joint) : 0;
    const glm::dvec3 line = hinge.centre - joints[above].centre;
    if (above == 0 || !(glm::length(line) > 0.0)) return "has no bone above it";
    const glm::dvec3 along = glm::normalize(line);
    const std::optional<glm::dvec3> axis =
        options.towards ? axisTowards(*options.towards, along, bound[joint].twistAxis)
                        : findMainAxis(skeleton, joints, joint);
    if (!axis) return "bends in no direction that its limb or name determines";
    ShapedJoint range;
    range.above = hinge.comingFrom;
    range.bone = hinge.boneAxis;
    range.twistAxis = bound[joint].twistAxis;
    setBendRange(axis, along, range);
    muscle.name = options.name;
    muscle.functions = range.functions;
    muscle.functions.joint = static_cast<std::uint32_t>(joint);
    muscle.above = static_cast<std::uint32_t>(above);
    muscle.begin = joints[above].centre;
    muscle.end = hinge.centre;
    muscle.shortens = options.towards || options.side == Options::Side::Flexor ? 1.0 : -1.0;
    const glm::dvec3 side = muscle.shortens * glm::cross(*axis, along);
    if (!(glm::length(side) > 1e-3)) return "bends along the bone above it";
    muscle.side = glm::normalize(side);
    muscle.flexed = std::atan2(glm::dot(glm::cross(range.above, range.bone), *axis),
                               glm::dot(range.above, range.bone));
    muscle.from = options.from;
    muscle.to = options.to;
    muscle.growth = options.growth;
    muscle.tension = options.tension;
    return {};
}

} // namespace

std::vector<Muscle> findMuscles(const RestSkeleton& skeleton,
                                const std::vector<PlannedJoint>& joints,
                                const std::vector<BoundJoint>& bound, const BindOptions& options,
                                std::vector<std::string>& notes) {
    std::vector<Muscle> muscles;
    if (options.muscles) {
        const JointRoles roles = recogniseJoints(skeleton, options.names);
        for (const char* side : {"Left", "Right"})
            for (const auto& known : kMuscles) {
                const std::string name = std::string(side) + known.name;
                if (std::any_of(options.ownMuscles.begin(), options.ownMuscles.end(),
                                [&](const Options& own) { return own.name == name; }))
                    continue; // the author's own replaces it
                const Options asked{name,       {},       known.side,   {},
                                    known.from, known.to, known.growth, known.tension};
                const auto role = roles.joints.find(std::string(side) + known.hinge);
                Muscle muscle;
                std::string reason = "no joint has the role " + std::string(known.hinge);
                if (role != roles.joints.end() && !role->second.empty()) {
                    const auto joint = static_cast<std::size_t>(role->second.front());
                    reason = make(skeleton, joints, bound, asked, joint, muscle);
                    if (!reason.empty())
                        reason = "joint \"" + skeleton.joints[joint].name + "\" " + reason;
                }
                if (reason.empty())
                    muscles.push_back(muscle);
                else
                    notes.push_back("muscle " + asked.name + " is left out: " + reason);
            }
    }
    for (const Options& own : options.ownMuscles) {
        const int joint = skeleton.find(own.joint);
        if (joint < 0)
            throw Error("muscle \"" + own.name + "\": there is no joint \"" + own.joint + "\"");
        Muscle muscle;
        const std::string reason = make(skeleton, joints, bound, own, std::size_t(joint), muscle);
        if (!reason.empty())
            throw Error("muscle \"" + own.name + "\": joint \"" + own.joint + "\" " + reason);
        muscles.push_back(muscle);
    }
    return muscles;
}

} // namespace osgSkin
