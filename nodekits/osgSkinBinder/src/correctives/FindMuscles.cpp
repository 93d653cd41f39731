// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/Muscles.h"

#include "correctives/ShapedJoint.h"
#include "joints/BodyAxes.h"
#include "regions/HermiteRatio.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace osgSkin {
namespace {

using Options = BindOptions::Muscle;

/// A muscle of a limb: along the bone of one joint, moved by the next. `from`, `to` and `peak` are
/// fractions of the bone.
///
/// The biceps' growth is the growth of 383 junior rowers' arms when tensed and flexed. The other
/// muscles grow less, since more of their limb does not shorten.
const struct LimbMuscle {
    const char *name, *bone, *hinge; ///< roles, without their side
    Options::Side side;
    double from, to, peak, growth, tension;
} kLimbMuscles[] = {
    {"Biceps", "UpperArm", "LowerArm", Options::Side::Flexor, 0.02, 1.02, 0.55, 0.104, 0.07},
    {"Triceps", "UpperArm", "LowerArm", Options::Side::Extensor, 0.02, 0.95, 0.45, 0.03, 0.06},
    {"ForearmFlexors", "LowerArm", "Hand", Options::Side::Flexor, -0.05, 0.85, 0.3, 0.04, 0.05},
    {"ForearmExtensors", "LowerArm", "Hand", Options::Side::Extensor, -0.05, 0.85, 0.27, 0.04,
     0.05},
    {"Quadriceps", "UpperLeg", "LowerLeg", Options::Side::Extensor, 0.05, 0.97, 0.5, 0.03, 0.05},
    {"Hamstrings", "UpperLeg", "LowerLeg", Options::Side::Flexor, 0.1, 1.0, 0.52, 0.04, 0.04},
    {"Calf", "LowerLeg", "Foot", Options::Side::Extensor, 0.0, 0.8, 0.3, 0.05, 0.05},
};

/// A direction in a body's axes; `outwards` is away from its middle on either side.
struct InBody {
    double outwards, up, front;
};

/// From a joint along a line and the body's up axis, in the line's lengths, and outwards, in
/// distances of a joint from the body's middle.
struct BodyPlace {
    double along, up, outwards;
};

/// A muscle of the trunk, moved by a joint that bends in all directions. Lengths are relative to
/// the line from joint `base` to joint `end`, but for those in distances of joint `moved` from the
/// body's middle.
const struct TrunkMuscle {
    const char* name;
    struct {
        const char *moved, *base, *end;
    } roles; ///< without their side
    struct {
        InBody towards;       ///< contracts as the moved joint's bone turns there
        double whole, widest; ///< the bend at which it has its growth, and the range; degrees
    } bend;
    struct {
        BodyPlace origin, insertion; ///< from `base`
    } line;
    struct {
        InBody side;
        double peak;
        double widthAtOrigin, widthAtInsertion; ///< half widths of a flat muscle
        double widthOfMiddle; ///< a part of both, in distances from the body's middle
    } belly;
    struct {
        double reach, growth, tension;
    } skin;
} kTrunkMuscles[] = {
    {"Deltoid",
     {"UpperArm", "UpperArm", "LowerArm"},
     {{0.0, 1.0, 0.0}, 90.0, 150.0},
     {{-0.3, 0.0, 0.0}, {0.55, 0.0, 0.0}},
     {{1.0, 0.6, 0.0}, 0.5, 0.0, 0.0, 0.0},
     {0.6, 0.03, 0.035}},
    {"Pectoral",
     {"UpperArm", "UpperArm", "LowerArm"},
     {{-0.6, 0.0, 0.8}, 90.0, 150.0},
     {{0.0, -0.36, -1.0}, {0.0, -0.08, 0.0}},
     {{0.0, 0.0, 1.0}, 0.5, 0.42, 0.25, 0.0},
     {1.2, 0.035, 0.045}},
    {"Trapezius",
     {"Collar", "Neck", "UpperArm"},
     {{0.0, 1.0, 0.0}, 30.0, 60.0},
     {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}},
     {{0.0, 1.0, -0.4}, 0.4, 0.5, 0.5, 0.0},
     {0.8, 0.05, 0.05}},
    {"Gluteus",
     {"UpperLeg", "UpperLeg", "LowerLeg"},
     {{0.0, 0.0, -1.0}, 30.0, 60.0},
     {{0.0, 0.27, -0.1}, {0.0, -0.22, 0.1}},
     {{0.0, 0.0, -1.0}, 0.5, 0.0, 0.0, 1.0},
     {0.7, 0.015, 0.026}},
};

