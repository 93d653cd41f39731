// SPDX-License-Identifier: MIT

// osgskin_generate_throw OUTDIR [--check]
//
// Writes thrower.bvh (the rig), throw.bvh and ball.bvh, and prints the achieved and the published
// angles. With --check it reads the files back and exits with 1 if the throw lacks a property that
// the demo relies on.

#include "BvhWriter.h"
#include "ThrowBall.h"
#include "ThrowCheck.h"
#include "ThrowMotion.h"
#include "ThrowReport.h"
#include "ThrowTiming.h"

#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

using namespace mannequin;

void writeFile(const std::string& path, const std::function<void(std::ostream&)>& write) {
    std::ofstream out(path, std::ios::binary);
    write(out);
    out.close();
    if (!out) throw std::runtime_error("cannot write " + path);
}

std::vector<BvhRow> readFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path);
    return readRows(in);
}

int run(const std::string& folder, bool check) {
    const Skeleton skeleton;
    const ThrowMotion motion(skeleton);
    std::vector<Pose> poses;
    poses.reserve(kFrameCount);
    for (int frame = 0; frame < kFrameCount; ++frame)
        poses.push_back(motion.poseAt(frameTime(frame)));

    const std::string rigPath = folder + "/thrower.bvh";
    const std::string bodyPath = folder + "/throw.bvh";
    const std::string ballPath = folder + "/ball.bvh";
    writeFile(rigPath, [&](std::ostream& out) { writeRig(out, skeleton); });
    writeFile(bodyPath, [&](std::ostream& out) { writeMotion(out, skeleton, bvhRows(poses)); });
    writeFile(ballPath, [&](std::ostream& out) { writeBall(out, ballRows(skeleton, motion)); });

    printReport(std::cout, measureFrames(skeleton, poses),
                launchOf(motion.gripVelocityAt(kRelease)));
    if (!check) return 0;
    return checkThrow(std::cout, skeleton, readFile(bodyPath), readFile(ballPath)) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    const std::string option = argc == 3 ? argv[2] : "";
    if (argc < 2 || argc > 3 || argv[1][0] == '-' || argv[1][0] == '\0' ||
        (argc == 3 && option != "--check")) {
        std::cerr << "usage: osgskin_generate_throw OUTDIR [--check]\n";
        return 2;
    }
    try {
        return run(argv[1], option == "--check");
    } catch (const std::exception& error) {
        std::cerr << "osgskin_generate_throw: " << error.what() << "\n";
        return 2;
    }
}
