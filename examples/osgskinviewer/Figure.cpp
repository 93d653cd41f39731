// SPDX-License-Identifier: MIT
#include "Figure.h"

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/Transform>
#include <osg/TriangleFunctor>
#include <osgAnimation/Bone>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <utility>
#include <vector>

namespace viewer {

namespace {

/// Finds the skins and the animation manager of a scene.
class Finder : public osg::NodeVisitor {
public:
    explicit Finder(Figure& figure) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _figure(figure) {}

    void apply(osg::Node& node) override {
        auto* manager =
            dynamic_cast<osgAnimation::BasicAnimationManager*>(node.getUpdateCallback());
        if (manager != nullptr && !_figure.manager) {
            _figure.manager = manager;
            _figure.managed = &node;
        }
        traverse(node);
    }

    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable))
            _figure.skins.emplace_back(skin);
    }

private:
    Figure& _figure;
};

} // namespace

Figure::Figure(const std::string& file, const std::string& weights,
               const osgSkin::LoadOptions& options) {
    osgSkin::Character character = figures::load(file, options);
    root = character.root;
    if (character.hasBody()) body = std::make_unique<figures::Body>(std::move(character), weights);
    Finder finder(*this);
    root->accept(finder);
}

namespace {

constexpr unsigned int kSamples = 40;

struct Corners {
    osg::Matrix toRoot;
    osg::BoundingBoxd box;

    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c) {
        for (const osg::Vec3* point : {&a, &b, &c}) box.expandBy(osg::Vec3d(*point) * toRoot);
    }
};

/// The box of the triangles of skins and of objects attached to bones. Their bounds are too large.
class FigureBox : public osg::NodeVisitor {
public:
    FigureBox() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}

    void apply(osg::Drawable& drawable) override {
        const osg::NodePath& path = getNodePath();
        if (dynamic_cast<osgSkin::DeformableSkin*>(&drawable) == nullptr &&
            std::none_of(path.begin(), path.end(), [](const osg::Node* node) {
                return dynamic_cast<const osgAnimation::Bone*>(node) != nullptr;
            }))
            return;
        triangles.toRoot = osg::computeLocalToWorld(path);
        drawable.accept(triangles);
    }

    osg::TriangleFunctor<Corners> triangles;
};

osg::BoundingBoxd boxAt(osg::Group& root, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    root.accept(update);
    FigureBox figure;
    root.accept(figure);
    if (!figure.triangles.box.valid()) figure.triangles.box.expandBy(root.getBound()); // hidden
    return figure.triangles.box;
}

} // namespace

PlayedExtent playedExtent(const Figure& figure, std::size_t motion) {
    if (figure.motionCount() == 0) {
        const osg::BoundingBoxd box = boxAt(*figure.root, 0.0);
        return {box, box.zMin()};
    }
    // Plays with a separate manager, to keep the time of the figure's own.
    const osg::ref_ptr<osg::Callback> playing = figure.managed->getUpdateCallback();
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    osgAnimation::Animation& clip = figure.motion(motion);
    manager->registerAnimation(&clip);
    manager->playAnimation(&clip);
    figure.managed->setUpdateCallback(manager);
    PlayedExtent result;
    std::vector<double> heights;
    for (unsigned int k = 0; k < kSamples; ++k) {
        const osg::BoundingBoxd box = boxAt(*figure.root, clip.getDuration() * k / kSamples);
        result.box.expandBy(box);
        heights.push_back(box.zMin());
    }
    figure.managed->setUpdateCallback(playing);
    const auto tenth = heights.begin() + kSamples / 10;
    std::nth_element(heights.begin(), tenth, heights.end());
    result.floor = *tenth;
    return result;
}

} // namespace viewer
