// SPDX-License-Identifier: MIT
#include "CharacterOptions.h"
#include "CommandLine.h"
#include "DataFolder.h"
#include "Keys.h"
#include "Snapshots.h"
#include "Stage.h"

#include <osgSkin/Error>

#include <osgGA/StateSetManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <CLI/CLI.hpp>

#include <cmath>
#include <exception>
#include <iostream>

namespace {

struct Size {
    int width = 900;
    int height = 800;
};

int show(viewer::Stage& stage, const Size& size) {
    osgViewer::Viewer window;
    window.setUpViewInWindow(80, 80, size.width, size.height);
    window.setSceneData(stage.root());
    window.addEventHandler(new viewer::Keys(stage));
    window.addEventHandler(new osgViewer::StatsHandler);
    const example::View view = stage.view();
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(view.eye, view.centre, view.up);
    window.setCameraManipulator(camera);
    example::openWindow(window);
    osg::ElapsedTime real;
    while (!window.done()) {
        stage.clock.advance(real.elapsedTime());
        real.reset();
        window.frame(stage.simulationTime());
    }
    return 0;
}

/// Takes a picture of the start, then one after each of `keys`, and prints a summary of each.
void takePictures(viewer::Stage& stage, const std::string& keys, const std::string& folder,
                  const Size& size, bool times) {
    example::Snapshots snapshots(stage.root(), stage.view(), size.width, size.height);
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
    CLI::App app("Plays a character and shows how its skin is bound and deformed.",
                 "osgskinviewer");
    app.set_version_flag("--version", example::versionText("osgskinviewer"));
    app.footer(std::string("Keys:\n") + viewer::keysHelp() +
               "\n\nExit status: 0 done, 1 failed, 2 bad usage.");
    std::string character = example::dataFolder() + "/thrower.skin";
    std::string weights, motion, joint, keys, pictures;
    osgSkin::LoadOptions options;
    Size size;
    double at = 0.0;
    bool paused = false, times = false;
    app.add_option("CHARACTER", character,
                   "a .skin file, a rigged model (.glb, .fbx, ...), or a scene (.osgb)");
    app.add_option("--weights", weights,
                   "painted weights (JSON) for the peers; without: from our ratios");
    example::addCharacterOptions(app, options);
    app.add_option("--motion", motion, "name of the motion to start with");
    app.add_option("--joint", joint, "name of the joint whose ratios b and t show");
    app.add_option("--at", at, "seconds into the motion to start at");
    app.add_flag("--paused", paused, "start paused");
    app.add_option("--keys", keys, "keys to press first; with --pictures, one before each picture");
    CLI::Option* const toFolder =
        app.add_option("--pictures", pictures,
                       "write viewer_00.png, ... to this folder: no window to look at, but an X "
                       "display (Xvfb will do)");
    app.add_flag("--times", times, "with --pictures: say how long each frame and its skin took")
        ->needs(toFolder);
    app.add_option("--width", size.width, "of the window, pixels")->check(CLI::Range(100, 8000));
    app.add_option("--height", size.height, "of the window, pixels")->check(CLI::Range(100, 8000));
    if (!example::hasNoEmptyWord("osgskinviewer", argc, argv)) return 2;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const std::string meant = example::suggestOption(app);
        if (!meant.empty()) std::cerr << "osgskinviewer: unknown option" << meant << std::endl;
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (!(std::abs(at) <= kLatest)) { // also rejects NaN
        std::cerr << "osgskinviewer: --at: expected at most a million seconds" << std::endl;
        return 2;
    }
    try {
        viewer::Stage stage(character, weights, options, size.width, size.height);
        if (!motion.empty()) stage.setMotion(motion);
        if (!joint.empty()) stage.setJoint(joint);
        stage.clock.seek(at);
        stage.clock.playing = !paused;
        if (!pictures.empty()) {
            takePictures(stage, keys, pictures, size, times);
            return example::finish("osgskinviewer", 0);
        }
        for (const char key : keys) viewer::press(stage, key);
        return show(stage, size);
    } catch (const std::exception& error) {
        std::cerr << "osgskinviewer: " << error.what() << std::endl;
        return 1;
    }
}
