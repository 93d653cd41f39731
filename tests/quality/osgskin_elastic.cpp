// SPDX-License-Identifier: GPL-3.0-or-later
// Solves the joints of real bodies as elastic solids and prints how close the skins come to them.
#include "CommandLine.h"
#include "ElasticFigures.h"

#include <exception>
#include <iostream>

namespace {

using namespace quality;

SubjectFiles filesOf(const std::string& shape) {
    const std::string makehuman = OSGSKIN_SHARED_DATA "/makehuman/";
    return {makehuman + "body/body4k_" + shape + ".obj", makehuman + "rig/cmu_mb_" + shape + ".bvh",
            makehuman + "weights/body4k_weights_cmu_mb.json"};
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskin_elastic",
        "Elastic shapes of elbow, knee, shoulder and hip, and how far LBS, DQS, the "
        "plain skin and the one with shapes are from them");
    std::vector<std::string> bodies{"neutral", "male"};
    ElasticRun run;
    line.add("--body", bodies, "of MakeHuman's: neutral, male");
    line.add("--joint", run.joints, "joints by their names in the CMU rig");
    line.add("--obj", run.folder, "a folder to write the posed skins to");
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);
        for (const std::string& body : bodies) measureElastic(loadSubject(filesOf(body)), run);
        return 0;
    });
}
