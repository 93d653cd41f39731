// SPDX-License-Identifier: MIT
// Measures deformed bodies: ours beside linear blending and dual quaternions with painted weights.
#include "Bars.h"
#include "CommandLine.h"
#include "CylinderReport.h"
#include "FoldFigures.h"
#include "Json.h"
#include "Table.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace {

using namespace quality;

struct Options {
    SubjectFiles files;
    std::string motions = OSGSKIN_SHARED_DATA "/cmu/mb";
    std::string json;
    std::string method = "smooth";
    bool noSweeps = false;
    std::string shapes;
};

void define(CLI::App& app, Options& options) {
    auto* body = app.add_option("--body", options.files.body,
                                "a body mesh, in place of the cylinder and the two bodies");
    auto* rig = app.add_option("--rig", options.files.rig, "its skeleton (BVH)");
    auto* weights =
        app.add_option("--weights", options.files.weights, "its painted weights (JSON)");
    body->needs(rig)->needs(weights);
    rig->needs(body);
    weights->needs(body);
    app.add_option("--motions", options.motions, "the folder of the CMU motions");
    app.add_option("--bind", options.method, "how our ratios are found")
        ->check(CLI::IsMember({"smooth", "paper", "weights"}))
        ->capture_default_str();
    auto* json = app.add_option("--json", options.json, "a file to write the figures to");
    app.add_option("--shapes", options.shapes,
                   "only what shapes do: limbs folded, and the clips, with and without them")
        ->check(CLI::IsMember({"fast", "elastic"}))
        ->excludes(json);
    app.add_flag("--no-sweeps", options.noSweeps, "leave out the sweeps, which take longest");
}

std::vector<SubjectFiles> subjects(const Options& options) {
    if (!options.files.body.empty()) return {options.files};
    const std::string makehuman = OSGSKIN_SHARED_DATA "/makehuman/";
    std::vector<SubjectFiles> files;
    for (const std::string shape : {"neutral", "male"}) {
        SubjectFiles& entry = files.emplace_back();
        entry.body = makehuman;
        entry.body.append("body/body4k_").append(shape).append(".obj");
        entry.rig = makehuman;
        entry.rig.append("rig/cmu_mb_").append(shape).append(".bvh");
        entry.weights = makehuman + "weights/body4k_weights_cmu_mb.json";
    }
    return files;
}

Report measure(SubjectFiles files, const Options& options) {
    if (options.method == "weights") files.ratios = Ratios::Painted;
    if (options.method == "paper") files.ratios = Ratios::AsPrinted;
    const Subject subject = loadSubject(files);
    const std::vector<NamedPose> poses = standardPoses(options.motions, subject);
    Report report;
    report.body = subject.name;
    report.vertices = subject.rest.size();
    report.poses = poses.size();
    report.motion = measurePoses(subject, poses);
    report.rigidity = measureRigidity(subject);
    report.wrist = measureWristTwists(subject);
    report.binding = measureBinding(subject);
    report.capping = measureCapping(subject, poses, report.motion[Method::Ours], report.wrist);
    if (!options.noSweeps) {
        std::cerr << subject.name << ": sweeping every joint\n";
        report.continuity = measureContinuity(subject);
    }
    return report;
}

void reportShapes(const Options& options) {
    for (const SubjectFiles& files : subjects(options)) {
        const Subject subject = loadSubject(files);
        std::cout << subject.name << '\n';
        printTable(measureShapes(subject, standardPoses(options.motions, subject), options.shapes),
                   std::cout);
    }
}

void run(const Options& options) {
    if (!options.shapes.empty()) return reportShapes(options);
    nlohmann::ordered_json json = {{"bind", options.method}, {"bodies", nlohmann::json::array()}};
    if (options.files.body.empty()) {
        const std::vector<CylinderPose> cylinder = measureCylinder();
        printTable(cylinder, std::cout);
        json["cylinder"] = toJson(cylinder);
    }
    for (const SubjectFiles& files : subjects(options)) {
        const Report report = measure(files, options);
        printTable(report, std::cout);
        std::cout.flush();
        json["bodies"].push_back(toJson(report));
    }
    if (options.json.empty()) return;
    std::ofstream out(options.json);
    out << json.dump(2) << '\n';
    if (!out.flush()) throw std::runtime_error(options.json + ": cannot be written");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures deformed bodies: ours beside linear blending and dual quaternions with "
                 "painted weights");
    app.footer("Bars are reported, not enforced. Exit status: 0 done, 1 bad input, 2 bad usage.");
    Options options;
    define(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        run(options);
    } catch (const std::exception& error) {
        std::cerr << "osgskin_quality: " << error.what() << '\n';
        return 1;
    }
    return example::finish("osgskin_quality", 0);
}
