// SPDX-License-Identifier: MIT
#pragma once

#include "EglWindow.h"

#include <osgSkin/DeformableSkin>

#include <osg/Image>
#include <osgUtil/CullVisitor>
#include <osgViewer/CompositeViewer>

#include <vector>

namespace test {

/// Views of one scene, each in its own context, without a display.
class GpuStage {
public:
    static constexpr int kSize = 400;

    /// Views that frame the whole scene.
    GpuStage(osg::Node* scene, EglWindow::Profile profile = EglWindow::Profile::Compatibility,
             unsigned int contexts = 1,
             osgViewer::ViewerBase::ThreadingModel model = osgViewer::ViewerBase::SingleThreaded);
    ~GpuStage();

    /// Draws two frames at one time: a context knows its capabilities only after its first draw.
    void draw(double time = 0.0);
    void frame(double time) { viewer.frame(time); }

    /// The first view's picture after the last frame.
    const osg::Image& picture() const { return *_image; }

    /// Sets the sphere that the camera frames; initially the scene's bounds.
    void setSphere(const osg::BoundingSphere& sphere) { _sphere = sphere; }
    void look(const osg::Vec3d& direction, double distance = 3.0);

    void lookAway();

    /// A skin's vertices as the first context's shaders computed them.
    struct Posed {
        std::vector<osg::Vec3> positions, normals;
        std::vector<osg::Vec4> tangents;
    };
    Posed computed(const osgSkin::DeformableSkin& skin);
    /// The arrays of a drawn geometry as a context's buffers have them.
    Posed onCard(const osg::Geometry& drawn, int tangentAttribute, std::size_t context);

    /// A visitor for cull traversals in the first context, which sees everything and draws nothing.
    osg::ref_ptr<osgUtil::CullVisitor> cullVisitor();

    osgViewer::CompositeViewer viewer;

private:
    osg::ref_ptr<osg::Image> _image;
    std::vector<osg::ref_ptr<EglWindow>> _windows;
    osg::BoundingSphere _sphere;
};

} // namespace test
