// SPDX-License-Identifier: MIT
#include "CardCrowd.h"
#include "CommandLine.h"
#include "Crowd.h"
#include "DataFolder.h"
#include "FrameBench.h"
#include "FrameRange.h"
#include "Ground.h"
#include "Snapshots.h"
#include "WindowOptions.h"

#include <osgDB/Registry>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

template <typename AnyCrowd>
example::View viewOf(const AnyCrowd& crowd) {
    const auto r = static_cast<double>(crowd.getRadius());
    return {{0.15 * r, -1.5 * r - 4.0, 0.45 * r + 1.5}, {0.0, -0.15 * r, 0.5}};
}

/// Where pictures go, and which ones.
struct Pictures {
    std::string folder;
    example::FrameRange frames; ///< of 60 a second
};

/// Takes pictures of any crowd.
///
/// \param after called with the number of the pictures so far after each
template <typename AnyCrowd, typename After>
void takePictures(const AnyCrowd& crowd, osg::Node* scene, const Pictures& pictures,
                  const example::WindowOptions& window, const After& after) {
    example::Snapshots snapshots(scene, viewOf(crowd), window.width(), window.height());
    unsigned int count = 0;
    for (std::size_t f = pictures.frames.first; f <= pictures.frames.last;
         f += pictures.frames.step) {
        snapshots.write(static_cast<double>(f) / 60.0,
                        example::pictureName(pictures.folder, "crowd", count++));
        after(count);
    }
}

int show(osg::Group* scene, const example::View& view, osgViewer::Viewer& viewer,
         const example::WindowOptions& window) {
    viewer.setSceneData(scene);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(view.eye, view.centre, view.up);
    viewer.setCameraManipulator(camera);
    window.open(viewer);
    return viewer.run();
}

/// Runs the crowd on the graphics card.
int runOnCard(const std::vector<std::string>& files, std::size_t count, const Pictures& pictures,
              osgViewer::Viewer& viewer, const example::WindowOptions& window) {
    const osg::ref_ptr<CardCrowd> crowd = new CardCrowd(files, count);
    std::cout << crowd->summary() << std::endl;
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(crowd->getScene());
    scene->addChild(example::makeFloor(std::ceil(1.5f * crowd->getRadius())));
    if (pictures.folder.empty()) return show(scene, viewOf(*crowd), viewer, window);
    double least = 0.0;
    takePictures(*crowd, scene, pictures, window, [&](unsigned int taken) {
        const double took = crowd->getProcessorTime();
        least = taken == 1 ? took : std::min(least, took);
    });
    std::printf(
        "%zu frames in %s; the crowd's update and cull took the processor %.3f ms at least\n",
        pictures.frames.count(), pictures.folder.c_str(), least);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Many characters, each in its own phase of its own clip.", "osgskincrowd");
    app.set_version_flag("--version", example::versionText("osgskincrowd"));
    app.footer("Characters are loaded with -O \"shapes=none normals=rotated\" unless -O says "
               "otherwise: more\nis not visible at a crowd's distance.\n" +
               std::string(example::kWindowHelp) + "\nExit status: 0 done, 1 failed, 2 bad usage.");
    std::vector<std::string> files = {example::dataFolder() + "/thrower.skin"};
    std::string out, frames = "0:11";
    std::size_t count = 1000;
    unsigned int threads = 0;
    unsigned int timed = 0;
    bool gpu = false;
    app.add_option("CHARACTER", files, ".skin or any file with a deformable skin; they take turns");
    app.add_option("--count", count, "how many characters")->check(CLI::Range(1, 100000));
    app.add_option("--threads", threads, "most threads that pose and deform; 0: all processors");
    CLI::Option* const onCard = app.add_flag(
        "--gpu", gpu, "everything on the graphics card (OpenGL 3.3; 4.3 culls there, too)");
    CLI::Option* const toFolder = app.add_option(
        "--out", out, "write crowd_00.png, ... to this folder; no window to look at");
    app.add_option("--frames", frames, "frames to write, 60 a second: A, A:B or A:B:STEP")
        ->capture_default_str()
        ->needs(toFolder);
    app.add_option("--time", timed, "time so many frames without drawing; no window")
        ->check(CLI::Range(1u, 10000u))
        ->excludes(onCard)
        ->excludes(toFolder);
    if (!example::hasNoEmptyWord("osgskincrowd", argc, argv)) return 2;
    try {
        osg::ArgumentParser words(&argc, argv);
        const example::WindowOptions window(words, 1000, 800);
        osgViewer::Viewer viewer(words);
        app.parse(argc, argv);
        const Pictures pictures{out, example::FrameRange::parse(frames)};
        if (!example::hasOsgOptionString())
            osgDB::Registry::instance()->setOptions(
                new osgDB::Options("shapes=none normals=rotated"));
        if (gpu)
            return example::finish("osgskincrowd",
                                   runOnCard(files, count, pictures, viewer, window));
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
        if (out.empty()) {
            scene->addChild(makeFrameTime(*crowd, pool->getThreadCount()));
            return show(scene, viewOf(*crowd), viewer, window);
        }
        double pose = 0.0, deform = 0.0;
        takePictures(*crowd, scene, pictures, window, [&](unsigned int) {
            pose += crowd->getPoseTime();
            deform += crowd->getDeformTime();
        });
        const auto taken = static_cast<double>(pictures.frames.count());
        std::printf("%.0f frames in %s; in an update, poses took %.2f ms and skins %.2f ms\n",
                    taken, out.c_str(), pose / taken, deform / taken);
        return example::finish("osgskincrowd", 0);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const example::UsageError& error) {
        std::cerr << "osgskincrowd: " << error.what() << std::endl;
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "osgskincrowd: " << error.what() << std::endl;
        return 1;
    }
}
