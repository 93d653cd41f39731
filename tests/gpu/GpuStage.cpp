// SPDX-License-Identifier: MIT
#include "GpuStage.h"

#include <osg/DisplaySettings>
#include <osg/GLExtensions>

#include <stdexcept>

namespace test {
namespace {

struct TakePicture : osg::Camera::DrawCallback {
    explicit TakePicture(osg::Image* to) : image(to) {}
    void operator()(osg::RenderInfo&) const override {
        image->readPixels(0, 0, GpuStage::kSize, GpuStage::kSize, GL_RGB, GL_UNSIGNED_BYTE);
    }
    osg::ref_ptr<osg::Image> image;
};

template <typename Vector>
std::vector<Vector> readBack(const osg::Array& array, unsigned int id) {
    const osg::GLExtensions& gl = *osg::GLExtensions::Get(id, true);
    std::vector<Vector> result(array.getNumElements());
    const osg::GLBufferObject* buffer = array.getBufferObject()->getGLBufferObject(id);
    if (!buffer) throw std::runtime_error("nothing was computed");
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, buffer->getGLObjectID());
    gl.glGetBufferSubData(GL_ARRAY_BUFFER_ARB, buffer->getOffset(array.getBufferIndex()),
                          static_cast<GLsizeiptr>(result.size() * sizeof(Vector)), result.data());
    gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    return result;
}

} // namespace

GpuStage::GpuStage(osg::Node* scene, EglWindow::Profile profile, unsigned int contexts,
                   osgViewer::ViewerBase::ThreadingModel model)
    : _image(new osg::Image), _sphere(scene->getBound()) {
    viewer.setThreadingModel(model);
    viewer.setKeyEventSetsDone(0);
    for (unsigned int i = 0; i < contexts; ++i) {
        _windows.push_back(new EglWindow(kSize, kSize, profile));
        if (!_windows.back()->valid()) throw std::runtime_error("EGL gives no context");
        osg::State& state = *_windows.back()->getState();
        if (profile == EglWindow::Profile::Core) {
            state.setUseModelViewAndProjectionUniforms(true);
            state.setUseVertexAttributeAliasing(true);
            state.resetVertexAttributeAlias();
        }
        const osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(_windows.back());
        camera.setViewport(0, 0, kSize, kSize);
        camera.setClearColor(osg::Vec4(0, 0, 0, 1));
        camera.setDrawBuffer(GL_BACK);
        camera.setReadBuffer(GL_BACK);
        if (i == 0) camera.setFinalDrawCallback(new TakePicture(_image));
        view->setSceneData(scene);
        viewer.addView(view);
    }
    look({0.4, -1.0, 0.3});
    viewer.realize();
}

GpuStage::~GpuStage() {
    viewer.stopThreading();
    for (const osg::ref_ptr<EglWindow>& window : _windows) window->close();
}

void GpuStage::look(const osg::Vec3d& direction, double distance) {
    osg::Vec3d way = direction;
    way.normalize();
    const osg::Vec3d centre = _sphere.center();
    for (unsigned int i = 0; i < viewer.getNumViews(); ++i) {
        osg::Camera& camera = *viewer.getView(i)->getCamera();
        camera.setProjectionMatrixAsPerspective(40.0, 1.0, 0.1, 1000.0);
        camera.setViewMatrixAsLookAt(centre + way * (distance * double(_sphere.radius())), centre,
                                     osg::Vec3d(0, 0, 1));
    }
}

void GpuStage::lookAway() {
    const osg::Vec3d step(10.0 * double(_sphere.radius()), 0, 0);
    for (unsigned int i = 0; i < viewer.getNumViews(); ++i)
        viewer.getView(i)->getCamera()->setViewMatrixAsLookAt(
            _sphere.center() + step, _sphere.center() + step * 2.0, osg::Vec3d(0, 0, 1));
}

void GpuStage::draw(double time) {
    viewer.frame(time);
    viewer.frame(time);
}

osg::ref_ptr<osgUtil::CullVisitor> GpuStage::cullVisitor() {
    EglWindow& window = *_windows.front();
    osg::ref_ptr<osgUtil::CullVisitor> cv = new osgUtil::CullVisitor;
    cv->setStateGraph(new osgUtil::StateGraph);
    cv->setRenderStage(new osgUtil::RenderStage);
    osg::RenderInfo info(window.getState(), nullptr);
    cv->setRenderInfo(info);
    cv->pushViewport(new osg::Viewport(0, 0, kSize, kSize));
    cv->pushProjectionMatrix(new osg::RefMatrix);
    cv->pushModelViewMatrix(new osg::RefMatrix, osg::Transform::ABSOLUTE_RF);
    return cv;
}

GpuStage::Posed GpuStage::computed(const osgSkin::DeformableSkin& skin) {
    const osg::ref_ptr<osgUtil::CullVisitor> cv = cullVisitor();
    const osg::Geometry* drawn =
        skin.getDrawBackend() ? skin.getDrawBackend()->cull(skin, *cv) : nullptr;
    if (!drawn) throw std::runtime_error("the context does not compute skins");
    return onCard(*drawn, skin.getTangentAttribute(), 0);
}

GpuStage::Posed GpuStage::onCard(const osg::Geometry& drawn, int tangentAttribute,
                                 std::size_t context) {
    EglWindow& window = *_windows[context];
    if (!window.makeCurrent()) throw std::runtime_error("the context cannot be made current");
    const unsigned int id = window.getState()->getContextID();
    Posed posed;
    posed.positions = readBack<osg::Vec3>(*drawn.getVertexArray(), id);
    posed.normals = readBack<osg::Vec3>(*drawn.getNormalArray(), id);
    if (tangentAttribute >= 0)
        posed.tangents = readBack<osg::Vec4>(
            *drawn.getVertexAttribArray(static_cast<unsigned int>(tangentAttribute)), id);
    window.releaseContext();
    return posed;
}

} // namespace test
