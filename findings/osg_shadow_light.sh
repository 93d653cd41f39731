#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5, osgShadow::ShadowMap: the light that setLight() chose is not saved. In a scene
# with two lights a saved and read shadow is thrown by another one. One expects the same picture.
# Needs g++, OpenSceneGraph's headers and Xvfb; pixels are those of Mesa's llvmpipe.
. "$(dirname "$0")/common.sh"
debian_package libopenscenegraph-dev 3.6.5+dfsg1-8+b2
cat >shadow.cpp <<'END'
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowedScene>
#include <osgViewer/Viewer>
#include <iostream>

struct Grab : osg::Camera::DrawCallback {
    osg::ref_ptr<osg::Image> image = new osg::Image;
    void operator()(osg::RenderInfo&) const override {
        image->readPixels(0, 0, 200, 200, GL_RGB, GL_UNSIGNED_BYTE);
    }
};

/// The middle of the pixels that are in shadow, across the picture, from -1 to 1.
double shadowAt(osg::Node* scene) {
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    viewer.setUpViewInWindow(0, 0, 200, 200);
    viewer.setSceneData(scene);
    viewer.realize();
    viewer.getCamera()->setClearColor(osg::Vec4(0, 0, 1, 1));
    viewer.getCamera()->setViewMatrixAsLookAt(osg::Vec3d(0, -0.1, 20), osg::Vec3d(), osg::Y_AXIS);
    const osg::ref_ptr<Grab> grab = new Grab;
    viewer.getCamera()->setFinalDrawCallback(grab);
    for (int i = 0; i < 4; ++i) viewer.frame();
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) {
            const unsigned char* pixel = grab->image->data(x, y);
            if (pixel[2] < 120) sum += x, ++count;
        }
    return count > 0.0 ? sum / count / 100.0 - 1.0 : 0.0;
}

int main() {
    const osg::ref_ptr<osgShadow::ShadowMap> map = new osgShadow::ShadowMap;
    const osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene(map);
    scene->setReceivesShadowTraversalMask(1);
    scene->setCastsShadowTraversalMask(2);
    for (int i = 0; i < 2; ++i) { // one from the left, one from the right
        const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
        light->getLight()->setLightNum(i);
        light->getLight()->setDiffuse(osg::Vec4(0.4f, 0.4f, 0.4f, 1));
        light->getLight()->setPosition(osg::Vec4(i == 0 ? -4 : 4, 0, 4, 0));
        if (i == 0) map->setLight(light);
        scene->addChild(light);
    }
    scene->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Node> floor = new osg::ShapeDrawable(new osg::Box({0, 0, 0}, 8, 8, 0.1f));
    floor->setNodeMask(1);
    scene->addChild(floor);
    const osg::ref_ptr<osg::Node> box = new osg::ShapeDrawable(new osg::Box({0, 0, 2}, 1, 1, 1));
    box->setNodeMask(3);
    scene->addChild(box);
    osgDB::writeNodeFile(*scene, "shadow.osgb");
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile("shadow.osgb");
    const auto side = [](double at) { return at < -0.05 ? "left" : at > 0.05 ? "right" : "none"; };
    std::cout << "made: shadow on the " << side(shadowAt(scene)) << '\n';
    std::cout << "saved and read: shadow on the " << side(shadowAt(read)) << '\n';
}
END
g++ -O1 shadow.cpp -o shadow -losgShadow -losgViewer -losgGA -losgUtil -losgDB -losg -lOpenThreads
"$here/../cmake/with_display.sh" 800x600 ./shadow >seen
expect <<'END'
made: shadow on the right
saved and read: shadow on the left
END
