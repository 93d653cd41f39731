// SPDX-License-Identifier: MIT
#include "CardCharacter.h"

#include <osgSkin/BoneReader>
#include <osgSkin/RigidPart>
#include <osgSkinImport/ReadScene>

#include <osg/NodeVisitor>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/Registry>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace {

constexpr double kSamplesASecond = 60.0;

/// What a crowd draws of a scene, with the path to it.
class FindDrawn : public osg::NodeVisitor {
public:
    FindDrawn() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override {
        for (osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            if (auto* found = dynamic_cast<osgAnimation::BasicAnimationManager*>(c))
                manager = found;
        traverse(node);
    }
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

    osgAnimation::BasicAnimationManager* manager = nullptr;
    std::vector<osg::NodePath> skins, rigids;
};

template <typename Node>
Node* nearest(const osg::NodePath& path) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* found = dynamic_cast<Node*>(*node)) return found;
    return nullptr;
}

void runTo(osg::Node& scene, double time, unsigned int frame) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    stamp->setFrameNumber(frame);
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    update.setTraversalNumber(frame);
    scene.accept(update);
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
    std::vector<osgSkin::BoneReader> readers;
    for (const osg::NodePath& path : found.skins) {
        auto* skeleton = nearest<osgAnimation::Skeleton>(path);
        auto& skin = static_cast<osgSkin::DeformableSkin&>(*path.back());
        if (!skeleton) throw std::runtime_error(file + ": a skin stands under no skeleton");
        character->addSkin(skin, osg::computeLocalToWorld(path));
        readers.emplace_back(skin.getModel()->joints(), *skeleton);
    }
    for (const osg::NodePath& path : found.rigids)
        if (const auto* bone = nearest<osgAnimation::Bone>(path)) {
            const osg::Node& above = *path[path.size() - 2];
            auto& geometry = static_cast<osg::Geometry&>(*path.back());
            osg::StateSet* state = geometry.getStateSet();
            if (!state) state = const_cast<osg::StateSet*>(above.getStateSet());
            character->addRigid(geometry, state, 0, bone->getName());
        }

    seconds = 0.0;
    if (found.manager && !found.manager->getAnimationList().empty())
        seconds = found.manager->getAnimationList().front()->getDuration();
    const std::size_t count =
        std::max<std::size_t>(1, std::size_t(std::lround(seconds * kSamplesASecond)));
    osgSkin::CrowdCharacter::Samples samples(readers.size());
    for (std::size_t i = 0; i < count; ++i) {
        runTo(*scene, double(i) / kSamplesASecond, static_cast<unsigned int>(i + 1));
        for (std::size_t s = 0; s < readers.size(); ++s) samples[s].push_back(readers[s].read());
    }
    character->addClip(samples, kSamplesASecond, true);
    // Of the picture's height a figure has 1/4, 1/10 and 1/25 there.
    character->addLevel(0.4, 0.25);
    character->addLevel(0.15, 0.1);
    character->addLevel(0.05, 0.04);
    return character;
}
