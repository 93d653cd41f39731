// SPDX-License-Identifier: MIT
#include "CrowdCharacter.h"

#include "ProgressLine.h"

#include <osgSkinCharacter/ProgressOption>
#include <osgSkinImport/ReadScene>

#include <osg/NodeVisitor>
#include <osgDB/Registry>

#include <stdexcept>

namespace {

class CountVertices : public osg::NodeVisitor {
public:
    CountVertices() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable))
            if (skin->getModel()) vertices += skin->getModel()->vertexCount();
    }
    std::size_t vertices = 0;
};

/// By osgDB, which also reads characters that were saved.
osg::ref_ptr<osg::Node> readScene(const std::string& file) {
    example::ProgressLine line(file);
    const osgDB::Options* shared = osgDB::Registry::instance()->getOptions();
    const osg::ref_ptr<osgDB::Options> options =
        shared ? shared->cloneOptions() : new osgDB::Options;
    osgSkin::setProgress(*options, line.progress());
    return osgSkin::readScene(file, options);
}

} // namespace

CrowdCharacter::CrowdCharacter(const std::string& file) {
    const osg::ref_ptr<osg::Node> scene = readScene(file);
    CountVertices count;
    scene->accept(count);
    if (count.vertices == 0)
        throw std::runtime_error(file + " has no deformable skin; expected a character");
    character = osgSkin::ClipCharacter::create(*scene);
    // One without a clip stands as it does.
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    if (!character->animations().empty()) animation = character->animations().front();
    clip = character->sample(*animation);
    character->bake(clip);
    vertices = count.vertices;
}
