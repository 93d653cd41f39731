// SPDX-License-Identifier: MIT
// Any bytes as springs, constraints, gaits, or the messages of an actor: refused, or they move
// bones to finite places, within a bounded time.
#include "Attempt.h"
#include "UpdateAt.h"

#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/SpringBones>
#include <osgSkinMotion/Walker>
#include <osgSkinRig/LiveRetarget>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/VmcPose>

#include <osg/MatrixTransform>
#include <osgAnimation/Bone>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

constexpr const char* kBones[] = {
    "Hips",          "LeftUpperLeg", "LeftLowerLeg",  "LeftFoot",      "LeftToes", "RightUpperLeg",
    "RightLowerLeg", "RightFoot",    "RightToes",     "Spine",         "Head",     "LeftUpperArm",
    "LeftLowerArm",  "LeftHand",     "RightUpperArm", "RightLowerArm", "RightHand"};
constexpr int kParents[] = {-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9, 9, 11, 12, 9, 14, 15};
constexpr double kPlaces[][3] = {
    {0, 1, 0},     {.1, .9, 0},  {.1, .5, 0},   {.1, .1, 0},    {.1, 0, .15}, {-.1, .9, 0},
    {-.1, .5, 0},  {-.1, .1, 0}, {-.1, 0, .15}, {0, 1.2, 0},    {0, 1.6, 0},  {.2, 1.4, 0},
    {.45, 1.4, 0}, {.7, 1.4, 0}, {-.2, 1.4, 0}, {-.45, 1.4, 0}, {-.7, 1.4, 0}};
constexpr std::size_t kCount = std::size(kBones);

osgSkin::RestSkeleton figure() {
    osgSkin::RestSkeleton result;
    for (std::size_t j = 0; j < kCount; ++j)
        result.add(kBones[j], kParents[j], glm::dvec3(kPlaces[j][0], kPlaces[j][1], kPlaces[j][2]));
    return result;
}

class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : _at(data), _end(data + size) {}

    bool isAtEnd() const { return _at == _end; }
    unsigned byte() { return isAtEnd() ? 0u : *_at++; }
    /// Any float, or a small number.
    double number() {
        if (byte() % 2 == 0) return (int(byte()) - 128) / 64.0;
        float result = 0.0f;
        const auto size =
            std::min<std::size_t>(sizeof result, static_cast<std::size_t>(_end - _at));
        std::memcpy(&result, _at, size);
        _at += size;
        return double(result);
    }
    glm::dvec3 vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }
    glm::dquat rotation() {
        const glm::dvec3 v = vector();
        return {number(), v.x, v.y, v.z};
    }
    std::string bone() { return kBones[byte() % kCount]; }

private:
    const std::uint8_t *_at, *_end;
};

void requireFinite(osg::Node& scene) {
    struct Check : osg::NodeVisitor {
        Check() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Transform& node) override {
            if (node.asMatrixTransform() && !node.asMatrixTransform()->getMatrix().valid())
                std::abort();
            traverse(node);
        }
    } check;
    scene.accept(check);
}

void play(osg::Node& scene) {
    for (const double time : {0.0, 0.02, 0.2}) test::updateAt(scene, time);
    requireFinite(scene);
}

void swing(Bytes& in) {
    osgSkin::SpringSettings settings;
    while (!in.isAtEnd()) {
        if (in.byte() % 2 == 0) {
            settings.colliders.push_back({in.bone(), in.vector(), in.vector(), in.number()});
            continue;
        }
        osgSkin::SpringSettings::Chain& chain = settings.chains.emplace_back();
        for (unsigned j = in.byte() % 8; j > 0; --j) {
            osgSkin::SpringSettings::Joint joint;
            joint.name = in.bone();
            joint.tip = in.vector();
            for (double* value : {&joint.stiffness, &joint.drag, &joint.radius})
                *value = in.number();
            joint.gravity = in.vector();
            chain.joints.push_back(joint);
        }
        for (unsigned c = in.byte(); c > 0; --c) chain.colliders.push_back(in.byte());
        if (in.byte() % 4 == 0) chain.centre = in.bone();
    }
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(figure());
    const osg::ref_ptr<osgSkin::SpringBones> springs = new osgSkin::SpringBones(settings);
    osgSkin::attach(*skeleton, *springs);
    play(*skeleton);
}

