// SPDX-License-Identifier: MIT
#include "PoseSet.h"

#include <osgSkin/BoneReader>
#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/ApplyFrame>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Retarget>

#include <iterator>
#include <map>

namespace quality {
namespace {

/// Samples first, first + step, ... below `end`, counted as the file does: its calibration pose,
/// where it has one, is frame 0.
struct Clip {
    const char* name;
    const char* file;
    std::size_t first, end, step;
};

constexpr Clip kClips[] = {{"12_01", "12_01_walk_pybvh.bvh", 10, 519, 60},
                           {"124_01", "124_01_pitch_excerpt_120hz.bvh", 1, 28, 3},
                           {"01_03", "01_03.bvh", 400, 4399, 400},
                           {"01_01", "01_01.bvh", 300, 2699, 300}};

/// The motions' joints for those of a game engine's rig; nothing for a rig with their own names.
std::map<std::string, std::string> jointMap(const osgSkin::RestSkeleton& rig) {
    static const std::map<std::string, std::string> kMiddle = {
        {"pelvis", "Hips"},     {"spine_01", "LowerBack"}, {"spine_02", "Spine"},
        {"spine_03", "Spine1"}, {"neck_01", "Neck"},       {"head", "Head"}};
    static const std::map<std::string, std::string> kBothSides = {
        {"clavicle", "Shoulder"}, {"upperarm", "Arm"}, {"lowerarm", "ForeArm"},
        {"hand", "Hand"},         {"thigh", "UpLeg"},  {"calf", "Leg"},
        {"foot", "Foot"},         {"ball", "ToeBase"}};
    std::map<std::string, std::string> map = kMiddle;
    for (const auto& [name, motion] : kBothSides) {
        map[name + "_l"] = "Left" + motion;
        map[name + "_r"] = "Right" + motion;
    }
    for (auto entry = map.begin(); entry != map.end();)
        entry = rig.find(entry->first) < 0 ? map.erase(entry) : std::next(entry);
    return map;
}

} // namespace

std::vector<NamedPose> standardPoses(const std::string& folder, const Subject& subject) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(subject.rig);
    osgSkin::BoneReader bones(subject.binding.joints, *skeleton);
    std::vector<NamedPose> poses;
    for (const Clip& entry : kClips) {
        const osgSkin::Clip clip = osgSkin::retarget(
            osgSkin::importMotion(folder + "/" + entry.file), subject.rig, {jointMap(subject.rig)});
        for (std::size_t frame = entry.first; frame < entry.end; frame += entry.step) {
            osgSkin::applyFrame(clip, subject.rig, frame, *skeleton);
            poses.push_back({entry.name + (":" + std::to_string(frame)), bones.read()});
        }
    }
    return poses;
}

} // namespace quality
