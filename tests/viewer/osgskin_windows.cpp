// SPDX-License-Identifier: MIT
// Shows one character after the other, each in a window of its own that opens and closes, deformed
// by the processor and by compute shaders: for long runs, whose memory must not grow (tests/soak).
#include "CommandLine.h"
#include "MemorySlope.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinGpu/GpuSkin>

#include <osg/observer_ptr>
#include <osgDB/ReadFile>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

#include <chrono>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace {

/// \return false where the file or a window cannot be had, or the character outlives both
bool show(const std::string& file, bool gpu) {
    osg::observer_ptr<osg::Node> seen;
    {
        const osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(file);
        if (!character) return false;
        seen = character;
        if (gpu) osgSkin::setGpu(*character, true);
        osgViewer::Viewer viewer;
        viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
        viewer.setUpViewInWindow(0, 0, 60, 60);
        viewer.setCameraManipulator(new osgGA::TrackballManipulator);
        viewer.setSceneData(character);
        viewer.realize();
        if (!viewer.isRealized()) return false;
        for (int frame = 0; frame < 20; ++frame) viewer.frame(frame / 30.0);
    }
    if (!seen.valid()) return true;
    std::cerr << file << ": the character was not freed" << std::endl;
    return false;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> files;
    double seconds = 0.0, most = std::numeric_limits<double>::infinity();
    example::CommandLine line("osgskin_windows",
                              "Opens and closes windows, with one character after the other.");
    line.add("CHARACTER", files, "anything that osgDB reads").required();
    line.add("--seconds", seconds, "how long; one round at least");
    line.add("--most", most, "fail where memory grows by more kB in a round");
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);

        using Clock = std::chrono::steady_clock;
        const Clock::time_point begin = Clock::now();
        test::MemorySlope memory;
        unsigned int rounds = 0;
        do {
            for (const bool gpu : {false, true})
                for (const std::string& file : files)
                    if (!show(file, gpu)) return 1;
            memory.sample();
            std::cerr << "round " << ++rounds << ": " << memory.last() / 1024.0 << " MB"
                      << std::endl;
        } while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds);
        std::cout << rounds << " rounds of " << 2 * files.size() << " windows; "
                  << memory.last() / 1024.0 << " MB in the end, " << memory.slope() << " kB a round"
                  << std::endl;
        return memory.slope() > most ? 1 : 0;
    });
}