/// A flexor reaches its growth where its hinge is bent by this angle from straight, in degrees.
constexpr double kFlexion = 120.0;

/// The least angle between that bend and the rest pose, in degrees.
constexpr double kMinFlexion = 45.0;

/// Other muscles reach their growth at this angle from the rest pose, in degrees.
constexpr double kBend = 45.0;

/// A muscle goes on to contract beyond that bend, up to this multiple of it.
constexpr double kBeyond = 1.25;

/// The contraction at a multiple of the bend at which growth is given: 0 up to 0, then rising
/// smoothly through 1.
double contractionAt(double bend) {
    return hermiteRatio(bend / kBeyond) / hermiteRatio(1.0 / kBeyond);
}

glm::dvec3 perpendicularPart(const glm::dvec3& v, const glm::dvec3& unit) {
    return v - unit * glm::dot(v, unit);
}

/// The axis, perpendicular to the twist axis, of a bend that turns `along` towards `towards`.
std::optional<glm::dvec3> axisTowards(const glm::dvec3& towards, const glm::dvec3& along,
                                      const glm::dvec3& twistAxis) {
    const glm::dvec3 axis = perpendicularPart(glm::cross(along, towards), twistAxis);
    if (!(glm::length(axis) > 1e-3 * glm::length(towards))) return std::nullopt;
    return glm::normalize(axis);
}

/// Sets a muscle along the bone from joint `above` to the hinge. Returns a reason if it cannot be
/// made, else an empty string.
/// \param peak in fractions of the bone
std::string makeOfLimb(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                       const std::vector<BoundJoint>& bound, const Options& options,
                       std::size_t above, std::size_t joint, double peak, Muscle& muscle) {
    const PlannedJoint& hinge = joints[joint];
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
    muscle.hinge = muscle.functions.joint;
    muscle.origin = joints[above].centre + options.from * line;
    muscle.insertion = joints[above].centre + options.to * line;
    muscle.peak = (peak - options.from) / (options.to - options.from);
    const bool extends = !options.towards && options.side == Options::Side::Extensor;
    const glm::dvec3 side = (extends ? -1.0 : 1.0) * glm::cross(*axis, along);
    if (!(glm::length(side) > 1e-3)) return "bends along the bone above it";
    muscle.side = glm::normalize(side);
    double whole = (extends ? -1.0 : 1.0) * glm::radians(kBend);
    if (!options.towards && !extends) {
        const double flexed = std::atan2(glm::dot(glm::cross(range.above, range.bone), *axis),
                                         glm::dot(range.above, range.bone));
        whole = std::max(glm::radians(kFlexion) - flexed, glm::radians(kMinFlexion));
    }
    muscle.contraction = [whole](const glm::dvec2& xy) {
        return contractionAt(2.0 * std::asin(std::clamp(xy.x, -1.0, 1.0)) / whole);
    };
    muscle.growth = options.growth;
    muscle.tension = options.tension;
    return {};
}

/// One side of a body, with the joints that its muscles lie at and their places.
class BodySide {
public:
    BodySide(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
             const std::vector<BoundJoint>& bound, const JointRoles& roles, std::string side)
        : _skeleton(skeleton), _joints(joints), _bound(bound), _roles(roles),
          _side(std::move(side)), _body(bodyAxes(joints)) {
        if (!_body) return;
        // Away from the middle: the limbs show it, since rigs may exchange left and right.
        const glm::dvec3 left = glm::cross(_body->up, _body->front);
        const std::optional<std::size_t> limb =
            joint("UpperArm") ? joint("UpperArm") : joint("UpperLeg");
        if (!limb) return;
        _isLeft = glm::dot(centre(*limb) - joints.front().centre, left) > 0.0;
        _outwards = _isLeft ? left : -left;
    }

