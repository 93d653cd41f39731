// SPDX-License-Identifier: MIT
#include <osgSkinMotion/MakeWalker>

#include "clips/JointMaps.h"
#include "feet/Legs.h"
#include "walk/GaitCycle.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinRig/JointRoles>

#include <osg/ComputeBoundsVisitor>
#include <osg/MatrixTransform>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace osgSkin {
namespace {

[[noreturn]] void failWalker(const std::string& what) {
    throw Error("walker: " + what);
}

/// A character's clips and the figure that they move.
class WalkerMaker {
public:
    WalkerMaker(osg::Node& character, const WalkerOptions& options)
        : _options(options), _character(ClipCharacter::create(character)) {}

    osg::ref_ptr<Walker> make(WalkerReport& report) {
        findClips(report);
        Gaits::Set set;
        set.legs = _body.legs;
        set.facing = facing();
        const double floor = findStanding(set, report);
        set.walking = findCycle(*clip(report.walking), _body, floor, report.walkSlide);
        report.walkSpeed = set.walking.speed();
        if (!report.running.empty()) {
            set.running = findCycle(*clip(report.running), _body, floor, report.runSlide);
            report.runSpeed = set.running.speed();
        }
        if (report.standing.empty()) set.standing = standingOf(*set.walking.clip);
        for (const std::string& name : _options.others)
            set.others.push_back(onTheSpot(*clip(name), _body));
        set.upperBody = jointOf(_roles.joint("Spine") >= 0 ? "Spine" : "Hips");
        set.toWalker = toOsg(_body.toLevel);
        return build(set);
    }

private:
    double facing() const {
        return _options.forward == WalkerOptions::Forward::PlusX ? 0.0 : -glm::half_pi<double>();
    }

    const SampledClip* clip(const std::string& name) { return _character->clip(name).get(); }

    /// A role's first joint.
    std::size_t jointOf(const std::string& role) const {
        const int joint = _roles.joint(role);
        if (joint < 0) failWalker("the character's skeleton has no joint that is known as " + role);
        return static_cast<std::size_t>(joint);
    }

    void findBody();
    void findClips(WalkerReport& report);
    std::string named(const std::string& asked, const std::vector<std::string>& words);
    double findStanding(Gaits::Set& set, const WalkerReport& report);
    osg::ref_ptr<const SampledClip> standingOf(const SampledClip& walk) const;
    osg::ref_ptr<Walker> build(Gaits::Set& set) const;

    const WalkerOptions _options;
    const osg::ref_ptr<ClipCharacter> _character;
    JointRoles _roles;                     ///< of the clips' joints
    osg::ref_ptr<const SampledClip> _clip; ///< one of the character's, for its joints
    WalkingBody _body;
};

/// Radians by which a clip's joints turn in a second, all together.
double restlessness(const SampledClip& clip) {
    double sum = 0.0;
    for (std::size_t i = 1; i < clip.sampleCount(); ++i)
        for (std::size_t j = 0; j < clip.joints().size(); ++j)
            sum += 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(clip.sample(i - 1)[j].rotation,
                                                                   clip.sample(i)[j].rotation))));
    return sum / clip.duration();
}

/// The clip that is asked for, or else the one with one of the words and the shortest name, since
/// others are variants ("2H_Melee_Idle"); of several the calmest.
std::string WalkerMaker::named(const std::string& asked, const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const auto& animation : _character->animations()) names.push_back(animation->getName());
    if (!asked.empty()) {
        const std::vector<std::size_t> meant = clipsMeant(asked, names);
        if (meant.size() == 1) return names[meant.front()];
        failWalker("no clip \"" + asked + "\"" + expectedNames(asked, names));
    }
    for (const std::string& word : words) {
        std::string best;
        for (const std::string& name : names) {
            std::string lower = name;
            std::transform(lower.begin(), lower.end(), lower.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
            if (lower.find(word) == std::string::npos || lower.find("back") != std::string::npos)
                continue;
            if (best.empty() || name.size() < best.size() ||
                (name.size() == best.size() &&
                 restlessness(*clip(name)) < restlessness(*clip(best))))
                best = name;
        }
        if (!best.empty()) return best;
    }
    return {};
}

void WalkerMaker::findBody() {
    const RestSkeleton rest = restOf(*_clip);
    _roles = recogniseJoints(rest);
    _body = {};
    _body.toLevel =
        glm::rotate(glm::dmat4(1.0), facing() + glm::half_pi<double>(), glm::dvec3(0.0, 0.0, 1.0)) *
        toGlm(_character->toWorld());
    _body.forward = {std::cos(facing()), std::sin(facing()), 0.0};
    _body.hips = jointOf("Hips");
    RestLegs legs = findLegs(rest, _roles, _body.toLevel, _body.forward, "walker");
    measureSoles(*_character, _body.toLevel, legs);
    _body.leg = legs.length;
    const glm::dmat4 toRest = glm::inverse(_body.toLevel);
    for (std::size_t side = 0; side < legs.sides.size(); ++side) {
        const RestLeg& leg = legs.sides[side];
        const glm::dvec3 ball = transformPoint(toRest, leg.ball);
        _body.legs[side] = {leg.hip,
                            leg.knee,
                            leg.ankle,
                            leg.toe,
                            transformPoint(toRest, leg.heel),
                            ball,
                            transformPoint(toRest, leg.tip)};
        _body.ankles[side] = leg.ankle;
        _body.balls[side] = ball;
    }
}

