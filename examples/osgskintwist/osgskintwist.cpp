// SPDX-License-Identifier: MIT
#include "CommandLine.h"
#include "Snapshots.h"
#include "TwistScene.h"
#include "WindowOptions.h"

#include <CLI/CLI.hpp>
#include <osgGA/StateSetManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iosfwd>
#include <iostream>
#include <iterator>
#include <ostream>
#include <string>

namespace twist {

namespace {

constexpr TwistPose kPoses[] = {{0, 0},  {0, 90},  {0, 180}, {0, 270}, {0, 330},  {60, 0},
                                {90, 0}, {120, 0}, {150, 0}, {90, 90}, {60, 180}, {120, 120}};

std::string row(const TwistPose& pose, Method method, const Figures& figures) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "%5.0f %6.0f  %-16s  %7.3f  %7.3f  %7.3f  %7.3f  %7.3f  %7.3f\n", pose.bend,
                  pose.twist, nameOf(method), figures.volume, figures.leastArea, figures.jointArea,
                  figures.bulge, figures.strain.rms, figures.strain.largest);
    return line;
}

/// Prints a table of the three methods' measurements over a set of poses, and the deviation of
/// linear blending from its closed form at the joint.
void printReport(std::ostream& out) {
    Comparison comparison;
    const FigureMaker maker(comparison.cylinder());
    out << "A capped cylinder of radius 1 and length 8 over two bones; against the rest pose.\n\n"
           " bend  twist  method             volume  minimum     area    bulge     edge  longest\n"
           "                                            area  at joint           strain     edge\n";
    double worst = 0.0;
    for (const TwistPose& pose : kPoses) {
        comparison.setPose(pose);
        out << '\n';
        for (const Method method : kMethods) {
            const Figures figures = maker.measure(comparison.positions(method), pose);
            out << row(pose, method, figures);
            if (method == Method::Linear)
                worst = std::max(worst, std::abs(figures.jointArea - linearBlendJointArea(pose)));
        }
    }
    char line[160];
    std::snprintf(line, sizeof line,
                  "\nLinear blending's area at the joint differs from its closed form\n"
                  "(twist: cos^2(angle / 2), bend: cos(angle / 2)) by at most %.1e.\n",
                  worst);
    out << line;
}

} // namespace

} // namespace twist

namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 640;

constexpr twist::TwistPose kPictures[] = {{0, 0},   {0, 90},  {0, 180},   {0, 330}, {90, 0},
                                          {150, 0}, {90, 90}, {120, 120}, {60, 180}};

struct Arguments {
    twist::TwistPose pose;
    bool report = false;
    std::string out; ///< folder
};

void takePictures(twist::TwistScene& scene, const std::string& folder,
                  const example::WindowOptions& window) {
    example::Snapshots snapshots(scene.root(), twist::sceneView(), window.width(), window.height());
    double time = 0.0;
    for (const twist::TwistPose& pose : kPictures) {
        scene.setPose(pose);
        char name[40];
        std::snprintf(name, sizeof name, "/bend%03.0f_twist%03.0f.png", pose.bend, pose.twist);
        snapshots.write(time, folder + name);
        time += 1.0;
    }
    std::cout << std::size(kPictures) << " pictures in " << folder << std::endl;
}

int show(twist::TwistScene& scene, osgViewer::Viewer& viewer,
         const example::WindowOptions& window) {
    const example::View view = twist::sceneView();
    // The copies are measured between frames, when no thread may be drawing them.
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    viewer.setSceneData(scene.root());
    viewer.addEventHandler(new twist::TwistKeys(scene)); // before handlers that use b, t or space
    viewer.addEventHandler(new osgViewer::StatsHandler);
    viewer.addEventHandler(new osgGA::StateSetManipulator(viewer.getCamera()->getStateSet()));
    osg::Camera& camera = *viewer.getCamera();
    camera.setClearColor(osg::Vec4(0.13f, 0.145f, 0.16f, 1.0f));
    camera.setProjectionMatrixAsPerspective(view.fieldOfView,
                                            double(window.width()) / window.height(), 0.1, 1000.0);
    const osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    trackball->setHomePosition(view.eye, view.centre, view.up);
    viewer.setCameraManipulator(trackball);
    window.open(viewer);
    return viewer.run();
}

int run(const Arguments& arguments, osgViewer::Viewer& viewer,
        const example::WindowOptions& window) {
    if (arguments.report) twist::printReport(std::cout);
    if (arguments.report && arguments.out.empty()) return 0;
    twist::TwistScene scene;
    scene.setPose(arguments.pose);
    if (arguments.out.empty()) return show(scene, viewer, window);
    takePictures(scene, arguments.out, window);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskintwist",
        "A cylinder that bends and twists: osgSkin beside linear blending and dual "
        "quaternions.",
        "Press h in the window for its keys. Frames are drawn SingleThreaded.\n" +
            std::string(example::kWindowHelp));
    Arguments arguments;
    line.add("--bend", arguments.pose.bend, "degrees to start with").range(-150.0, 150.0);
    line.add("--twist", arguments.pose.twist, "degrees to start with").range(-330.0, 330.0);
    line.add("--out", arguments.out,
             "write pictures of a set of poses to this folder instead of opening a window");
    line.add("--report", arguments.report, "print the methods' figures; needs no display");
    return line.run(argc, argv, [&] {
        osg::ArgumentParser words(&argc, argv);
        const example::WindowOptions window(words, kWidth, kHeight);
        osgViewer::Viewer viewer(words);
        if (example::hasOsgOptionString())
            throw example::UsageError("-O: no files are read by osgDB");
        if (viewer.getThreadingModel() != osgViewer::Viewer::AutomaticSelection &&
            viewer.getThreadingModel() != osgViewer::Viewer::SingleThreaded)
            throw example::UsageError("expected no threading model but --SingleThreaded");
        line.parse(argc, argv);
        return run(arguments, viewer, window);
    });
}
