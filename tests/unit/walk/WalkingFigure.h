// SPDX-License-Identifier: MIT
// A figure of a few triangles that walks and runs over a floor, with feet that do not slide.
#pragma once

#include <osgSkin/AutoPlayManager>
#include <osgSkin/DeformableSkin>
#include <osgSkin/SkinModel>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinMotion/MakeWalker>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/RestSkeleton>

#include <osg/Geometry>
#include <osg/Group>
#include <osgAnimation/Skeleton>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace walking {

constexpr double kThigh = 0.43, kShin = 0.4, kAnkle = 0.07; ///< m
constexpr double kToe = 0.15, kTip = 0.23;                  ///< m in front of the ankle
constexpr double kWalkStride = 1.5, kWalkTime = 1.0;        ///< m and seconds of a cycle
constexpr double kRunStride = 2.4, kRunTime = 0.75;

/// Z up, looking along -Y, so that its left side is at +X.
inline osgSkin::RestSkeleton figureRig() {
    osgSkin::RestSkeleton rig;
    const int hips = rig.add("Hips", -1, glm::dvec3(0, 0, 0.95));
    const int spine = rig.add("Spine", hips, glm::dvec3(0, 0, 1.1));
    const int neck = rig.add("Neck", spine, glm::dvec3(0, 0, 1.45));
    rig.add("Head", neck, glm::dvec3(0, 0, 1.55));
    for (const double side : {1.0, -1.0}) {
        const std::string name = side > 0.0 ? "Left" : "Right";
        const int upper = rig.add(name + "Arm", spine, glm::dvec3(0.2 * side, 0, 1.4));
        const int lower = rig.add(name + "ForeArm", upper, glm::dvec3(0.25 * side, 0, 1.12));
        rig.add(name + "Hand", lower, glm::dvec3(0.3 * side, 0, 0.88));
    }
    for (const double side : {1.0, -1.0}) {
        const std::string name = side > 0.0 ? "Left" : "Right";
        const int upper =
            rig.add(name + "UpLeg", hips, glm::dvec3(0.1 * side, 0, kAnkle + kShin + kThigh));
        const int lower = rig.add(name + "Leg", upper, glm::dvec3(0.1 * side, 0, kAnkle + kShin));
        const int foot = rig.add(name + "Foot", lower, glm::dvec3(0.1 * side, 0, kAnkle));
        rig.add(name + "ToeBase", foot, glm::dvec3(0.1 * side, -kToe, 0));
    }
    return rig;
}

inline std::size_t jointOf(const osgSkin::RestSkeleton& rig, const std::string& name) {
    return static_cast<std::size_t>(rig.find(name));
}

struct GaitOf {
    std::string name;
    double stride = 0.0, time = 0.0;
    double carries = 0.0; ///< share of the cycle in which a foot is on the floor
    double drop = 0.0;    ///< of the hips
    bool isOnTheSpot = false;
    double cycles = 1.0;
    double direction = 0.0; ///< of the way, about Z from -Y
    double roll = 0.0; ///< radians, by which a foot has rolled over its tip as it leaves the floor
};

/// A clip whose feet stand still on the floor while they carry, along -Y and then turned.
inline osgSkin::Clip gaitClip(const GaitOf& gait) {
    const osgSkin::RestSkeleton rig = figureRig();
    osgSkin::Clip clip;
    clip.name = gait.name;
    clip.frameTime = 1.0 / 60.0;
    clip.joints = rig.joints.size();
    clip.frames = static_cast<std::size_t>(std::lround(60.0 * gait.time * gait.cycles));
    const glm::dquat turn = glm::angleAxis(gait.direction, glm::dvec3(0, 0, 1));
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const double cycle = double(f) / 60.0 / gait.time;
        std::vector<glm::dquat> pose(clip.joints, glm::dquat(1, 0, 0, 0));
        for (std::size_t side = 0; side < 2; ++side) {
            // From -carries/2 to carries/2 about the middle of its stance the foot is planted.
            double phase = cycle + 0.5 * double(side) + 0.5 * gait.carries;
            phase -= std::floor(phase);
            double ahead = 0.0, lift = 0.0; // of the hips; above the floor
            double roll = 0.0;
            if (phase < gait.carries) {
                ahead = gait.stride * (0.5 * gait.carries - phase);
                const double late = std::max(0.0, 2.5 * phase / gait.carries - 1.5);
                roll = gait.roll * late * late;
            } else {
                const double swing = (phase - gait.carries) / (1.0 - gait.carries);
                ahead = gait.stride * (swing * swing * (3.0 - 2.0 * swing) -
                                       (1.0 - gait.carries) * swing - 0.5 * gait.carries);
                lift = 0.12 * std::sin(glm::pi<double>() * swing);
                roll = gait.roll * (1.0 - swing) * (1.0 - swing);
            }
            // The ankle rises behind the tip.
            const double c = std::cos(roll) - 1.0, s = std::sin(roll);
            const double y = -ahead + kTip * c - kAnkle * s;
            const double z = lift + kTip * s + kAnkle * c - (kShin + kThigh - gait.drop);
            const double d = std::min(std::hypot(y, z), 0.9999 * (kThigh + kShin));
            const double straight = std::atan2(y, -z);
            const double upper = straight - std::acos((kThigh * kThigh + d * d - kShin * kShin) /
                                                      (2.0 * kThigh * d));
            const double lower =
                straight + std::acos((kShin * kShin + d * d - kThigh * kThigh) / (2.0 * kShin * d));
            const std::string name = side == 0 ? "Left" : "Right";
            const glm::dvec3 x(1, 0, 0);
            pose[jointOf(rig, name + "UpLeg")] = glm::angleAxis(upper, x);
            pose[jointOf(rig, name + "Leg")] = glm::angleAxis(lower - upper, x);
            pose[jointOf(rig, name + "Foot")] = glm::angleAxis(roll - lower, x);
            pose[jointOf(rig, name + "Arm")] = glm::angleAxis(ahead, x);
        }
        pose[0] = turn;
        clip.rotations.insert(clip.rotations.end(), pose.begin(), pose.end());
        const double way = gait.isOnTheSpot ? 0.0 : gait.stride * cycle;
        clip.rootPositions.push_back(turn * glm::dvec3(0, -way, 0.95 - gait.drop));
    }
    return clip;
}