    /// Each returns a reason if it cannot be made, else an empty string.
    std::string make(const LimbMuscle& known, Muscle& muscle) const {
        const auto above = joint(known.bone), hinge = joint(known.hinge);
        if (!above || !hinge) return noJoint(above ? known.hinge : known.bone);
        Options options{_side + known.name, {},       known.side,   {},
                        known.from,         known.to, known.growth, known.tension};
        const bool ofForearm = std::string(known.hinge) == "Hand";
        const double sign = known.side == Options::Side::Flexor ? 1.0 : -1.0;
        if (ofForearm && !_body) return noFront();
        if (ofForearm) options.towards = sign * palm(*above, *hinge);
        const std::string reason =
            makeOfLimb(_skeleton, _joints, _bound, options, *above, *hinge, known.peak, muscle);
        if (!reason.empty()) return "joint \"" + _skeleton.joints[*hinge].name + "\" " + reason;
        if (ofForearm) muscle.side = sign * forearmSide(*above, *hinge);
        return {};
    }

    std::string make(const TrunkMuscle& known, Muscle& muscle) const {
        for (const char* role : {known.roles.base, known.roles.moved, known.roles.end})
            if (!joint(role)) return noJoint(role);
        if (!_body) return noFront();
        const std::size_t moved = *joint(known.roles.moved);
        const glm::dvec3 base = centre(*joint(known.roles.base));
        const glm::dvec3 line = centre(*joint(known.roles.end)) - base;
        const double length = glm::length(line);
        const double aside = glm::dot(centre(moved) - _joints.front().centre, _outwards);
        const auto place = [&](const BodyPlace& at) {
            return base + at.along * line + at.up * length * _body->up +
                   at.outwards * aside * _outwards;
        };
        muscle.name = _side + known.name;
        moveByTurning(known, moved, muscle);
        muscle.origin = place(known.line.origin);
        muscle.insertion = place(known.line.insertion);
        muscle.side = glm::normalize(perpendicularPart(
            direction(known.belly.side), glm::normalize(muscle.insertion - muscle.origin)));
        muscle.peak = known.belly.peak;
        const double width = known.belly.widthOfMiddle * aside;
        muscle.widthAtOrigin = known.belly.widthAtOrigin * length + width;
        muscle.widthAtInsertion = known.belly.widthAtInsertion * length + width;
        muscle.reach = known.skin.reach * length;
        muscle.growth = known.skin.growth * length;
        muscle.tension = known.skin.tension * length;
        return {};
    }

private:
    std::string sided(const std::string& role) const {
        return role == "Neck" ? role : _side + role;
    }
    std::optional<std::size_t> joint(const std::string& role) const {
        const auto found = _roles.joints.find(sided(role));
        if (found == _roles.joints.end() || found->second.empty()) return std::nullopt;
        return static_cast<std::size_t>(found->second.front());
    }
    const glm::dvec3& centre(std::size_t joint) const { return _joints[joint].centre; }

    std::string noJoint(const std::string& role) const {
        return "no joint has the role " + sided(role);
    }
    static std::string noFront() { return "the body has no known front"; }
    glm::dvec3 direction(const InBody& in) const {
        return in.outwards * _outwards + in.up * _body->up + in.front * _body->front;
    }

    void moveByTurning(const TrunkMuscle& known, std::size_t moved, Muscle& muscle) const {
        ShapedJoint range;
        range.twistAxis = _bound[moved].twistAxis;
        setBendRange(std::nullopt, _body->front, range, known.bend.widest);
        range.functions.joint = static_cast<std::uint32_t>(moved);
        muscle.functions = range.functions;
        const auto rise =
            [towards = glm::normalize(direction(known.bend.towards))](const glm::dvec3& bone) {
                return std::asin(std::clamp(glm::dot(bone, towards), -1.0, 1.0));
            };
        muscle.contraction = [range, rise, bone = _joints[moved].boneAxis,
                              whole = glm::radians(known.bend.whole)](const glm::dvec2& xy) {
            const glm::dquat turn = partialRotation(range.bendAt(xy), range.twistAxis, 1.0, 1.0);
            return contractionAt((rise(turn * bone) - rise(bone)) / whole);
        };
    }