void WalkerMaker::findClips(WalkerReport& report) {
    const osgAnimation::AnimationList& all = _character->animations();
    if (all.empty()) failWalker("the character has no clip, expected one that walks");
    _clip = clip(all.front()->getName());
    findBody();
    for (const std::string& other : _options.others) named(other, {});
    report.standing = named(_options.standing, {"idle", "stand", "breath"});
    report.walking = named(_options.walking, {"walk"});
    report.running = named(_options.running, {"run", "jog", "sprint"});
    if (!report.walking.empty()) return;
    // The slowest one that goes, in leg lengths a second.
    double slowest = 0.0;
    for (const auto& animation : all) {
        const double speed = meanSpeed(*clip(animation->getName()), _body) / _body.leg;
        if (speed < 0.4 || (slowest > 0.0 && speed >= slowest)) continue;
        slowest = speed;
        report.walking = animation->getName();
    }
    if (report.walking.empty()) {
        std::string names;
        for (const auto& animation : all)
            names += (names.empty() ? "\"" : ", \"") + animation->getName() + "\"";
        failWalker("none of the character's clips walks, expected one; it has " + names);
    }
    if (report.running == report.walking) report.running.clear();
}

/// The pose of standing, and the height of its balls of the feet.
double WalkerMaker::findStanding(Gaits::Set& set, const WalkerReport& report) {
    if (!report.standing.empty()) set.standing = onTheSpot(*clip(report.standing), _body);
    double floor = 0.0;
    for (const glm::dvec3& ball : _body.balls) floor += 0.5 * transformPoint(_body.toLevel, ball).z;
    if (!set.standing) return floor;
    const FootTrack track = findTrack(*set.standing, _body);
    return 0.5 * (track.ball[0].front().z + track.ball[1].front().z);
}

/// A standing pose made of a walk: its mean, on straight legs.
osg::ref_ptr<const SampledClip> WalkerMaker::standingOf(const SampledClip& walk) const {
    const std::size_t joints = walk.joints().size();
    std::vector<JointSample> mean(walk.sample(0), walk.sample(0) + joints);
    for (std::size_t i = 1; i < walk.sampleCount(); ++i)
        for (std::size_t j = 0; j < joints; ++j)
            mean[j] = blend(mean[j], walk.sample(i)[j], 1.0 / double(i + 1));
    for (std::size_t j = 0; j < joints; ++j)
        for (const Gaits::Leg& leg : _body.legs) {
            int above = static_cast<int>(j);
            while (above > static_cast<int>(leg.hip))
                above = walk.joints()[static_cast<std::size_t>(above)].parent;
            if (above == static_cast<int>(leg.hip)) mean[j] = {};
        }
    mean[walk.rootJoint()] = {};
    const osg::ref_ptr<const SampledClip> result =
        SampledClip::create("standing", walk.joints(), mean, 1.0);
    return onTheSpot(*result, _body);
}

osg::ref_ptr<Walker> WalkerMaker::build(Gaits::Set& set) const {
    const osg::ref_ptr<Walker> walker = new Walker;
    const osg::Matrixd turn = osg::Matrixd::inverse(_character->toWorld()) * set.toWalker;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> places;
    const auto add = [&](const osg::Matrixd& matrix, const ClipCharacter::Appearance& appearance) {
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(matrix);
        place->setDataVariance(osg::Object::DYNAMIC);
        place->setStateSet(appearance.state);
        place->setNodeMask(appearance.mask);
        walker->addChild(place);
        places.push_back(place);
        return place;
    };
    const auto ownCopy = [](osg::Node* node) -> osg::ref_ptr<osg::Node> {
        const auto* skin = dynamic_cast<const DeformableSkin*>(node);
        if (!skin) return node;
        const osg::ref_ptr<DeformableSkin> copy = osg::clone(skin, osg::CopyOp::SHALLOW_COPY);
        copy->setUpdateCallback(nullptr);
        return copy;
    };
    for (const ClipCharacter::Skin& skin : _character->skins())
        add(skin.toWorld * turn, skin.appearance)->addChild(ownCopy(skin.skin));
    for (const ClipCharacter::Rigid& rigid : _character->rigids()) {
        const osg::ref_ptr<osg::MatrixTransform> place = add(set.toWalker, rigid.appearance);
        place->setName(rigid.joint);
        for (const osg::ref_ptr<osg::Node>& part : rigid.parts) place->addChild(ownCopy(part));
    }
    // The standing figure's soles are the floor.
    const auto setGaits = [&] {
        const osg::ref_ptr<Gaits> gaits = new Gaits;
        gaits->set(set);
        walker->setGaits(gaits);
    };
    setGaits();
    osg::ComputeBoundsVisitor bounds;
    walker->accept(bounds);
    const osg::Matrixd down = osg::Matrixd::translate(0.0, 0.0, -bounds.getBoundingBox().zMin());
    set.toWalker.postMult(down);
    for (const osg::ref_ptr<osg::MatrixTransform>& place : places)
        place->setMatrix(place->getMatrix() * down);
    setGaits();
    return walker;
}

} // namespace

osg::ref_ptr<Walker> makeWalker(osg::Node& character, const WalkerOptions& options,
                                WalkerReport* report) {
    WalkerReport unused;
    return WalkerMaker(character, options).make(report ? *report : unused);
}

} // namespace osgSkin
