// SPDX-License-Identifier: MIT
#include "CardCrowd.h"
#include "CommandLine.h"
#include "Crowd.h"
#include "DataFolder.h"
#include "FrameBench.h"
#include "Ground.h"
#include "Snapshots.h"

#include <osgDB/Registry>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>

namespace {

template <typename AnyCrowd>
example::View viewOf(const AnyCrowd& crowd) {
    const auto r = static_cast<double>(crowd.getRadius());
    return {{0.15 * r, -1.5 * r - 4.0, 0.45 * r + 1.5}, {0.0, -0.15 * r, 0.5}};
}

/// Takes pictures at 60 frames per second, and prints the mean times of the updates.
void takePictures(const Crowd& crowd, osg::Node* scene, unsigned int frames,
                  const std::string& folder) {
    example::Snapshots snapshots(scene, viewOf(crowd), 1000, 800);
    double pose = 0.0, deform = 0.0;
    for (unsigned int i = 0; i < frames; ++i) {
        snapshots.write(i / 60.0, example::pictureName(folder, "crowd", i));
        pose += crowd.getPoseTime() / frames;
        deform += crowd.getDeformTime() / frames;
    }
    std::printf("%u frames in %s; in an update, poses took %.2f ms and skins %.2f ms\n", frames,
                folder.c_str(), pose, deform);
}

int show(osg::Group* scene, const example::View& view) {
    osgViewer::Viewer viewer;
    viewer.setUpViewInWindow(100, 100, 1000, 800);
    viewer.setSceneData(scene);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(view.eye, view.centre, view.up);
    viewer.setCameraManipulator(camera);
    example::openWindow(viewer);
    return viewer.run();
}

/// Runs the crowd on the graphics card.
int runOnCard(const std::vector<std::string>& files, std::size_t count, unsigned int frames,
              const std::string& folder) {
    const osg::ref_ptr<CardCrowd> crowd = new CardCrowd(files, count);
    std::cout << crowd->summary() << std::endl;
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(crowd->getScene());
    scene->addChild(example::makeFloor(std::ceil(1.5f * crowd->getRadius())));
    if (folder.empty()) return show(scene, viewOf(*crowd));
    example::Snapshots snapshots(scene, viewOf(*crowd), 1000, 800);
    double least = 0.0;
    for (unsigned int i = 0; i < frames; ++i) {
        snapshots.write(i / 60.0, example::pictureName(folder, "crowd", i));
        const double took = crowd->getProcessorTime();
        least = i == 0 ? took : std::min(least, took);
    }
    std::printf(
        "%u frames in %s; the crowd's update and cull took the processor %.3f ms at least\n",
        frames, folder.c_str(), least);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Many characters, each in its own phase of its own clip.", "osgskincrowd");
    app.set_version_flag("--version", example::versionText("osgskincrowd"));
    std::vector<std::string> files = {example::dataFolder() + "/thrower.skin"};
    // Shapes and surface normals cost time, and are not visible at a crowd's distance.
    std::string options = "shapes=none normals=rotated";
    std::string pictures;
    std::size_t count = 1000;
    unsigned int threads = 0;
    unsigned int frames = 12;
    unsigned int timed = 0;
    bool gpu = false;
    app.add_option("characters", files,
                   ".skin or any file with a deformable skin; they take turns");
    app.add_option("-O,--options", options, "the plug-in's options for the characters")
        ->capture_default_str();
    app.add_option("--count", count, "how many characters")->check(CLI::Range(1, 100000));
    app.add_option("--threads", threads, "most threads that pose and deform; 0: all processors");
    CLI::Option* const onCard = app.add_flag(
        "--gpu", gpu, "everything on the graphics card (OpenGL 3.3; 4.3 culls there, too)");
    CLI::Option* const toFolder = app.add_option(
        "--pictures", pictures, "write pictures to this folder; no window to look at");
    app.add_option("--frames", frames, "how many pictures")
        ->check(CLI::Range(1u, 99u))
        ->needs(toFolder);
    app.add_option("--time", timed, "time so many frames without drawing; no window")
        ->check(CLI::Range(1u, 10000u))
        ->excludes(onCard)
        ->excludes(toFolder);
    if (!example::hasNoEmptyWord("osgskincrowd", argc, argv)) return 2;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        osgDB::Registry::instance()->setOptions(new osgDB::Options(options));
        if (gpu) return example::finish("osgskincrowd", runOnCard(files, count, frames, pictures));
        std::vector<CrowdCharacter> characters;
        characters.reserve(files.size());
        for (const std::string& file : files) characters.emplace_back(file);
        const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(threads);
        const osg::ref_ptr<Crowd> crowd = new Crowd(characters, count, pool);
        std::cout << count << " characters, " << crowd->getVertexCount() << " skin vertices, "
                  << pool->getThreadCount() << " threads" << std::endl;
        if (timed > 0) {
            benchFrames(*crowd, crowd->getScene(), timed, pool->getThreadCount());
            return example::finish("osgskincrowd", 0);
        }
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(crowd->getScene());
        scene->addChild(example::makeFloor(std::ceil(1.5f * crowd->getRadius())));
        if (pictures.empty()) {
            scene->addChild(makeFrameTime(*crowd, pool->getThreadCount()));
            return show(scene, viewOf(*crowd));
        }
        takePictures(*crowd, scene, frames, pictures);
        return example::finish("osgskincrowd", 0);
    } catch (const std::exception& error) {
        std::cerr << "osgskincrowd: " << error.what() << std::endl;
        return 1;
    }
}
