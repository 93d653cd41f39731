// SPDX-License-Identifier: MIT
#include "Crowd.h"

#include "ProgressLine.h"
#include "WindowOptions.h"

#include <osgSkin/ParallelDeformCallback>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>

#include <osg/MatrixTransform>
#include <osg/NodeCallback>
#include <osg/NodeVisitor>
#include <osg/Timer>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>

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

/// Whether a file's characters are bound already.
bool isSaved(const std::string& file) {
    const std::string extension = osgDB::getLowerCaseFileExtension(file);
    return extension == "osgb" || extension == "osgt" || extension == "osgx";
}

} // namespace

osg::ref_ptr<osg::Node> loadScene(const std::string& file) {
    osgSkin::LoadOptions options =
        osgSkin::toLoadOptions(osgDB::Registry::instance()->getOptions());
    if (!example::hasOsgOptionString() && !isSaved(file)) {
        options.shapes = osgSkin::BindOptions::Shapes::None;
        options.surfaceNormals = false;
    }
    example::ProgressLine line(file);
    options.progress = line.progress();
    return osgSkin::loadCharacter(file, options).root;
}

CrowdCharacter::CrowdCharacter(const std::string& file) {
    const osg::ref_ptr<osg::Node> scene = loadScene(file);
    CountVertices count;
    scene->accept(count);
    character = osgSkin::ClipCharacter::create(*scene);
    // A character without a clip keeps its pose.
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    if (!character->animations().empty()) animation = character->animations().front();
    clip = character->sample(*animation);
    character->bake(clip);
    vertices = count.vertices;
}

namespace {

/// Updates the crowd. Stores a reference, because the crowd owns the scene that owns this.
class UpdateCrowd : public osg::NodeCallback {
public:
    explicit UpdateCrowd(Crowd& crowd) : _crowd(crowd) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const bool timed = nv && nv->getFrameStamp();
        _crowd.update(timed ? nv->getFrameStamp()->getSimulationTime() : 0.0,
                      [&] { traverse(node, nv); });
    }

private:
    Crowd& _crowd;
};

} // namespace

Crowd::Crowd(const std::vector<CrowdCharacter>& characters, std::size_t count,
             osgSkin::DeformPool* pool)
    : _scene(new osg::Group), _pool(pool) {
    float width = 0.0f;
    for (const CrowdCharacter& c : characters) {
        const osg::BoundingBox& box = c.character->bakedBounds();
        width = std::max({width, box.xMax() - box.xMin(), box.yMax() - box.yMin()});
    }
    width *= 0.7f; // their arms may overlap
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    _radius = 0.5f * width * static_cast<float>(side);
    std::size_t phase = 0; // in samples
    for (std::size_t i = 0; i < count; ++i) {
        // Every other row is shifted by half a position, and neighbours differ in phase.
        const std::size_t line = i / side;
        const double row = static_cast<double>(line);
        const double column = static_cast<double>(i % side) + (line % 2 == 0 ? 0.0 : 0.5);
        const CrowdCharacter& source = characters[i % characters.size()];
        const osgSkin::ClipCharacter::Instance copy = source.character->makeInstance(false);
        copy.player->setInterpolated(false);
        copy.player->setLayer(0, {source.clip, static_cast<double>(phase) * source.clip->step()});
        copy.node->setMatrix(osg::Matrix::translate(
            static_cast<double>(width) * (column - 0.5 * static_cast<double>(side)),
            static_cast<double>(width) * (row - 0.5 * static_cast<double>(side)), 0.0));
        _scene->addChild(copy.node);
        _players.push_back(copy.player);
        _vertices += source.vertices;
        phase += 37;
    }
    _scene->setUpdateCallback(new UpdateCrowd(*this));
    // Nested in our callback, so it runs after it.
    _scene->addUpdateCallback(new osgSkin::ParallelDeformCallback(pool));
}

Crowd::~Crowd() {
    _scene->setUpdateCallback(nullptr);
}

void Crowd::update(double time, const std::function<void()>& deform) {
    const double passed = _time < 0.0 ? 0.0 : time - _time;
    const osg::Timer_t start = osg::Timer::instance()->tick();
    // Marks the members' common ancestors here, so that each thread only changes its own members.
    _scene->dirtyBound();
    _pool->forEach(_players.size(), [&](std::size_t i) {
        _players[i]->advance(passed);
        _players[i]->pose();
        _scene->getChild(static_cast<unsigned int>(i))->getBound();
    });
    const osg::Timer_t posed = osg::Timer::instance()->tick();
    deform();
    const osg::Timer_t end = osg::Timer::instance()->tick();
    if (time != _time) _poseTime = _deformTime = 0.0;
    _time = time;
    _poseTime += osg::Timer::instance()->delta_m(start, posed);
    _deformTime += osg::Timer::instance()->delta_m(posed, end);
}
