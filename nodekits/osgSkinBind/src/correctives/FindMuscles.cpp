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

/// A flexor reaches its growth where its hinge is bent by this angle from straight, in degrees.
constexpr double kFlexion = 120.0;

/// The least angle between that bend and the rest pose, in degrees.
constexpr double kLeastFlexion = 45.0;

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

/// The axis, perpendicular to the twist axis, of a bend that turns `along` towards `way`.
std::optional<glm::dvec3> axisTowards(const glm::dvec3& way, const glm::dvec3& along,
                                      const glm::dvec3& twistAxis) {
    const glm::dvec3 axis = perpendicularPart(glm::cross(along, way), twistAxis);
    if (!(glm::length(axis) > 1e-3 * glm::length(way))) return std::nullopt;
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
        whole = std::max(glm::radians(kFlexion) - flexed, glm::radians(kLeastFlexion));
    }
    muscle.contraction = [whole](const glm::dvec2& xy) {
        return contractionAt(2.0 * std::asin(std::clamp(xy.x, -1.0, 1.0)) / whole);
    };
    muscle.growth = options.growth;
    muscle.tension = options.tension;
    return {};
}

/// Moves a muscle by a joint that bends in all directions: it contracts as the joint's bone turns
/// towards `way`, unit, and has its growth at `whole` degrees from the rest pose.
/// \param most the largest bend, degrees
void moveByTurning(const PlannedJoint& joint, const BoundJoint& bound, std::size_t index,
                   const glm::dvec3& way, const glm::dvec3& across, double whole, double most,
                   Muscle& muscle) {
    ShapedJoint range;
    range.twistAxis = bound.twistAxis;
    setBendRange(std::nullopt, across, range, most);
    range.functions.joint = static_cast<std::uint32_t>(index);
    muscle.functions = range.functions;
    const auto rise = [way](const glm::dvec3& bone) {
        return std::asin(std::clamp(glm::dot(bone, way), -1.0, 1.0));
    };
    muscle.contraction = [range, rise, bone = joint.boneAxis,
                          whole = glm::radians(whole)](const glm::dvec2& xy) {
        const glm::dquat turn = partialRotation(range.bendAt(xy), range.twistAxis, 1.0, 1.0);
        return contractionAt((rise(turn * bone) - rise(bone)) / whole);
    };
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
        if (std::string(known.hinge) == "Hand") {
            if (!_body) return "the body has no known front";
            const double way = known.side == Options::Side::Flexor ? 1.0 : -1.0;
            options.towards = way * palm(*above, *hinge);
            std::string reason =
                makeOfLimb(_skeleton, _joints, _bound, options, *above, *hinge, known.peak, muscle);
            if (reason.empty()) muscle.side = way * forearmSide(*above, *hinge);
            return withJoint(*hinge, reason);
        }
        return withJoint(*hinge, makeOfLimb(_skeleton, _joints, _bound, options, *above, *hinge,
                                            known.peak, muscle));
    }

    std::string makeDeltoid(Muscle& muscle) const {
        const auto arm = joint("UpperArm"), elbow = joint("LowerArm");
        if (!arm || !elbow) return noJoint(arm ? "LowerArm" : "UpperArm");
        if (!_body) return "the body has no known front";
        const glm::dvec3 bone = centre(*elbow) - centre(*arm);
        const double length = glm::length(bone);
        muscle.name = _side + "Deltoid";
        moveByTurning(_joints[*arm], _bound[*arm], *arm, _body->up, _body->front, 90.0, 150.0,
                      muscle);
        setLine(centre(*arm) - 0.3 * bone, centre(*arm) + 0.55 * bone, _outwards + 0.6 * _body->up,
                muscle);
        muscle.peak = 0.5;
        muscle.reach = 0.6 * length;
        muscle.growth = 0.03 * length;
        muscle.tension = 0.035 * length;
        return {};
    }

    std::string makePectoral(Muscle& muscle) const {
        const auto arm = joint("UpperArm"), elbow = joint("LowerArm");
        if (!arm || !elbow) return noJoint(arm ? "LowerArm" : "UpperArm");
        if (!_body) return "the body has no known front";
        const glm::dvec3 bone = centre(*elbow) - centre(*arm);
        const double length = glm::length(bone);
        muscle.name = _side + "Pectoral";
        moveByTurning(_joints[*arm], _bound[*arm], *arm,
                      glm::normalize(0.8 * _body->front - 0.6 * _outwards), _body->front, 90.0,
                      150.0, muscle);
        const glm::dvec3 middle = centre(*arm) - _outwards * fromMiddle(*arm);
        setLine(middle - 0.36 * length * _body->up, centre(*arm) - 0.08 * length * _body->up,
                _body->front, muscle);
        muscle.peak = 0.5;
        muscle.widthAtOrigin = 0.42 * length;
        muscle.widthAtInsertion = 0.25 * length;
        muscle.reach = 1.2 * length;
        muscle.growth = 0.035 * length;
        muscle.tension = 0.045 * length;
        return {};
    }

    std::string makeTrapezius(Muscle& muscle) const {
        const auto collar = joint("Collar"), arm = joint("UpperArm"), neck = jointOf("Neck");
        if (!collar || !arm || !neck)
            return noJoint(!neck ? "Neck" : collar ? "UpperArm" : "Collar", !neck);
        if (!_body) return "the body has no known front";
        const double width = glm::distance(centre(*neck), centre(*arm));
        muscle.name = _side + "Trapezius";
        moveByTurning(_joints[*collar], _bound[*collar], *collar, _body->up, _body->front, 30.0,
                      60.0, muscle);
        setLine(centre(*neck), centre(*arm), _body->up - 0.4 * _body->front, muscle);
        muscle.peak = 0.4;
        muscle.widthAtOrigin = muscle.widthAtInsertion = 0.5 * width;
        muscle.reach = 0.8 * width;
        muscle.growth = 0.05 * width;
        muscle.tension = 0.05 * width;
        return {};
    }

    std::string makeGluteus(Muscle& muscle) const {
        const auto leg = joint("UpperLeg"), knee = joint("LowerLeg");
        if (!leg || !knee) return noJoint(leg ? "LowerLeg" : "UpperLeg");
        if (!_body) return "the body has no known front";
        const double length = glm::distance(centre(*leg), centre(*knee));
        const double aside = fromMiddle(*leg);
        muscle.name = _side + "Gluteus";
        moveByTurning(_joints[*leg], _bound[*leg], *leg, -_body->front, _body->front, 30.0, 60.0,
                      muscle);
        setLine(centre(*leg) + 0.27 * length * _body->up - 0.1 * aside * _outwards,
                centre(*leg) - 0.22 * length * _body->up + 0.1 * aside * _outwards, -_body->front,
                muscle);
        muscle.peak = 0.5;
        muscle.widthAtOrigin = muscle.widthAtInsertion = 1.0 * aside;
        muscle.reach = 0.7 * length;
        muscle.growth = 0.015 * length;
        muscle.tension = 0.026 * length;
        return {};
    }