    /// The thumb's direction from the hand, or the front without one; perpendicular to the forearm.
    glm::dvec3 thumb(std::size_t elbow, std::size_t hand) const {
        const glm::dvec3 along = glm::normalize(centre(hand) - centre(elbow));
        const auto thumb = joint("Thumb1");
        const glm::dvec3 way =
            thumb ? perpendicularPart(centre(*thumb) - centre(hand), along) : glm::dvec3(0.0);
        return glm::length(way) > 0.1 * glm::distance(centre(hand), centre(elbow))
                   ? way
                   : perpendicularPart(_body->front, along);
    }

    /// The direction that the palm faces, unit.
    glm::dvec3 palm(std::size_t elbow, std::size_t hand) const {
        const glm::dvec3 across = glm::cross(centre(hand) - centre(elbow), thumb(elbow, hand));
        return glm::normalize(_isLeft ? across : -across);
    }

    /// From the forearm's bone to the bellies of its flexors, which are near the elbow: between
    /// the palm and the elbow's inner side, as the hand is turned against the elbow.
    glm::dvec3 forearmSide(std::size_t elbow, std::size_t hand) const {
        const glm::dvec3 along = glm::normalize(centre(hand) - centre(elbow));
        glm::dvec3 side = palm(elbow, hand);
        if (const auto axis = findMainAxis(_skeleton, _joints, elbow))
            side += perpendicularPart(_isLeft ? *axis : -*axis, along);
        return glm::normalize(perpendicularPart(side, along));
    }

    const RestSkeleton& _skeleton;
    const std::vector<PlannedJoint>& _joints;
    const std::vector<BoundJoint>& _bound;
    const JointRoles& _roles;
    std::string _side;
    std::optional<BodyAxes> _body;
    glm::dvec3 _outwards{0.0};
    bool _isLeft = true;
};

} // namespace

std::vector<Muscle> findMuscles(const RestSkeleton& skeleton,
                                const std::vector<PlannedJoint>& joints,
                                const std::vector<BoundJoint>& bound, const BindOptions& options,
                                std::vector<std::string>& notes) {
    std::vector<Muscle> muscles;
    for (const Options& own : options.ownMuscles) {
        const int joint = skeleton.find(own.joint);
        if (joint < 0)
            throw Error("muscle \"" + own.name + "\": there is no joint \"" + own.joint + "\"");
        Muscle muscle;
        const auto hinge = static_cast<std::size_t>(joint);
        const std::string reason =
            makeOfLimb(skeleton, joints, bound, own, hinge > 0 ? regionAbove(joints, hinge) : 0,
                       hinge, 0.5 * (own.from + own.to), muscle);
        if (!reason.empty())
            throw Error("muscle \"" + own.name + "\": joint \"" + own.joint + "\" " + reason);
        muscles.push_back(muscle);
    }
    if (!options.muscles) return muscles;
    const JointRoles roles = recogniseJoints(skeleton, options.names);
    for (const char* side : {"Left", "Right"}) {
        const BodySide body(skeleton, joints, bound, roles, side);
        const auto add = [&](const auto& known) {
            const std::string name = std::string(side) + known.name;
            if (std::any_of(options.ownMuscles.begin(), options.ownMuscles.end(),
                            [&](const Options& own) { return own.name == name; }))
                return; // the author's own replaces it
            Muscle muscle;
            const std::string reason = body.make(known, muscle);
            if (reason.empty())
                muscles.push_back(muscle);
            else
                notes.push_back("muscle " + name + " is left out: " + reason);
        };
        for (const LimbMuscle& known : kLimbMuscles) add(known);
        for (const TrunkMuscle& known : kTrunkMuscles) add(known);
    }
    return muscles;
}

} // namespace osgSkin
