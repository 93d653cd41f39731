// SPDX-License-Identifier: MIT
// A crowd in two windows for many frames, in one of OSG's threading models: for ThreadSanitizer,
// and for OSG's own stats, which say whether the update of a frame overlaps the draw of the one
// before. For long runs, too, whose memory must stay as it is.
#include "MemorySlope.h"

#include <osgSkin/DeformableSkin>

#include <osg/MatrixTransform>
#include <osg/Stats>
#include <osgDB/ReadFile>
#include <osgViewer/CompositeViewer>

#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

namespace {

using osgViewer::ViewerBase;

const std::map<std::string, ViewerBase::ThreadingModel> kModels = {
    {"SingleThreaded", ViewerBase::SingleThreaded},
    {"CullDrawThreadPerContext", ViewerBase::CullDrawThreadPerContext},
    {"DrawThreadPerContext", ViewerBase::DrawThreadPerContext},
    {"CullThreadPerCameraDrawThreadPerContext",
     ViewerBase::CullThreadPerCameraDrawThreadPerContext},
};

/// Counts skins and the poses that they have deformed.
class Census : public osg::NodeVisitor {
public:
    unsigned int skins = 0, deformed = 0;

    Census() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        if (const auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) {
            ++skins;
            deformed += skin->getDeformCount();
        }
    }
};

/// `count` copies of `character` in rows, each with its bones, its skin and its own time.
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

osg::ref_ptr<osgViewer::View> makeView(osg::Node* scene, int x) {
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    traits->x = x;
    traits->width = traits->height = 300;
    traits->windowDecoration = false;
    traits->doubleBuffer = true;
    osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
    view->getCamera()->setGraphicsContext(osg::GraphicsContext::createGraphicsContext(traits));
    view->getCamera()->setViewport(0, 0, 300, 300);
    view->getCamera()->setProjectionMatrixAsPerspective(40.0, 1.0, 0.1, 1000.0);
    view->getCamera()->setViewMatrixAsLookAt(osg::Vec3d(0, -20, 6), osg::Vec3d(0, 2, 1),
                                             osg::Vec3d(0, 0, 1));
    view->setSceneData(scene);
    return view;
}

/// In how many frames the update began before the draw of the frame before had ended, in any view.
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
    if (argc != 5 || kModels.find(argv[2]) == kModels.end()) {
        std::cerr << "usage: osgskin_stress CHARACTER MODEL CHARACTERS FRAMES\nMODEL:";
        for (const auto& model : kModels) std::cerr << " " << model.first;
        std::cerr << std::endl;
        return 2;
    }
    const osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(argv[1]);
    if (!character) return 1;
    const auto count = static_cast<unsigned int>(std::atoi(argv[3]));
    const auto frames = static_cast<unsigned int>(std::atoi(argv[4]));
    const osg::ref_ptr<osg::Group> crowd = makeCrowd(*character, count);

    osgViewer::CompositeViewer viewer;
    viewer.setThreadingModel(kModels.at(argv[2]));
    viewer.setViewerStats(new osg::Stats("viewer", frames + 10));
    viewer.getViewerStats()->collectStats("update", true);
    for (int i = 0; i < 2; ++i) {
        const osg::ref_ptr<osgViewer::View> view = makeView(crowd, 300 * i);
        if (!view->getCamera()->getGraphicsContext()) return 1;
        viewer.addView(view);
        view->getCamera()->setStats(new osg::Stats("camera", frames + 10));
        view->getCamera()->getStats()->collectStats("rendering", true);
    }
    viewer.realize();
    // Pauses and goes back once in a while: the same poses again, and others out of turn.
    double time = 0.0;
    test::MemorySlope memory;
    for (unsigned int frame = 0; frame < frames; ++frame) {
        if (frame % 50 < 45) time += 1.0 / 60.0;
        if (frame % 200 == 199) time -= 1.0;
        viewer.frame(time);
        if (frame % 50 == 49) memory.sample();
    }
    viewer.stopThreading();

    Census census;
    crowd->accept(census);
    std::cout << argv[2] << ": " << census.skins << " skins, " << frames << " frames, "
              << census.deformed << " poses deformed; in " << overlaps(viewer, 5, frames - 1)
              << " of " << frames - 6
              << " frames the update began before the draw of the frame before had ended; "
              << memory.last() / 1024.0 << " MB in the end, " << memory.slope() / 50.0
              << " kB a frame" << std::endl;
    const bool good =
        census.skins >= count && census.deformed > 0 && census.deformed <= census.skins * frames;
    return good ? 0 : 1;
}
