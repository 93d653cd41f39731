// SPDX-License-Identifier: MIT
#include "SampledCharacter.h"

#include "ProgressLine.h"

#include <osgSkin/BoneReader>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/ProgressOption>

#include <osg/NodeVisitor>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/ReadFile>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

/// Everything below a node that the crowd is made of, each with the path to it.
class FindParts : public osg::NodeVisitor {
public:
    FindParts() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override {
        for (osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            if (auto* found = dynamic_cast<osgAnimation::BasicAnimationManager*>(c))
                manager = found;
        if (dynamic_cast<osgSkin::RigidPart*>(&node))
            rigids.push_back(getNodePath());
        else
            traverse(node);
    }
    void apply(osg::Drawable& drawable) override {
        if (dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) skins.push_back(getNodePath());
    }

    osgAnimation::BasicAnimationManager* manager = nullptr;
    std::vector<osg::NodePath> skins, rigids;
};

osgAnimation::Skeleton* skeletonIn(const osg::NodePath& path) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(*node)) return skeleton;
    return nullptr;
}

void updateTo(osg::Node& scene, double time, unsigned int frame) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    stamp->setFrameNumber(frame);
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    update.setTraversalNumber(frame);
    scene.accept(update);
}

/// By osgDB, which also reads characters that were saved.
osg::ref_ptr<osg::Node> readScene(const std::string& file) {
    example::ProgressLine line(file);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    osgSkin::setProgress(*options, line.progress());
    return osgDB::readRefNodeFile(file, options);
}

} // namespace

SampledCharacter::SampledCharacter(const std::string& file) {
    const osg::ref_ptr<osg::Node> scene = readScene(file);
    if (!scene) throw std::runtime_error(file + " cannot be read");
    FindParts found;
    scene->accept(found);
    if (found.skins.empty())
        throw std::runtime_error(file + " has no deformable skin; expected a character");

    double seconds = 0.0;
    if (found.manager && !found.manager->getAnimationList().empty())
        seconds = found.manager->getAnimationList().front()->getDuration();
    sampleCount = std::max<std::size_t>(1, std::size_t(std::lround(seconds * kSamplesPerSecond)));

    std::vector<osgSkin::BoneReader> readers;
    for (const osg::NodePath& path : found.skins) {
        const osg::ref_ptr<osgSkin::DeformableSkin> skin =
            static_cast<osgSkin::DeformableSkin*>(path.back());
        osgAnimation::Skeleton* skeleton = skeletonIn(path);
        if (!skeleton || !skin->getModel())
            throw std::runtime_error(file + ": a skin stands under no skeleton");
        readers.emplace_back(skin->getModel()->joints(), *skeleton);
        skins.push_back({skin, osg::computeLocalToWorld(path), {}});
    }
    for (const osg::NodePath& path : found.rigids) {
        const osg::Group& part = *path.back()->asGroup();
        rigids.emplace_back();
        for (unsigned int i = 0; i < part.getNumChildren(); ++i)
            rigids.back().parts.emplace_back(const_cast<osg::Node*>(part.getChild(i)));
    }

    for (std::size_t sample = 0; sample < sampleCount; ++sample) {
        updateTo(*scene, static_cast<double>(sample) / kSamplesPerSecond,
                 static_cast<unsigned int>(sample + 1));
        for (std::size_t i = 0; i < skins.size(); ++i)
            skins[i].samples.push_back(readers[i].read());
        for (std::size_t i = 0; i < rigids.size(); ++i)
            rigids[i].samples.push_back(osg::computeLocalToWorld(found.rigids[i]));
        for (const Skin& skin : skins) {
            const osg::BoundingBox& local = skin.skin->getBoundingBox();
            for (unsigned int corner = 0; corner < 8; ++corner)
                box.expandBy(local.corner(corner) * skin.toCharacter);
        }
    }
}
