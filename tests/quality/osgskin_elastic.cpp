// SPDX-License-Identifier: GPL-3.0-or-later
// Solves the joints of real bodies as elastic solids and prints how close the skins come to them.
#include "ElasticFigures.h"

#include <CLI/CLI.hpp>

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
    CLI::App app("Elastic shapes of elbow, knee, shoulder and hip, and how far LBS, DQS, the "
                 "plain skin and the one with shapes are from them");
    std::vector<std::string> bodies{"neutral", "male"};
    ElasticRun run;
    app.add_option("--body", bodies, "of MakeHuman's: neutral, male");
    app.add_option("--joint", run.joints, "joints by their names in the CMU rig");
    app.add_option("--obj", run.folder, "a folder to write the posed skins to");
    CLI11_PARSE(app, argc, argv);
    try {
        for (const std::string& body : bodies) measureElastic(loadSubject(filesOf(body)), run);
    } catch (const std::exception& error) {
        std::cerr << "osgskin_elastic: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
