// SPDX-License-Identifier: MIT
// A shipped game, without files and without the kits that read files or bind skins: an actor with
// CMU's joint names lifts an arm while it walks ahead, and a robot of half the size, whose names
// only the game knows, does the same.
#include <osgSkin/Error>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Retarget>

#include <osg/FrameStamp>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/BoneMapVisitor>
#include <osgUtil/UpdateVisitor>

#include <array>
#include <iostream>
#include <string>
#include <vector>

namespace {

/// Hips, spine, head, and the arms and legs of both sides, in this order.
using Names = std::array<const char*, 15>;

osgSkin::RestSkeleton makeBody(const Names& names, double size) {
    osgSkin::RestSkeleton body;
    const auto add = [&](int parent, double x, double y) {
        return body.add(names[body.joints.size()], parent, osg::Vec3d(x, y, 0) * size);
    };
    const auto end = [&](double x, double y, double z) {
        body.joints.back().tip = size * glm::dvec3(x, y, z);
    };
    const int hips = add(-1, 0, 10);
    const int spine = add(hips, 0, 12);
    add(spine, 0, 16);
    end(0, 18, 0);
    for (const double side : {1.0, -1.0}) {
        const int upperArm = add(spine, 2 * side, 15);
        const int lowerArm = add(upperArm, 5 * side, 15);
        add(lowerArm, 7 * side, 15);
        end(8 * side, 15, 0);
        const int upperLeg = add(hips, side, 9);
        const int lowerLeg = add(upperLeg, side, 5);
        add(lowerLeg, side, 1);
        end(side, 0, 2);
    }
    return body;
}

/// The hand's position at a time of the scene's animation.
osg::Vec3d handAt(double time, osg::Node& scene, const osgAnimation::Bone& hand) {
    osgUtil::UpdateVisitor visitor;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    visitor.setFrameStamp(stamp);
    scene.accept(visitor);
    return hand.getMatrixInSkeletonSpace().getTrans();
}

bool isNear(const osg::Vec3d& found, const osg::Vec3d& expected, const char* what) {
    std::cout << what << ": the hand is at " << found.x() << " " << found.y() << " " << found.z()
              << std::endl;
    return (found - expected).length() < 1e-3;
}

int play() {
    const osgSkin::RestSkeleton actor =
        makeBody({"Hips", "Spine", "Head", "LeftArm", "LeftForeArm", "LeftHand", "LeftUpLeg",
                  "LeftLeg", "LeftFoot", "RightArm", "RightForeArm", "RightHand", "RightUpLeg",
                  "RightLeg", "RightFoot"},
                 1.0);
    const osgSkin::RestSkeleton robot =
        makeBody({"base", "mast", "camera", "m1", "m2", "m3", "m4", "m5", "m6", "m7", "m8", "m9",
                  "m10", "m11", "m12"},
                 0.5);

    osgSkin::Motion motion;
    motion.name = "lift";
    motion.skeleton = actor;
    motion.frameTime = 0.5;
    const auto leftArm = static_cast<std::size_t>(actor.find("LeftArm"));
    for (int frame = 0; frame < 3; ++frame) { // the arm raised by 0, 45 and 90 degrees, one step
                                              // ahead each
        std::vector<osg::Quat> local(actor.joints.size());
        local[leftArm] = osg::Quat(frame * osg::PI_4, osg::Z_AXIS);
        motion.addFrame(osg::Vec3d(0, 10, frame), local);
    }

    osgSkin::RetargetOptions options;
    options.names = {{"robot",
                      {{"Hips", {"base"}},
                       {"Spine", {"mast"}},
                       {"Head", {"camera"}},
                       {"LeftUpperArm", {"m1"}},
                       {"LeftLowerArm", {"m2"}},
                       {"LeftHand", {"m3"}},
                       {"LeftUpperLeg", {"m4"}},
                       {"LeftLowerLeg", {"m5"}},
                       {"LeftFoot", {"m6"}},
                       {"RightUpperArm", {"m7"}},
                       {"RightLowerArm", {"m8"}},
                       {"RightHand", {"m9"}},
                       {"RightUpperLeg", {"m10"}},
                       {"RightLowerLeg", {"m11"}},
                       {"RightFoot", {"m12"}}}}};
    const osgSkin::Clip clip = osgSkin::retarget(motion, robot, options);

    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(robot);
    osgAnimation::BoneMapVisitor bones;
    skeleton->accept(bones);
    const osgAnimation::Bone& hand = *bones.getBoneMap().at("m3");
    osgSkin::applyFrame(clip, robot, 2, *skeleton);
    // The shoulder rests at 1 7.5 0, the arm is 2.5 long, and the robot has moved 1 ahead.
    bool ok = isNear(hand.getMatrixInSkeletonSpace().getTrans(), {1, 10, 1}, "sample 2");

    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(skeleton);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    scene->setUpdateCallback(manager);
    const osg::ref_ptr<osgAnimation::Animation> animation = osgSkin::makeAnimation(clip, robot);
    manager->registerAnimation(animation);
    manager->playAnimation(animation);
    ok = isNear(handAt(0.0, *scene, hand), {3.5, 7.5, 0}, "played, 0 s") && ok;
    ok = isNear(handAt(1.0, *scene, hand), {1, 10, 1}, "played, 1 s") && ok;
    return ok ? 0 : 1;
}

} // namespace

int main() {
    try {
        return play();
    } catch (const osgSkin::Error& error) {
        std::cerr << error.what() << std::endl;
        return 1;
    }
}
