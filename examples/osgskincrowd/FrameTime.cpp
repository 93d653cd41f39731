// SPDX-License-Identifier: MIT
#include "FrameTime.h"

#include <osg/Timer>
#include <osgText/Text>

#include <cstdio>

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
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setDataVariance(osg::Object::DYNAMIC);
    text->setCharacterSize(20.0f);
    text->setPosition(osg::Vec3(12.0f, 12.0f, 0.0f));
    text->setUpdateCallback(new ShowTimes(crowd, threads));
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
