// SPDX-License-Identifier: MIT
#pragma once

#include "EglWindow.h"

#include <osgSkin/DeformableSkin>

#include <osg/Image>
#include <osgUtil/CullVisitor>
#include <osgViewer/CompositeViewer>

#include <vector>

namespace test {

/// Views of one scene, each in a context of its own, without a display.
class GpuStage {
public:
    static constexpr int kSize = 400;

    /// \param scene seen whole
    GpuStage(osg::Node* scene, EglWindow::Profile profile = EglWindow::Profile::Compatibility,
             unsigned int contexts = 1,
             osgViewer::ViewerBase::ThreadingModel model = osgViewer::ViewerBase::SingleThreaded);
    ~GpuStage();

    /// Two frames of one time: before its first draw a context does not know what it can do.
    void draw(double time = 0.0);
    void frame(double time) { viewer.frame(time); }

    /// The first view's picture, as the last frame has left it.
    const osg::Image& picture() const { return *_image; }

    /// What is looked at; the scene's bounds at first.
    void setSphere(const osg::BoundingSphere& sphere) { _sphere = sphere; }
    void look(const osg::Vec3d& direction, double distance = 3.0);

    void lookAway();

    /// What the first context's shaders made of a skin.
    struct Posed {
        std::vector<osg::Vec3> positions, normals;
        std::vector<osg::Vec4> tangents;
    };
    Posed computed(const osgSkin::DeformableSkin& skin);

    /// A cull traversal's of the first context, that sees everything and draws nothing.
    osg::ref_ptr<osgUtil::CullVisitor> cullVisitor();

    osgViewer::CompositeViewer viewer;

private:
    osg::ref_ptr<osg::Image> _image;
    std::vector<osg::ref_ptr<EglWindow>> _windows;
    osg::BoundingSphere _sphere;
};

} // namespace test