inline GaitOf walk() {
    return {"walk", kWalkStride, kWalkTime, 0.6, 0.09};
}
inline GaitOf run() {
    return {"run", kRunStride, kRunTime, 0.34, 0.12};
}

/// It stands, and breathes with its arms.
inline osgSkin::Clip idleClip() {
    const osgSkin::RestSkeleton rig = figureRig();
    osgSkin::Clip clip;
    clip.name = "idle";
    clip.frameTime = 0.1;
    clip.frames = 10;
    clip.joints = rig.joints.size();
    for (std::size_t f = 0; f < clip.frames; ++f) {
        std::vector<glm::dquat> pose(clip.joints, glm::dquat(1, 0, 0, 0));
        pose[jointOf(rig, "LeftArm")] = glm::angleAxis(
            0.05 * std::sin(0.2 * glm::pi<double>() * double(f)), glm::dvec3(0, 1, 0));
        clip.rotations.insert(clip.rotations.end(), pose.begin(), pose.end());
        clip.rootPositions.emplace_back(0, 0, 0.95);
    }
    return clip;
}

/// The right arm goes up.
inline osgSkin::Clip waveClip() {
    osgSkin::Clip clip = idleClip();
    clip.name = "wave";
    const std::size_t arm = jointOf(figureRig(), "RightArm");
    for (std::size_t f = 0; f < clip.frames; ++f)
        clip.rotations[f * clip.joints + arm] = glm::angleAxis(2.5, glm::dvec3(0, 1, 0));
    return clip;
}

/// A character with a skin of one triangle a joint, each of which moves with its joint alone; a
/// foot's has the ball of the foot on the floor as its first vertex, a toe's the tip as its last.
inline osg::ref_ptr<osg::Group> makeFigure(const std::vector<osgSkin::Clip>& clips) {
    const osgSkin::RestSkeleton rig = figureRig();
    osgSkin::Binding binding;
    std::vector<glm::vec3> positions, normals;
    std::vector<std::uint32_t> source;
    binding.firstInfluence.push_back(0);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const glm::dvec3 up(0, 0, 1);
        binding.joints.push_back(
            {rig.joints[j].name, rig.joints[j].parent, rig.joints[j].centre, up, up});
        const bool isFoot = rig.joints[j].name.find("Foot") != std::string::npos;
        const glm::dvec3 first = isFoot ? rig.joints[j + 1].centre : rig.joints[j].centre;
        const bool isToe = rig.joints[j].name.find("Toe") != std::string::npos;
        const glm::dvec3 last = isToe ? glm::dvec3(0, kToe - kTip, 0) : glm::dvec3(0, 0.05, 0.02);
        for (const glm::dvec3& corner : {glm::dvec3(0), glm::dvec3(0.05, 0, 0.02), last}) {
            positions.emplace_back(first + corner);
            normals.emplace_back(0, 0, 1);
            source.push_back(static_cast<std::uint32_t>(source.size()));
            binding.regions.push_back(static_cast<std::uint32_t>(j));
            std::vector<std::uint32_t> above;
            for (int k = static_cast<int>(j); k >= 0;
                 k = rig.joints[static_cast<std::size_t>(k)].parent)
                above.insert(above.begin(), static_cast<std::uint32_t>(k));
            for (const std::uint32_t k : above) binding.influences.push_back({k, 1.0f, 1.0f});
            binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        }
    }
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, up = new osg::Vec3Array;
    const osg::ref_ptr<osg::DrawElementsUShort> triangles =
        new osg::DrawElementsUShort(GL_TRIANGLES);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        vertices->push_back({positions[v].x, positions[v].y, positions[v].z});
        up->push_back({0, 0, 1});
        triangles->push_back(static_cast<GLushort>(v));
    }
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(up, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(geometry, osgSkin::SkinModel::create(binding, positions, normals, source));
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    skeleton->addChild(skin);
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    for (const osgSkin::Clip& clip : clips)
        manager->registerAnimation(osgSkin::makeAnimation(clip, rig));
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(skeleton);
    root->setUpdateCallback(manager);
    return root;
}

inline osg::ref_ptr<osgSkin::Walker> makeFigureWalker() {
    const osg::ref_ptr<osg::Group> figure =
        makeFigure({idleClip(), gaitClip(walk()), gaitClip(run()), waveClip()});
    osgSkin::WalkerOptions options;
    options.others = {"wave"};
    return osgSkin::makeWalker(*figure, options);
}

} // namespace walking
