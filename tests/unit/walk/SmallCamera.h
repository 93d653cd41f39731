// SPDX-License-Identifier: MIT
// Culls a scene, and tells what would be drawn.
#pragma once

#include <osg/Camera>
#include <osg/Drawable>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <set>

namespace walking {

/// The drawables that a camera of 1,000 lines sees of a scene, from a distance along Y.
class Camera {
public:
    explicit Camera(double distance, osg::Camera* camera = nullptr) {
        _cull->setStateGraph(_graph);
        _cull->setRenderStage(_stage);
        _stage->setCamera(camera);
        _view = osg::Matrix::lookAt(osg::Vec3d(0, -distance, 1), osg::Vec3d(0, 0, 1),
                                    osg::Vec3d(0, 0, 1));
    }
    std::set<const osg::Drawable*> see(osg::Node& scene) {
        _graph->clean();
        _stage->reset();
        _cull->reset();
        _cull->pushViewport(new osg::Viewport(0, 0, 1000, 1000));
        _cull->pushProjectionMatrix(new osg::RefMatrix(osg::Matrix::perspective(60, 1, 0.1, 1000)));
        _cull->pushModelViewMatrix(new osg::RefMatrix(_view), osg::Transform::ABSOLUTE_RF);
        scene.accept(*_cull);
        _cull->popModelViewMatrix();
        _cull->popProjectionMatrix();
        _cull->popViewport();
        std::set<const osg::Drawable*> seen;
        collect(*_graph, seen);
        return seen;
    }

private:
    static void collect(const osgUtil::StateGraph& graph, std::set<const osg::Drawable*>& seen) {
        for (const auto& leaf : graph._leaves) seen.insert(leaf->getDrawable());
        for (const auto& child : graph._children) collect(*child.second, seen);
    }

    osg::ref_ptr<osgUtil::CullVisitor> _cull = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> _graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> _stage = new osgUtil::RenderStage;
    osg::Matrixd _view;
};

} // namespace walking
