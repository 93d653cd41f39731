// SPDX-License-Identifier: MIT
#include "CharacterOptions.h"
#include "CommandLine.h"
#include "DataFolder.h"
#include "Keys.h"
#include "Snapshots.h"
#include "Stage.h"
#include "WindowOptions.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/OptionString>

#include <osgDB/Registry>
#include <osgGA/StateSetManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <cmath>
#include <exception>
#include <iostream>

namespace {

/// A viewer whose frames are at a stage's own time, which may stand still or run backwards.
struct StageViewer : osgViewer::Viewer {
    explicit StageViewer(osg::ArgumentParser& words) : osgViewer::Viewer(words) {}
    void frame(double) override {
        stage->clock.advance(real.elapsedTime());
        real.reset();
        osgViewer::Viewer::frame(stage->simulationTime());
    }
    viewer::Stage* stage = nullptr;
    osg::ElapsedTime real;
};

int show(viewer::Stage& stage, StageViewer& window, const example::WindowOptions& options) {
    window.stage = &stage;
    window.setSceneData(stage.root());
    window.addEventHandler(new viewer::Keys(stage));
    window.addEventHandler(new osgViewer::StatsHandler);
    const example::View view = stage.view();
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(view.eye, view.centre, view.up);
    window.setCameraManipulator(camera);
    options.open(window);
    window.real.reset();
    return window.run();
}

/// Takes a picture of the start, then one after each of `keys`, and prints a summary of each.
void takePictures(viewer::Stage& stage, const std::string& keys, const std::string& folder,
                  const example::WindowOptions& window, bool times) {
    example::Snapshots snapshots(stage.root(), stage.view(), window.width(), window.height());
    for (std::size_t i = 0; i <= keys.size(); ++i) {
        if (i > 0 && !viewer::press(stage, keys[i - 1]))
            throw std::runtime_error(std::string("--keys: no key '") + keys[i - 1] +
                                     "', expected one of those that h lists");
        const std::string file =
            example::pictureName(folder, "viewer", static_cast<unsigned int>(i));
        snapshots.write(stage.simulationTime(), file);
        std::cout << file << ": " << (i > 0 ? std::string("'") + keys[i - 1] + "' " : "")
                  << osgSkin::onOneLine(stage.summary()) << (times ? "; " + stage.times() : "")
                  << std::endl;
    }
}

constexpr double kLatest = 1e6; ///< seconds; frames are still distinct at this time

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskinviewer", "Plays a character and shows how its skin is bound and deformed.",
        std::string("Keys:\n") + viewer::keysHelp() + "\n\n" + example::kWindowHelp);
    std::string character = example::dataFolder() + "/thrower.skin";
    std::string weights, motion, joint, keys, out;
    osgSkin::LoadOptions options;
    double at = 0.0;
    bool paused = false, times = false;
    line.add("CHARACTER", character, example::kCharacterHelp);
    line.add("--weights", weights,
             "painted weights (JSON) for the peers; without: from our ratios");
    example::addCharacterOptions(line, options);
    line.add("--motion", motion, "name of the motion to start with");
    line.add("--joint", joint, "name of the joint whose ratios b and t show");
    line.add("--at", at, "seconds into the motion to start at");
    line.add("--paused", paused, "start paused");
    line.add("--keys", keys, "keys to press first; with --out, one before each picture");
    const auto toFolder =
        line.add("--out", out,
                 "write viewer_00.png, ... to this folder instead of opening a window; needs an "
                 "X display (Xvfb will do)");
    line.add("--times", times, "with --out: say how long each frame and its skin took")
        .needs(toFolder);
    return line.run(argc, argv, [&] {
        osg::ArgumentParser words(&argc, argv);
        const example::WindowOptions place(words, 900, 800);
        StageViewer window(words);
        try {
            options = osgSkin::toLoadOptions(osgDB::Registry::instance()->getOptions());
        } catch (const osgSkin::Error& error) {
            throw example::UsageError(std::string("-O: ") + error.what());
        }
        line.parse(argc, argv);
        if (!(std::abs(at) <= kLatest)) // also rejects NaN
            throw example::UsageError("--at: expected at most a million seconds");
        viewer::Stage stage(character, weights, options, place.width(), place.height());
        if (!motion.empty()) stage.setMotion(motion);
        if (!joint.empty()) stage.setJoint(joint);
        stage.clock.seek(at);
        stage.clock.playing = !paused;
        if (!out.empty()) {
            takePictures(stage, keys, out, place, times);
            return 0;
        }
        for (const char key : keys) viewer::press(stage, key);
        return show(stage, window, place);
    });
}
