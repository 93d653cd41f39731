// SPDX-License-Identifier: MIT
#include "CommandLine.h"
#include "DataFolder.h"
#include "FrameRange.h"
#include "Ground.h"
#include "Snapshots.h"
#include "ThrowScene.h"
#include "WindowOptions.h"

#include <osgGA/StateSetManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <iostream>
#include <optional>
#include <string>

namespace {

const example::View kView{{0.75, -5.1, 1.35}, {0.62, 0.0, 0.9}};

void takePictures(osg::Node* scene, const ThrowFacts& facts, const example::FrameRange& frames,
                  const example::WindowOptions& window, const std::string& folder) {
    example::Snapshots snapshots(scene, kView, window.width(), window.height());
    unsigned int count = 0;
    for (std::size_t frame = frames.first; frame <= frames.last; frame += frames.step)
        snapshots.write(static_cast<double>(frame) * facts.frameTime,
                        example::pictureName(folder, "throw", count++));
    std::cout << count << " pictures of the throw in " << folder << std::endl;
}

int show(osg::Node* scene, osgViewer::Viewer& viewer, const example::WindowOptions& window) {
    viewer.setSceneData(scene);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    viewer.addEventHandler(new osgGA::StateSetManipulator(viewer.getCamera()->getStateSet()));
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(kView.eye, kView.centre, kView.up);
    viewer.setCameraManipulator(camera);
    window.open(viewer);
    return viewer.run();
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line("osgskinthrow",
                              "A figure throws a ball: a scene built from the public API.",
                              example::kWindowHelp);
    std::string data = example::dataFolder();
    std::string out;
    std::string frames;
    line.add("--data", data, "folder of thrower.obj, thrower.bvh and throw.bvh");
    const auto toFolder = line.add(
        "--out", out, "write throw_00.png, ... to this folder instead of opening a window");
    line.add("--frames", frames,
             "frames of the motion: A, A:B or A:B:STEP; every twelfth of it by default")
        .needs(toFolder);
    return line.run(argc, argv, [&] {
        osg::ArgumentParser words(&argc, argv);
        const example::WindowOptions window(words, 1000, 800);
        osgViewer::Viewer viewer(words);
        if (example::hasOsgOptionString())
            throw example::UsageError("-O: the files are not read by osgDB");
        line.parse(argc, argv);
        std::optional<example::FrameRange> range;
        if (!frames.empty()) range = example::FrameRange::parse(frames);
        ThrowFacts facts;
        const osg::ref_ptr<osg::Group> scene = example::withShadow(makeThrowScene(data, &facts));
        if (!range) range = {0, facts.frames - 1, std::max<std::size_t>(1, facts.frames / 12)};
        if (range->last >= facts.frames)
            throw example::UsageError("--frames: the motion has frames 0 to " +
                                      std::to_string(facts.frames - 1) + ", found " +
                                      std::to_string(range->last));
        std::cout << facts.feet << std::flush;
        scene->addChild(example::makeFloor(8.0f));
        if (out.empty()) return show(scene, viewer, window);
        takePictures(scene, facts, *range, window, out);
        return 0;
    });
}
