// SPDX-License-Identifier: MIT
// A tube that an osgAnimation skeleton animates, for tests of players without one.
#pragma once

#include "FindNodes.h"
#include "TubeSkin.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgUtil/UpdateVisitor>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace played {

constexpr double kFrame = 1.0 / 30.0;

inline osgSkin::RestSkeleton tubeRig() {
    osgSkin::RestSkeleton rig;
    rig.add("root", -1, glm::dvec3(0, 0, 0));
    rig.add("middle", 0, glm::dvec3(0, 2, 0));
    rig.add("end", 1, glm::dvec3(0, 4, 0));
    return rig;
}

/// Rotations of all joints, and a walk along x with steps up and down.
inline osgSkin::Clip someClip(std::size_t frames, double speed) {
    osgSkin::Clip clip;
    clip.name = "some";
    clip.frameTime = kFrame;
    clip.frames = frames;
    clip.joints = 3;
    for (std::size_t f = 0; f < frames; ++f) {
        const double phase = 2.0 * glm::pi<double>() * double(f) / double(frames);
        for (std::size_t j = 0; j < 3; ++j)
            clip.rotations.push_back(
                glm::angleAxis(speed * std::sin(phase + double(j)),
                               glm::normalize(glm::dvec3(1.0, 0.4 * double(j), 0.3))));
        clip.rootPositions.emplace_back(0.1 * speed * double(f), 1.0 + 0.1 * std::sin(phase), 0.0);
    }
    return clip;
}

/// A character as binding makes it: a skin under a skeleton that a manager animates, and a rigid
/// part.
struct Character {
    osgSkin::RestSkeleton rig = tubeRig();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    osg::ref_ptr<osgSkin::RigidPart> rigid;
    osg::ref_ptr<osgAnimation::Animation> animation;

    explicit Character(const osgSkin::Clip& clip) {
        const test::Tube tube(41, 12);
        const osg::ref_ptr<osg::Geometry> points = test::makeGeometry(tube);
        points->removePrimitiveSet(0); // what is drawn is for a test to add
        skin->setSkin(points, tube.model());
        skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
        osgAnimation::Bone* bone = findBone(*skeleton, "end");
        rigid = new osgSkin::RigidPart(new osg::Geometry, *bone);
        skeleton->addChild(skin);
        animation = osgSkin::makeAnimation(clip, rig);
        const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
            new osgAnimation::BasicAnimationManager;
        manager->registerAnimation(animation);
        scene->addUpdateCallback(manager);
        const osg::ref_ptr<osg::MatrixTransform> upright =
            new osg::MatrixTransform(osg::Matrix::rotate(1.0, osg::Vec3d(1, 0, 0)));
        upright->addChild(skeleton);
        scene->addChild(upright);
        manager->buildTargetReference();
        update(0.0);
        manager->playAnimation(animation);
    }
    static osgAnimation::Bone* findBone(osg::Group& below, const std::string& name) {
        for (unsigned int i = 0; i < below.getNumChildren(); ++i) {
            auto* bone = dynamic_cast<osgAnimation::Bone*>(below.getChild(i));
            if (!bone) continue;
            if (bone->getName() == name) return bone;
            if (auto* found = findBone(*bone, name)) return found;
        }
        return nullptr;
    }
    void update(double time) const { test::updateAt(*scene, time); }
};

/// The only skin below a node.
inline osgSkin::DeformableSkin& skinOf(osg::Node& node) {
    return *test::findNodes<osgSkin::DeformableSkin>(node).at(0).node;
}

using Vertices = std::vector<osg::Vec3>;

using test::verticesOf;

inline Vertices verticesOf(const osg::Geometry* geometry) {
    return static_cast<const osg::Vec3Array&>(*geometry->getVertexArray()).asVector();
}

inline double difference(const Vertices& a, const Vertices& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, double((a[i] - b[i]).length()));
    return largest;
}

inline Vertices posedBy(osgSkin::ClipPlayer& player, osgSkin::DeformableSkin& skin) {
    EXPECT_TRUE(player.pose());
    return verticesOf(skin);
}

constexpr double kSize = 6.0;

} // namespace played
