// SPDX-License-Identifier: MIT
#include "CardCrowd.h"
#include "CommandLine.h"
#include "Crowd.h"
#include "DataFolder.h"
#include "FrameBench.h"
#include "FrameRange.h"
#include "Ground.h"
#include "Snapshots.h"
#include "Street.h"
#include "WindowOptions.h"

#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

namespace {

template <typename AnyCrowd>
example::View viewOf(const AnyCrowd& crowd) {
    const auto r = static_cast<double>(crowd.getRadius());
    return {{0.15 * r, -1.5 * r - 4.0, 0.45 * r + 1.5}, {0.0, -0.15 * r, 0.5}};
}

example::View viewOf(const Street& street) {
    return street.view();
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

/// The people of data/people.
std::vector<std::string> savedPeople() {
    std::vector<std::string> files;
    const std::filesystem::path folder = example::dataFolder() + "/people";
    for (const auto& file : std::filesystem::directory_iterator(folder))
        if (file.path().extension() == ".skin") files.push_back(file.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

/// Runs the street.
int runStreet(const std::vector<std::string>& files, std::size_t count, unsigned int threads,
              unsigned int timed, const Pictures& pictures, osgViewer::Viewer& viewer,
              const example::WindowOptions& window) {
    const osg::ref_ptr<Street> street = new Street(files, count, threads);
    if (timed > 0) {
        street->bench(timed);
        return 0;
    }
    if (pictures.folder.empty()) {
        street->getScene()->addChild(makeStreetTime(count));
        return show(street->getScene(), street->view(), viewer, window);
    }
    const example::FrameRange& frames = pictures.frames;
    const auto walkTo = [&](std::size_t frame) { street->walkTo((double(frame) - 0.5) / 60.0); };
    walkTo(frames.first);
    takePictures(*street, street->getScene(), pictures, window,
                 [&](unsigned int taken) { walkTo(frames.first + taken * frames.step); });
    std::printf("%zu frames in %s\n", pictures.frames.count(), pictures.folder.c_str());
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskincrowd", "Many characters, each in its own phase of its own clip.",
        "Characters are loaded with -O \"shapes=none normals=rotated\" unless -O says "
        "otherwise: more\nis not visible at a crowd's distance.\n" +
            std::string(example::kWindowHelp));
    std::vector<std::string> files;
    std::string out, frames = "0:11";
    std::size_t count = 1000;
    unsigned int threads = 0;
    unsigned int timed = 0;
    std::size_t people = 0;
    bool gpu = false;
    line.add("CHARACTER", files, std::string(example::kCharacterHelp) + "; several take turns");
    line.add("--count", count, "how many characters").range(1, 100000);
    line.add("--threads", threads, "most threads that pose and deform; 0: all processors");
    const auto onCard = line.add(
        "--gpu", gpu, "everything on the graphics card (OpenGL 3.3; 4.3 culls there, too)");
    line.add("--street", people,
             "so many people on pavements and crossings; CHARACTERs walk, or are saved walkers")
        .range(1, 100000)
        .excludes(onCard);
    const auto toFolder = line.add(
        "--out", out, "write crowd_00.png, ... to this folder instead of opening a window");
    line.add("--frames", frames, "frames to write, 60 a second: A, A:B or A:B:STEP")
        .showDefault()
        .needs(toFolder);
    line.add("--time", timed, "time so many frames without drawing; no window")
        .range(1, 10000)
        .excludes(onCard)
        .excludes(toFolder);
    return line.run(argc, argv, [&] {
        osg::ArgumentParser words(&argc, argv);
        const example::WindowOptions window(words, 1000, 800);
        osgViewer::Viewer viewer(words);
        line.parse(argc, argv);
        const Pictures pictures{out, example::FrameRange::parse(frames)};
        if (files.empty() && people > 0) files = savedPeople();
        if (files.empty()) files = {example::dataFolder() + "/thrower.skin"};
        if (people > 0) return runStreet(files, people, threads, timed, pictures, viewer, window);
        if (gpu) return runOnCard(files, count, pictures, viewer, window);
        std::vector<CrowdCharacter> characters;
        characters.reserve(files.size());
        for (const std::string& file : files) characters.emplace_back(file);
        const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(threads);
        const osg::ref_ptr<Crowd> crowd = new Crowd(characters, count, pool);
        std::cout << count << " characters, " << crowd->getVertexCount() << " skin vertices, "
                  << pool->getThreadCount() << " threads" << std::endl;
        if (timed > 0) {
            benchFrames(*crowd, crowd->getScene(), timed, pool->getThreadCount());
            return 0;
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
        return 0;
    });
}