private:
    std::optional<std::size_t> jointOf(const std::string& role) const {
        const auto found = _roles.joints.find(role);
        if (found == _roles.joints.end() || found->second.empty()) return std::nullopt;
        return static_cast<std::size_t>(found->second.front());
    }
    std::optional<std::size_t> joint(const std::string& role) const {
        return jointOf(_side + role);
    }
    const glm::dvec3& centre(std::size_t joint) const { return _joints[joint].centre; }

    std::string noJoint(const std::string& role, bool inMiddle = false) const {
        return "no joint has the role " + (inMiddle ? std::string() : _side) + role;
    }
    std::string withJoint(std::size_t joint, const std::string& reason) const {
        return reason.empty() ? reason : "joint \"" + _skeleton.joints[joint].name + "\" " + reason;
    }

    /// How far a joint is from the body's middle, along `_outwards`.
    double fromMiddle(std::size_t joint) const {
        return glm::dot(centre(joint) - _joints.front().centre, _outwards);
    }

    static void setLine(const glm::dvec3& origin, const glm::dvec3& insertion,
                        const glm::dvec3& side, Muscle& muscle) {
        muscle.origin = origin;
        muscle.insertion = insertion;
        muscle.side = glm::normalize(perpendicularPart(side, glm::normalize(insertion - origin)));
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
        if (const auto axis = findMainAxis(_skeleton, _joints, elbow)) {
            const glm::dvec3 inner = perpendicularPart(_isLeft ? *axis : -*axis, along);
            side += inner;
        }
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
        const auto add = [&](const char* name, const auto& make) {
            const std::string full = std::string(side) + name;
            if (std::any_of(options.ownMuscles.begin(), options.ownMuscles.end(),
                            [&](const Options& own) { return own.name == full; }))
                return; // the author's own replaces it
            Muscle muscle;
            const std::string reason = make(muscle);
            if (reason.empty())
                muscles.push_back(muscle);
            else
                notes.push_back("muscle " + full + " is left out: " + reason);
        };
        for (const LimbMuscle& known : kLimbMuscles)
            add(known.name, [&](Muscle& muscle) { return body.make(known, muscle); });
        add("Deltoid", [&](Muscle& muscle) { return body.makeDeltoid(muscle); });
        add("Pectoral", [&](Muscle& muscle) { return body.makePectoral(muscle); });
        add("Trapezius", [&](Muscle& muscle) { return body.makeTrapezius(muscle); });
        add("Gluteus", [&](Muscle& muscle) { return body.makeGluteus(muscle); });
    }
    return muscles;
}

} // namespace osgSkin
