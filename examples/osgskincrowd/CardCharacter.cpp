// SPDX-License-Identifier: MIT
#include "CardCharacter.h"

#include <osgSkin/RigidPart>
#include <osgSkinImport/ReadScene>
#include <osgSkinRig/ClipCharacter>

#include <osg/NodeVisitor>
#include <osgDB/Registry>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace {

constexpr double kSamplesASecond = 60.0;

/// What a crowd draws of a scene, with the path to it.
class FindDrawn : public osg::NodeVisitor {
public:
    FindDrawn() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Geometry&) override {
        const osg::NodePath& path = getNodePath();
        if (std::any_of(path.begin(), path.end(), [](const osg::Node* node) {
                return dynamic_cast<const osgSkin::RigidPart*>(node) != nullptr;
            }))
            rigids.push_back(path);
    }
    void apply(osg::Drawable& drawable) override {
        if (dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) skins.push_back(getNodePath());
    }

    std::vector<osg::NodePath> skins, rigids;
};

template <typename Node>
Node* nearest(const osg::NodePath& path) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* found = dynamic_cast<Node*>(*node)) return found;
    return nullptr;
}

} // namespace

osg::ref_ptr<osgSkin::CrowdCharacter> readCardCharacter(const std::string& file, double& seconds) {
    const osg::ref_ptr<osg::Node> scene =
        osgSkin::readScene(file, osgDB::Registry::instance()->getOptions());
    FindDrawn found;
    scene->accept(found);
    if (found.skins.empty())
        throw std::runtime_error(file + ": expected a character with a deformable skin");
    osg::ref_ptr<osgSkin::CrowdCharacter> character = new osgSkin::CrowdCharacter;
    std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skins;
    for (const osg::NodePath& path : found.skins) {
        skins.emplace_back(static_cast<osgSkin::DeformableSkin*>(path.back()));
        character->addSkin(*skins.back(), osg::computeLocalToWorld(path));
    }
    for (const osg::NodePath& path : found.rigids)
        if (const auto* bone = nearest<osgAnimation::Bone>(path)) {
            const osg::Node& above = *path[path.size() - 2];
            auto& geometry = static_cast<osg::Geometry&>(*path.back());
            osg::StateSet* state = geometry.getStateSet();
            if (!state) state = const_cast<osg::StateSet*>(above.getStateSet());
            character->addRigid(geometry, state, 0, bone->getName());
        }

    // The scene's own skins follow a player in place of their bones.
    const auto source = osgSkin::ClipCharacter::create(*scene);
    osg::ref_ptr<const osgSkin::SampledClip> clip;
    if (!source->animations().empty())
        clip = source->sample(*source->animations().front(), kSamplesASecond);
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    for (const auto& skin : skins) player->addSkin(skin);
    osgSkin::CrowdCharacter::Samples samples(skins.size());
    const std::size_t count = clip ? clip->sampleCount() : 1;
    for (std::size_t i = 0; i < count; ++i) {
        if (clip) player->setTrack(0, {clip, double(i) * clip->step()});
        if (clip && !player->pose()) throw std::runtime_error(file + ": its clip poses no skin");
        for (std::size_t s = 0; s < skins.size(); ++s)
            samples[s].push_back(skins[s]->getPose().skinning());
    }
    seconds = clip ? clip->duration() : 0.0;
    character->addClip(samples, clip ? 1.0 / clip->step() : kSamplesASecond, true);
    // Of the picture's height a figure has 1/4, 1/10 and 1/25 there.
    character->addLevel(0.4, 0.25);
    character->addLevel(0.15, 0.1);
    character->addLevel(0.05, 0.04);
    return character;
}
