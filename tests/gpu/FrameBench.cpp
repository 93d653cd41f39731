// SPDX-License-Identifier: MIT
#include "FrameBench.h"

#include "EglWindow.h"

#include <osgSkinGpu/GpuCrowd>
#include <osgSkinGpu/GpuSkin>

#include <osg/GLExtensions>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgViewer/Viewer>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>

namespace {

constexpr int kWidth = 1920, kHeight = 1080;

struct Finish : osg::Camera::DrawCallback {
    void operator()(osg::RenderInfo&) const override { glFinish(); }
};

/// The place of one of many characters, in rows around the origin.
osg::Vec3d placeOf(std::size_t i, std::size_t count, double spacing) {
    const double side = std::ceil(std::sqrt(double(count)));
    return osg::Vec3d(std::fmod(double(i), side) - 0.5 * side,
                      std::floor(double(i) / side) - 0.5 * side, 0.0) *
           spacing;
}

double spacingOf(const osg::BoundingSphere& member) {
    return 0.7 * double(member.radius());
}

/// Milliseconds of a frame, by the clock, until the card has finished: the median of 30 frames, or
/// of as many as five seconds allow.
double timeFrames(osg::Node& scene, double extent, const std::function<void(double)>& update) {
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    const osg::ref_ptr<test::EglWindow> window = new test::EglWindow(kWidth, kHeight);
    if (!window->valid()) throw std::runtime_error("EGL gives no context");
    osg::Camera& camera = *viewer.getCamera();
    camera.setGraphicsContext(window);
    camera.setViewport(0, 0, kWidth, kHeight);
    camera.setDrawBuffer(GL_BACK);
    camera.setReadBuffer(GL_BACK);
    camera.setProjectionMatrixAsPerspective(30.0, double(kWidth) / kHeight, 0.1, 1e5);
    camera.setFinalDrawCallback(new Finish);
    viewer.setSceneData(&scene);
    viewer.realize();
    camera.setViewMatrixAsLookAt({0.15 * extent, -1.5 * extent - 4.0, 0.45 * extent + 1.5},
                                 {0.0, -0.15 * extent, 0.5}, {0.0, 0.0, 1.0});
    std::vector<double> times;
    double all = 0.0;
    constexpr int kFirst = 4; // these compile and upload
    for (int i = 0; i < kFirst + 30 && (i < kFirst + 5 || all < 5000.0); ++i) {
        const auto start = std::chrono::steady_clock::now();
        if (update) update(i / 60.0);
        viewer.frame(i / 60.0);
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        if (i < kFirst) continue;
        times.push_back(took.count());
        all += took.count();
    }
    if (window->makeCurrent()) scene.releaseGLObjects(window->getState());
    window->releaseContext();
    std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
    return times[times.size() / 2];
}

osg::ref_ptr<osg::Node> load(const std::string& file) {
    osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file);
    if (!scene) throw std::runtime_error(file + ": expected a character");
    return scene;
}

void benchCrowd(osgSkin::CrowdCharacter& character, std::size_t count) {
    const osg::BoundingSphere sphere(character.bounds());
    const double spacing = spacingOf(sphere);
    std::vector<osgSkin::CrowdInstance> members(count);
    for (std::size_t i = 0; i < count; ++i) {
        members[i].position = placeOf(i, count, spacing);
        members[i].clip = static_cast<unsigned int>(i % character.clipCount());
        members[i].phase = 0.037 * double(i);
    }
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(&character);
    crowd->setInstances(members);
    const double extent = 0.5 * spacing * std::sqrt(double(count));
    const double took =
        timeFrames(*crowd, extent, [&](double seconds) { crowd->setTime(seconds); });
    std::printf("crowd of %7zu     %9.2f ms  %8.4f us a member\n", count, took,
                1000.0 * took / double(count));
}

void benchSingles(const std::string& file, std::size_t count) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    double spacing = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const osg::ref_ptr<osg::Node> one = load(file);
        if (i == 0) spacing = spacingOf(one->getBound());
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::translate(placeOf(i, count, spacing)));
        place->addChild(one);
        scene->addChild(place);
    }
    for (const bool gpu : {true, false}) {
        osgSkin::setGpu(*scene, gpu);
        const double took = timeFrames(*scene, 0.5 * spacing * std::sqrt(double(count)), {});
        std::printf("%5zu characters, %s %9.2f ms  %8.4f us a character\n", count,
                    gpu ? "card     " : "processor", took, 1000.0 * took / double(count));
    }
}

} // namespace

void benchFrames(const std::string& file, const std::vector<std::size_t>& crowds,
                 std::size_t singles) {
    {
        const osg::ref_ptr<test::EglWindow> window = new test::EglWindow(16, 16);
        if (!window->valid() || !window->realize() || !window->makeCurrent())
            throw std::runtime_error("EGL gives no context");
        std::printf(
            "%s, OpenGL %s\nwhole frames of %d x %d pixels, update to the end of the draw\n",
            reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
            reinterpret_cast<const char*>(glGetString(GL_VERSION)), kWidth, kHeight);
        window->releaseContext();
    }
    const osg::ref_ptr<osg::Node> loaded = load(file);
    for (const std::size_t count : crowds) {
        const auto character = osgSkin::CrowdCharacter::create(*loaded);
        if (count == crowds.front()) {
            std::printf("triangles of a member:");
            for (std::size_t level = 0; level < character->levelCount(); ++level)
                std::printf(" %zu", character->triangleCount(level));
            std::printf("\n");
        }
        benchCrowd(*character, count);
    }
    if (singles > 0) benchSingles(file, singles);
}
