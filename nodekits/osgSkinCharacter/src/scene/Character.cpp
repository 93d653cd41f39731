// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/Character>

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkin/SetMorph>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinMotion/SpringBones>

#include <osg/FrameStamp>
#include <osgAnimation/Channel>
#include <osgUtil/UpdateVisitor>

namespace osgSkin {
namespace {

/// Deforms the skins by the bones' present matrices.
void poseSkins(Character& character) {
    for (const AttachedSkin::Skin& attached : character.skin.skins)
        if (auto* update =
                dynamic_cast<UpdateDeformableSkin*>(attached.drawable->getUpdateCallback()))
            update->pose(*attached.drawable, *character.skeleton);
}

} // namespace

void Character::pose(const CharacterMotion& motion, std::size_t frame) {
    if (frame >= motion.clip.frames)
        throw Error(file + ": motion \"" + motion.name() + "\" has " +
                    std::to_string(motion.clip.frames) + " samples, found frame " +
                    std::to_string(frame));
    applyFrame(motion.clip, rest, frame, *skeleton);
    if (Constraints* const constraints = find<Constraints>(*skeleton))
        constraints->apply(*skeleton);
    for (const auto& [morph, weights] : motion.clip.morphs) setMorph(morph, weights[frame]);
    poseSkins(*this);
}

void Character::poseAt(const CharacterMotion& motion, double seconds) {
    if (manager->needToLink()) manager->link(root);
    if (UpdatePlayedSkeleton* played = UpdatePlayedSkeleton::of(*skeleton)) played->poseBones();
    const double speed = keySpeed(*motion.animation);
    for (const auto& channel : motion.animation->getChannels()) {
        channel->reset();
        channel->update(seconds * speed, 1.0f, 0);
    }
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(new osg::FrameStamp);
    SpringBones* const springs = find<SpringBones>(*skeleton);
    const bool swings = springs && springs->getEnabled();
    if (swings) springs->setEnabled(false); // they need the frames before
    root->traverse(visitor);                // without the manager, which would play on
    if (swings) springs->setEnabled(true);
    poseSkins(*this);
}

osg::ref_ptr<osgAnimation::Bone> Character::bone(const std::string& name) {
    const osgAnimation::BoneMap bones = skeleton ? bonesOf(*skeleton) : osgAnimation::BoneMap();
    const auto found = bones.find(name);
    if (found != bones.end()) return found->second;
    throw Error(file + ": no bone \"" + name + '"' +
                (bones.empty() ? std::string("; it has none") : expectedNames(name, bones)));
}

std::size_t Character::jointByRole(const std::string& role) const {
    const int joint = roles.joint(role);
    if (joint >= 0) return std::size_t(joint);
    throw Error(file + ": no joint is known to be the \"" + role + '"' +
                (roles.joints.empty() ? std::string("; none of its joints was recognised")
                                      : expectedNames(role, roles.joints)));
}

osg::ref_ptr<osgAnimation::Bone> Character::boneByRole(const std::string& role) {
    return bone(rest.joints[jointByRole(role)].name);
}

osg::Vec3d Character::restPosition(const std::string& role) const {
    return toOsg(rest.joints[jointByRole(role)].centre) * toWorld;
}

void Character::play(const std::string& motion) {
    std::vector<std::string> known;
    for (const CharacterMotion& each : motions) known.push_back(each.name());
    const std::vector<std::size_t> meant = clipsMeant(motion, known);
    if (meant.size() == 1) {
        if (ClipPlayer* const player = find<ClipPlayer>(*root)) {
            player->play({player->clip(known[meant.front()])}, 0.0);
            return;
        }
        manager->stopAll();
        manager->playAnimation(motions[meant.front()].animation);
        return;
    }
    throw Error(
        file + ": no motion \"" + motion + '"' +
        (known.empty() ? std::string("; the character has none") : expectedNames(motion, known)));
}

std::vector<std::string> Character::morphs() const {
    return morphNames(*root);
}

bool Character::setMorph(const std::string& name, float weight) {
    return osgSkin::setMorph(*root, name, weight);
}

} // namespace osgSkin
