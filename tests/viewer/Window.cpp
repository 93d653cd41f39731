// SPDX-License-Identifier: MIT
#include "Window.h"

#include <osg/GraphicsContext>

#include <cstdlib>
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

int channel(const osg::Image& image, unsigned int pixel, unsigned int i) {
    return image.data()[pixel * 3 + i];
}

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

unsigned int differentPixels(const osg::Image& a, const osg::Image& b) {
    unsigned int different = 0;
    for (unsigned int pixel = 0; pixel < kSize * kSize; ++pixel) {
        int most = 0;
        for (unsigned int i = 0; i < 3; ++i)
            most = std::max(most, std::abs(channel(a, pixel, i) - channel(b, pixel, i)));
        different += most > 24 ? 1 : 0;
    }
    return different;
}

unsigned int drawnPixels(const osg::Image& image) {
    unsigned int drawn = 0;
    for (unsigned int pixel = 0; pixel < kSize * kSize; ++pixel)
        drawn +=
            channel(image, pixel, 0) + channel(image, pixel, 1) + channel(image, pixel, 2) > 24;
    return drawn;
}

} // namespace test
