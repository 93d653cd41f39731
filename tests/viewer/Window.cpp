// SPDX-License-Identifier: MIT
#include "Window.h"

#include <osg/GraphicsContext>

#include <stdexcept>

namespace test {
namespace {

constexpr int kSize = 300;

struct ReadBack : osg::Camera::DrawCallback {
    explicit ReadBack(osg::Image* to) : image(to) {}
    void operator()(osg::RenderInfo&) const override {
        image->readPixels(0, 0, kSize, kSize, GL_RGB, GL_UNSIGNED_BYTE);
    }
    osg::ref_ptr<osg::Image> image;
};

} // namespace

Windows::Windows(osg::Node* scene, const osg::Vec3d& eye, const osg::Vec3d& centre,
                 unsigned int count, osgViewer::ViewerBase::ThreadingModel model) {
    viewer.setThreadingModel(model);
    for (unsigned int i = 0; i < count; ++i) {
        const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->readDISPLAY();
        traits->setUndefinedScreenDetailsToDefaultScreen();
        traits->x = static_cast<int>(i) * kSize;
        traits->width = kSize;
        traits->height = kSize;
        traits->windowDecoration = false;
        traits->doubleBuffer = true;
        const osg::ref_ptr<osg::GraphicsContext> context =
            osg::GraphicsContext::createGraphicsContext(traits);
        if (!context) throw std::runtime_error("no window can be opened; is DISPLAY set?");
        const osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(context);
        camera.setViewport(0, 0, kSize, kSize);
        camera.setClearColor(osg::Vec4(0, 0, 0, 1));
        camera.setProjectionMatrixAsPerspective(40.0, 1.0, 0.1, 1000.0);
        camera.setViewMatrixAsLookAt(eye, centre, osg::Vec3d(0, 1, 0));
        _images.push_back(new osg::Image);
        camera.setFinalDrawCallback(new ReadBack(_images.back()));
        view->setSceneData(scene);
        viewer.addView(view);
    }
    viewer.realize();
}

std::vector<osg::ref_ptr<osg::Image>> Windows::pictures() {
    viewer.stopThreading();
    std::vector<osg::ref_ptr<osg::Image>> copies;
    for (const osg::ref_ptr<osg::Image>& image : _images)
        copies.push_back(new osg::Image(*image, osg::CopyOp::DEEP_COPY_ALL));
    return copies;
}

} // namespace test
