// SPDX-License-Identifier: MIT
#ifndef BENCH_CULLFRAME_H
#define BENCH_CULLFRAME_H

#include <osg/Group>
#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

namespace bench {

/// Frames of a scene, 60 a second, with everything in view unless a camera is given; nothing is
/// drawn.
class CullFrame {
public:
    explicit CullFrame(osg::Group& scene, int width = 1000, int height = 800)
        : _scene(&scene), _viewport(new osg::Viewport(0, 0, width, height)) {
        _update->setFrameStamp(_stamp);
        _cull->setFrameStamp(_stamp);
    }

    /// The first frames still allocate.
    void warmUp() {
        for (int i = 0; i < 3; ++i) {
            update();
            cull();
        }
    }

    /// The next frame's update traversal.
    void update() {
        _stamp->setFrameNumber(++_frame);
        _stamp->setSimulationTime(_frame / 60.0);
        _update->setTraversalNumber(_frame);
        _scene->accept(*_update);
    }

    /// Its bounds and cull traversal.
    void cull() {
        const osg::BoundingSphere bound = _scene->getBound();
        const double r = 1.2 * static_cast<double>(bound.radius());
        const osg::Vec3d centre = bound.center();
        cull(osg::Matrix::ortho(-r, r, -r, r, 0.0, 4 * r),
             osg::Matrix::lookAt(centre + osg::Vec3d(0.0, 0.0, 2.0 * r), centre,
                                 osg::Vec3d(0.0, 1.0, 0.0)));
    }
    void cull(const osg::Matrixd& projection, const osg::Matrixd& view) {
        _scene->getBound();
        _graph->clean();
        _stage->reset();
        _cull->reset();
        _cull->setTraversalNumber(_frame);
        _cull->setStateGraph(_graph);
        _cull->setRenderStage(_stage);
        _cull->pushViewport(_viewport);
        _cull->pushProjectionMatrix(new osg::RefMatrix(projection));
        _cull->pushModelViewMatrix(new osg::RefMatrix(view), osg::Transform::ABSOLUTE_RF);
        _scene->accept(*_cull);
        _cull->popModelViewMatrix();
        _cull->popProjectionMatrix();
        _cull->popViewport();
    }

private:
    osg::ref_ptr<osg::Group> _scene;
    osg::ref_ptr<osg::FrameStamp> _stamp = new osg::FrameStamp;
    osg::ref_ptr<osgUtil::UpdateVisitor> _update = new osgUtil::UpdateVisitor;
    osg::ref_ptr<osgUtil::CullVisitor> _cull = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> _graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> _stage = new osgUtil::RenderStage;
    osg::ref_ptr<osg::Viewport> _viewport;
    unsigned int _frame = 0;
};

} // namespace bench

#endif