void constrain(Bytes& in) {
    std::vector<osgSkin::Constraint> list;
    while (!in.isAtEnd()) {
        osgSkin::Constraint& constraint = list.emplace_back();
        constraint.kind = static_cast<osgSkin::Constraint::Kind>(in.byte() % 3);
        constraint.axis = in.vector();
        constraint.weight = in.number();
        for (osgSkin::Constraint::Joint* joint : {&constraint.joint, &constraint.source}) {
            joint->name = in.bone();
            for (glm::dquat* q : {&joint->rest, &joint->axes, &joint->above}) *q = in.rotation();
        }
    }
    fuzz::attempt([&] {
        const osg::ref_ptr<osgSkin::Constraints> constraints = new osgSkin::Constraints(list);
        const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(figure());
        osgSkin::attach(*skeleton, *constraints);
        play(*skeleton);
        const osg::ref_ptr<osgSkin::Constraints> again =
            new osgSkin::Constraints(constraints->get()); // what is saved can be read
    });
}

void walk(Bytes& in) {
    std::vector<osgSkin::SampledClip::Joint> joints;
    for (std::size_t j = 0; j < kCount; ++j)
        joints.push_back({kBones[j], kParents[j], {kPlaces[j][0], kPlaces[j][1], kPlaces[j][2]}});
    fuzz::attempt([&] {
        const auto clip = [&](const char* name) {
            std::vector<osgSkin::JointSample> samples(2 * kCount);
            for (unsigned k = in.byte() % 8; k > 0; --k)
                samples[in.byte() % samples.size()].translation = in.vector();
            return osgSkin::SampledClip::create(name, joints, samples, 0.5);
        };
        osgSkin::Gaits::Set set;
        set.standing = clip("stand");
        set.walking.clip = clip("walk");
        set.walking.stride = in.number();
        for (osgSkin::Gaits::Contact& contact : set.walking.contacts)
            contact = {in.number(), in.number()};
        for (std::size_t leg = 0; leg < 2; ++leg)
            set.legs[leg] = {1 + 4 * leg, 2 + 4 * leg, 3 + 4 * leg, 4 + 4 * leg,
                             in.vector(), in.vector(), in.vector()};
        set.upperBody = 9;
        set.facing = in.number();
        const osg::ref_ptr<osgSkin::Gaits> gaits = new osgSkin::Gaits;
        gaits->set(set);
        const osg::ref_ptr<osgSkin::Walker> walker = new osgSkin::Walker;
        const osg::ref_ptr<osg::MatrixTransform> hand = new osg::MatrixTransform;
        hand->setName("LeftHand");
        walker->addChild(hand);
        walker->setGaits(gaits);
        for (int frame = 0; frame < 4; ++frame) {
            const glm::dvec3 place = in.vector();
            walker->setMotion({place.x, place.y, place.z}, in.number(), in.number(), in.number());
            test::updateAt(*walker, 0.1 * frame);
        }
        requireFinite(*walker);
    });
}

void perform(Bytes& in) {
    static const osgSkin::RestSkeleton rig = figure();
    osgSkin::VmcPose pose;
    for (std::size_t j = 0; j < kCount; ++j) {
        const int p = std::max(kParents[j], 0);
        const double* const above = kPlaces[p];
        pose.take("/VMC/Ext/Bone/Pos", kBones[j],
                  {-(kPlaces[j][0] - above[0] * (j > 0)), kPlaces[j][1] - above[1] * (j > 0),
                   kPlaces[j][2]},
                  {});
    }
    std::vector<osgSkin::JointSample> joints(kCount);
    while (!in.isAtEnd()) {
        const char* const address = in.byte() % 4 == 0 ? "/VMC/Ext/Root/Pos" : "/VMC/Ext/Bone/Pos";
        const std::string bone = in.bone();
        const glm::dvec3 place = in.vector();
        glm::dquat turn = in.rotation();
        if (in.byte() % 2 == 0) turn = glm::normalize(turn);
        pose.take(address, bone, {place.x, place.y, place.z}, {turn.x, turn.y, turn.z, turn.w});
    }
    auto retarget = osgSkin::LiveRetarget::create(pose.skeleton(), rig);
    if (!retarget || !retarget->apply(pose.rotations().data(), pose.root(), joints.data())) return;
    for (const osgSkin::JointSample& joint : joints)
        if (!osgSkin::isFinite(joint.rotation) || !osgSkin::isFinite(joint.translation))
            std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    constexpr void (*kKinds[])(Bytes&) = {swing, constrain, walk, perform};
    kKinds[in.byte() % std::size(kKinds)](in);
    return 0;
}
