// SPDX-License-Identifier: MIT
// Measures deformed bodies: ours beside linear blending and dual quaternions with painted weights.
#include "CommandLine.h"
#include "CylinderFigures.h"
#include "FoldFigures.h"
#include "Report.h"
#include "RiggerFigures.h"
#include "Subject.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace {

using namespace quality;

struct Options {
    std::vector<std::string> bodies = kShapes;
    std::string rig, weights;
    SkinChoice skins;
    bool rigger = false;
    std::string motions = OSGSKIN_SHARED_DATA "/cmu/mb";
    std::string json;
    std::string method = "smooth";
    bool noSweeps = false;
    std::string shapes;
};

void define(CLI::App& app, Options& options) {
    app.add_option(
        "--body", options.bodies,
        "a body, as often as wanted: one of MakeHuman's by its shape, or a mesh file with "
        "--rig and --weights; default: all six shapes");
    auto* rig = app.add_option("--rig", options.rig, "the skeleton of the mesh file (BVH)");
    auto* weights =
        app.add_option("--weights", options.weights, "the painted weights of the mesh file (JSON)");
    rig->needs(weights);
    weights->needs(rig);
    app.add_option("--heat", options.skins.heat, "its bone heat weights (JSON)")->needs(rig);
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
    app.add_flag("--rigger", options.rigger, "only what a rigger looks at first");
    app.add_flag("--elastic", options.skins.elastic,
                 "a rigger's figures with elastic shapes, too; takes minutes a body");
    app.add_option("--cache", options.skins.cacheFolder, "a folder that keeps elastic shapes");
}

std::vector<SubjectFiles> subjects(const Options& options) {
    const bool isFile = !options.rig.empty();
    if (isFile && options.bodies.size() != 1)
        throw std::runtime_error("--rig: expected one --body, a mesh file");
    std::vector<SubjectFiles> files;
    for (const std::string& body : options.bodies)
        files.push_back(isFile ? SubjectFiles{body, options.rig, options.weights}
                               : makeHumanFiles(body));
    return files;
}

/// Figures of all skins of a body.
std::vector<RiggerFigures> measureRigger(const SubjectFiles& files, const Options& options) {
    SkinChoice choice = options.skins;
    const std::string shape = shapeOf(files);
    if (!shape.empty()) choice.heat = makeHumanHeat(shape);
    const std::vector<MeasuredSkin> skins = makeSkins(files, choice);
    std::vector<RiggerFigures> figures =
        measureRigger(skins, standardPoses(options.motions, skins.front().subject));
    if (shape.empty()) return figures;
    // The heat weights are for the CMU rig only, which has no finger joints.
    choice.heat.clear();
    for (const MeasuredSkin& skin : makeSkins(makeHumanFiles(shape, "game_engine"), choice))
        for (RiggerFigures& entry : figures)
            if (entry.skin == skin.name) entry.fist = measureFist(skin);
    return figures;
}

Report measure(const SubjectFiles& files, const Options& options) {
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
    if (options.rig.empty() && !options.rigger) {
        const std::vector<CylinderPose> cylinder = measureCylinder();
        printTable(cylinder, std::cout);
        json["cylinder"] = toJson(cylinder);
    }
    for (const SubjectFiles& files : subjects(options)) {
        SubjectFiles chosen = files;
        if (options.method == "weights") chosen.ratios = Ratios::Painted;
        if (options.method == "paper") chosen.ratios = Ratios::AsPrinted;
        nlohmann::ordered_json body = {{"body", files.body}};
        if (!options.rigger) {
            const Report report = measure(chosen, options);
            printTable(report, std::cout);
            body = toJson(report);
        }
        const std::vector<RiggerFigures> figures = measureRigger(chosen, options);
        printTable(std::filesystem::path(files.body).stem().string(), figures, std::cout);
        std::cout.flush();
        body["rigger"] = nlohmann::json::array();
        for (const RiggerFigures& skin : figures) body["rigger"].push_back(toJson(skin));
        json["bodies"].push_back(body);
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
