// SPDX-License-Identifier: GPL-3.0-or-later
#include "Take.h"

#include "load/RigCharacter.h"

#include <osgSkin/Error>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/LoadProgress>

#include <osg/FrameStamp>
#include <osgAnimation/Channel>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgUtil/UpdateVisitor>

#include <cmath>

namespace bake {
namespace {

using osgSkin::Character;

/// Takes the terminal's place.
struct Silence : osgSkin::LoadProgress {
    void step(const std::string&, const std::string&, std::size_t, std::size_t) override {}
};

/// Puts bones and skins where a clip of the character's own has them after `seconds`.
void poseAt(Character& character, osgAnimation::Animation& clip, double seconds) {
    for (const auto& channel : clip.getChannels()) {
        channel->reset();
        channel->update(seconds, 1.0f, 0);
    }
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(new osg::FrameStamp);
    character.skeleton->accept(visitor);
    for (const osgSkin::AttachedSkin::Skin& attached : character.skin.skins)
        if (auto* update = dynamic_cast<osgSkin::UpdateDeformableSkin*>(
                attached.drawable->getUpdateCallback()))
            update->pose(*attached.drawable, *character.skeleton);
}

Take takeOf(Character& character, osgAnimation::Animation& clip, double rate) {
    const double last = std::floor(clip.getDuration() * rate + 1e-6);
    const osg::ref_ptr<osgAnimation::Animation> held = &clip;
    return {clip.getName(),
            static_cast<std::size_t>(last) + 1,
            1.0 / rate,
            {},
            [&character, held, rate](std::size_t frame) {
                poseAt(character, *held, static_cast<double>(frame) / rate);
            }};
}

} // namespace

std::vector<Take> takesOf(Character& character, double rate) {
    std::vector<Take> takes;
    for (const Character::Motion& motion : character.motions)
        takes.push_back(
            {motion.clip.name, motion.clip.frames, motion.clip.frameTime, motion.report.feetText(),
             [&character, &motion](std::size_t frame) { character.pose(motion, frame); }});
    if (character.clips.empty()) return takes;
    character.manager->link(character.root);
    for (const auto& clip : character.clips) takes.push_back(takeOf(character, *clip, rate));
    return takes;
}

Character loadCharacter(const std::string& file, const std::string& shapes, bool quiet) {
    const osg::ref_ptr<osgDB::Options> options =
        new osgDB::Options(shapes.empty() ? shapes : "shapes=" + shapes);
    const osgSkin::SkinOptions wanted = osgSkin::SkinOptions::parse(options);
    if (quiet) osgSkin::setLoadProgress(*options, new Silence);
    if (osgDB::getLowerCaseFileExtension(file) == "skin") {
        const std::string model = osgDB::getNameLessExtension(file);
        if (osgDB::fileExists(file) || osgDB::getFileExtension(model).empty())
            return Character::load(file, options, wanted);
        return loadCharacter(model, shapes, quiet);
    }
    if (!osgSkin::isReadByAssimp(file))
        throw osgSkin::Error(file + ": expected a .skin file, or a rigged model that Assimp reads");
    return osgSkin::loadRig(file, options, wanted);
}

} // namespace bake
