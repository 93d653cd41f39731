// SPDX-License-Identifier: MIT
#include "CommandLine.h"
#include "DataFolder.h"
#include "Ground.h"
#include "Snapshots.h"
#include "ThrowScene.h"

#include <osgGA/StateSetManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <CLI/CLI.hpp>

#include <cmath>
#include <exception>
#include <iostream>

namespace {

const example::View kView{{0.75, -5.1, 1.35}, {0.62, 0.0, 0.9}};

/// Takes pictures of the throw from second `from` to second `to`.
void takePictures(osg::Node* scene, double from, double to, unsigned int count,
                  const std::string& folder) {
    example::Snapshots snapshots(scene, kView, 800, 800);
    const double step = count > 1 ? (to - from) / (count - 1) : 0.0;
    for (unsigned int i = 0; i < count; ++i)
        snapshots.write(from + i * step, example::pictureName(folder, "throw", i));
    std::cout << count << " pictures of the throw in " << folder << std::endl;
}

int show(osg::Node* scene) {
    osgViewer::Viewer viewer;
    viewer.setUpViewInWindow(100, 100, 1000, 800);
    viewer.setSceneData(scene);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    viewer.addEventHandler(new osgGA::StateSetManipulator(viewer.getCamera()->getStateSet()));
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(kView.eye, kView.centre, kView.up);
    viewer.setCameraManipulator(camera);
    example::openWindow(viewer);
    return viewer.run();
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("A figure throws a ball: a scene built from the public API.", "osgskinthrow");
    app.set_version_flag("--version", example::versionText("osgskinthrow"));
    std::string data = example::dataFolder();
    std::string pictures;
    unsigned int count = 12;
    double from = 0.0;
    double to = 0.999; // at 1 the loop starts again
    app.add_option("--data", data, "folder of thrower.obj, thrower.bvh and throw.bvh");
    app.add_option("--pictures", pictures, "write pictures to this folder; no window to look at");
    app.add_option("--count", count, "how many pictures")->check(CLI::Range(1u, 99u));
    app.add_option("--from", from, "first picture's time, as a fraction of the throw's length")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--to", to, "last picture's time, the same")->check(CLI::Range(0.0, 1.0));
    if (!example::hasNoEmptyWord("osgskinthrow", argc, argv)) return 2;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (!std::isfinite(from) || !std::isfinite(to)) { // CLI::Range accepts NaN
        std::cerr << "osgskinthrow: --from and --to: expected finite numbers" << std::endl;
        return 2;
    }
    try {
        ThrowFacts facts;
        const osg::ref_ptr<osg::Group> scene = example::withShadow(makeThrowScene(data, &facts));
        std::cout << facts.feet << std::flush;
        scene->addChild(example::makeFloor(8.0f));
        if (pictures.empty()) return show(scene);
        takePictures(scene, from * facts.seconds, to * facts.seconds, count, pictures);
        return example::finish("osgskinthrow", 0);
    } catch (const std::exception& error) {
        std::cerr << "osgskinthrow: " << error.what() << std::endl;
        return 1;
    }
}
