// SPDX-License-Identifier: MIT
#include "FrameBench.h"

#include <osgSkin/DeformableSkin>

#include <osg/Timer>
#include <osgText/Text>
#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace {

class ShowTimes : public osg::DrawableUpdateCallback {
public:
    ShowTimes(const Crowd& crowd, unsigned int threads) : _crowd(crowd), _threads(threads) {}

    void update(osg::NodeVisitor*, osg::Drawable* drawable) override {
        ++_frames;
        _pose += _crowd.getPoseTime();
        _deform += _crowd.getDeformTime();
        const osg::Timer_t now = osg::Timer::instance()->tick();
        const double passed = osg::Timer::instance()->delta_m(_since, now);
        if (passed < 500.0) return;
        char line[160];
        std::snprintf(line, sizeof line,
                      "%.1f ms a frame: poses %.1f, %zu skin vertices %.1f, on %u threads",
                      passed / _frames, _pose / _frames, _crowd.getVertexCount(), _deform / _frames,
                      _threads);
        static_cast<osgText::Text*>(drawable)->setText(line);
        _since = now;
        _frames = 0;
        _pose = _deform = 0.0;
    }

private:
    const Crowd& _crowd;
    unsigned int _threads;
    osg::Timer_t _since = osg::Timer::instance()->tick();
    unsigned int _frames = 0;
    double _pose = 0.0, _deform = 0.0;
};

} // namespace

osg::ref_ptr<osg::Camera> makeFrameTime(const Crowd& crowd, unsigned int threads) {
    return makeTextLine(new ShowTimes(crowd, threads));
}

osg::ref_ptr<osg::Camera> makeTextLine(osg::DrawableUpdateCallback* update) {
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setDataVariance(osg::Object::DYNAMIC);
    text->setCharacterSize(20.0f);
    text->setPosition(osg::Vec3(12.0f, 12.0f, 0.0f));
    text->setUpdateCallback(update);
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setProjectionMatrixAsOrtho2D(0.0, 1000.0, 0.0, 800.0);
    camera->setViewMatrix(osg::Matrix::identity());
    camera->setClearMask(GL_DEPTH_BUFFER_BIT);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setAllowEventFocus(false);
    camera->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    camera->addChild(text);
    return camera;
}

namespace {

class CountDeformed : public osg::NodeVisitor {
public:
    explicit CountDeformed(osg::Node& scene) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {
        scene.accept(*this);
    }
    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable))
            count += skin->getDeformCount();
    }
    std::size_t count = 0;
};

} // namespace

FrameCull::FrameCull(const osg::BoundingSphere& bound)
    : _viewport(new osg::Viewport(0, 0, 1000, 800)) {
    const double r = 1.1 * static_cast<double>(bound.radius());
    const osg::Vec3d centre = bound.center();
    _view = new osg::RefMatrix(
        osg::Matrix::lookAt(centre + osg::Vec3d(0.0, -r, r), centre, osg::Vec3d(0.0, 0.0, 1.0)));
    _projection = new osg::RefMatrix(osg::Matrix::ortho(-r, r, -r, r, 0.0, 4.0 * r));
}

FrameCull::FrameCull(const example::View& view)
    : _viewport(new osg::Viewport(0, 0, 1920, 1080)),
      _view(new osg::RefMatrix(osg::Matrix::lookAt(view.eye, view.centre, view.up))),
      _projection(
          new osg::RefMatrix(osg::Matrix::perspective(view.fieldOfView, 16.0 / 9.0, 0.1, 2000.0))) {
}

void FrameCull::run(osg::Node& scene, osg::FrameStamp* stamp) {
    _graph->clean();
    _stage->reset();
    _visitor->reset();
    _visitor->setFrameStamp(stamp);
    _visitor->setTraversalNumber(stamp->getFrameNumber());
    _visitor->setStateGraph(_graph);
    _visitor->setRenderStage(_stage);
    _visitor->pushViewport(_viewport);
    _visitor->pushProjectionMatrix(_projection);
    _visitor->pushModelViewMatrix(_view, osg::Transform::ABSOLUTE_RF);
    scene.accept(*_visitor);
    _visitor->popModelViewMatrix();
    _visitor->popProjectionMatrix();
    _visitor->popViewport();
}

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void benchFrames(const Crowd& crowd, osg::Node* scene, unsigned int frames, unsigned int threads) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    const osg::ref_ptr<osgUtil::UpdateVisitor> update = new osgUtil::UpdateVisitor;
    FrameCull cull(scene->getBound());
    std::vector<double> whole, pose, deform, culled;
    std::size_t before = 0;
    constexpr unsigned int kFirst = 3; // warm-up frames, which still allocate
    for (unsigned int i = 0; i < frames + kFirst; ++i) {
        if (i == kFirst) before = CountDeformed(*scene).count;
        stamp->setFrameNumber(i + 1);
        stamp->setSimulationTime(i / 60.0);
        update->reset();
        update->setFrameStamp(stamp);
        update->setTraversalNumber(i + 1);
        const osg::Timer_t start = osg::Timer::instance()->tick();
        scene->accept(*update);
        scene->getBound();
        const osg::Timer_t updated = osg::Timer::instance()->tick();
        cull.run(*scene, stamp);
        const osg::Timer_t end = osg::Timer::instance()->tick();
        if (i < kFirst) continue;
        whole.push_back(osg::Timer::instance()->delta_m(start, end));
        pose.push_back(crowd.getPoseTime());
        deform.push_back(crowd.getDeformTime());
        culled.push_back(osg::Timer::instance()->delta_m(updated, end));
    }
    const std::size_t deformed = CountDeformed(*scene).count - before;
    std::printf("%u frames on %u threads, medians: %.2f ms, of which poses and bounds %.2f, "
                "deformation %.2f, cull traversal %.2f; %.0f skins deformed a frame\n",
                frames, threads, medianOf(whole), medianOf(pose), medianOf(deform),
                medianOf(culled), static_cast<double>(deformed) / frames);
}
