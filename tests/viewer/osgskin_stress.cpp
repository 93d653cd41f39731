// SPDX-License-Identifier: MIT
// A crowd in two windows for many frames, in one of OSG's threading models: for ThreadSanitizer,
// and for OSG's own stats, which show whether a frame's update overlaps the previous frame's draw.
// Also for long runs, whose memory must not grow (tests/soak).
#include "CommandLine.h"
#include "FindNodes.h"
#include "MemorySlope.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinGpu/GpuSkin>

#include <osg/MatrixTransform>
#include <osg/Stats>
#include <osgDB/ReadFile>
#include <osgViewer/CompositeViewer>

#include <algorithm>
#include <iostream>
#include <limits>
#include <map>
#include <string>

namespace {

using osgViewer::ViewerBase;

/// Number of frames with stats; keeping them for all frames would look like a leak.
constexpr unsigned int kStats = 500;
/// Frames between a long run's progress lines.
constexpr unsigned int kProgress = 20000;

/// Frames between memory samples.
constexpr unsigned int kCycle = 50;

const std::map<std::string, ViewerBase::ThreadingModel> kModels = {
    {"SingleThreaded", ViewerBase::SingleThreaded},
    {"CullDrawThreadPerContext", ViewerBase::CullDrawThreadPerContext},
    {"DrawThreadPerContext", ViewerBase::DrawThreadPerContext},
    {"CullThreadPerCameraDrawThreadPerContext",
     ViewerBase::CullThreadPerCameraDrawThreadPerContext},
};

/// `count` copies of `character` in rows, each with its own bones, skin and time.
osg::ref_ptr<osg::Group> makeCrowd(const osg::Node& character, unsigned int count) {
    osg::ref_ptr<osg::Group> crowd = new osg::Group;
    for (unsigned int i = 0; i < count; ++i) {
        const unsigned int row = i / 10;
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(1.5 * (i % 10) - 7.0, 1.5 * row, 0.0));
        const osg::CopyOp own(osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_DRAWABLES |
                              osg::CopyOp::DEEP_COPY_CALLBACKS);
        place->addChild(osg::clone(&character, own));
        crowd->addChild(place);
    }
    return crowd;
}

osg::ref_ptr<osgViewer::View> makeView(osg::Node* scene, int x, int pixels) {
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    traits->x = x;
    traits->width = traits->height = pixels;
    traits->windowDecoration = false;
    traits->doubleBuffer = true;
    osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
    view->getCamera()->setGraphicsContext(osg::GraphicsContext::createGraphicsContext(traits));
    view->getCamera()->setViewport(0, 0, pixels, pixels);
    view->getCamera()->setProjectionMatrixAsPerspective(40.0, 1.0, 0.1, 1000.0);
    view->getCamera()->setViewMatrixAsLookAt(osg::Vec3d(0, -20, 6), osg::Vec3d(0, 2, 1),
                                             osg::Vec3d(0, 0, 1));
    view->setSceneData(scene);
    return view;
}

/// Number of frames whose update began before the previous frame's draw had ended, in any view.
unsigned int overlaps(osgViewer::CompositeViewer& viewer, unsigned int from, unsigned int to) {
    unsigned int count = 0;
    for (unsigned int frame = from; frame < to; ++frame) {
        bool overlap = false;
        double begin = 0.0, end = 0.0;
        for (unsigned int v = 0; v < viewer.getNumViews(); ++v)
            overlap = overlap || (viewer.getViewerStats()->getAttribute(
                                      frame + 1, "Update traversal begin time", begin) &&
                                  viewer.getView(v)->getCamera()->getStats()->getAttribute(
                                      frame, "Draw traversal end time", end) &&
                                  begin < end);
        count += overlap ? 1 : 0;
    }
    return count;
}

} // namespace

int main(int argc, char** argv) {
    std::string file, model;
    unsigned int count = 0, frames = 0;
    int windows = 2, pixels = 300;
    bool gpu = false;
    double most = std::numeric_limits<double>::infinity();
    example::CommandLine line("osgskin_stress",
                              "A crowd of a character's copies in windows for many frames.");
    line.add("CHARACTER", file).required();
    std::vector<std::string> models;
    for (const auto& [name, value] : kModels) models.push_back(name);
    line.add("MODEL", model, "threading model").required().oneOf(models);
    line.add("CHARACTERS", count).required().range(1, 10000);
    line.add("FRAMES", frames).required().range(10, 100000000);
    line.add("--windows", windows).range(1, 10);
    line.add("--pixels", pixels, "width and height of a window").range(1, 4000);
    line.add("--gpu", gpu, "deform by compute shaders");
    line.add("--most", most, "fail where memory grows by more kB in 50 frames");
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);

        const osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(file);
        if (!character) return 1;
        const osg::ref_ptr<osg::Group> crowd = makeCrowd(*character, count);
        if (gpu) osgSkin::setGpu(*crowd, true);

        const unsigned int kept = std::min(frames, kStats) + 10;
        osgViewer::CompositeViewer viewer;
        viewer.setThreadingModel(kModels.at(model));
        viewer.setViewerStats(new osg::Stats("viewer", kept));
        viewer.getViewerStats()->collectStats("update", true);
        for (int i = 0; i < windows; ++i) {
            const osg::ref_ptr<osgViewer::View> view = makeView(crowd, i * pixels, pixels);
            if (!view->getCamera()->getGraphicsContext()) return 1;
            viewer.addView(view);
            view->getCamera()->setStats(new osg::Stats("camera", kept));
            view->getCamera()->getStats()->collectStats("rendering", true);
        }
        viewer.realize();
        // Pauses and goes back now and then: repeats poses, also out of order.
        double time = 0.0;
        test::MemorySlope memory;
        for (unsigned int frame = 0; frame < frames; ++frame) {
            if (frame % 50 < 45) time += 1.0 / 60.0;
            if (frame % 200 == 199) time -= 1.0;
            viewer.frame(time);
            if (frame % kCycle == kCycle - 1) memory.sample();
            if (frame % kProgress == kProgress - 1)
                std::cerr << "frame " << frame + 1 << " of " << frames << ": "
                          << memory.last() / 1024.0 << " MB" << std::endl;
        }
        viewer.stopThreading();

        const auto skins = test::findNodes<osgSkin::DeformableSkin>(*crowd);
        std::size_t deformed = 0;
        for (const auto& skin : skins) deformed += skin.node->getDeformCount();
        const unsigned int dispatches = osgSkin::gpuCounts().dispatches;
        const unsigned int from = frames > kStats ? frames - kStats : 5;
        std::cout << model << ": " << skins.size() << " skins, " << frames << " frames, "
                  << deformed << " poses deformed, " << dispatches << " dispatches; in "
                  << overlaps(viewer, from, frames - 1) << " of the last " << frames - 1 - from
                  << " frames the update began before the draw of the frame before had ended; "
                  << memory.last() / 1024.0 << " MB in the end, " << memory.slope() << " kB in "
                  << kCycle << " frames" << std::endl;
        const bool good = skins.size() >= count && deformed <= skins.size() * frames &&
                          (gpu ? dispatches : deformed) > 0 && memory.slope() <= most;
        return good ? 0 : 1;
    });
}
