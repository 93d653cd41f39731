// SPDX-License-Identifier: MIT
// Measures deformed bodies: ours beside linear blending and dual quaternions with painted weights.
#include "CommandLine.h"
#include "CylinderFigures.h"
#include "FoldFigures.h"
#include "PeopleFigures.h"
#include "Report.h"
#include "RiggerFigures.h"
#include "Subject.h"

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
    std::string heat;
    bool rigger = false;
    std::string motions = OSGSKIN_SHARED_DATA "/cmu/mb";
    std::string json;
    std::string method = "smooth";
    bool noSweeps = false;
    bool shapes = false;
    std::string people;
    std::vector<std::size_t> subjects{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    bool fittedJoints = false;
};

void define(example::CommandLine& line, Options& options) {
    line.add("--body", options.bodies,
             "a body, as often as wanted: one of MakeHuman's by its shape, or a mesh file with "
             "--rig and --weights; default: all six shapes");
    auto rig = line.add("--rig", options.rig, "the skeleton of the mesh file (BVH)");
    auto weights =
        line.add("--weights", options.weights, "the painted weights of the mesh file (JSON)");
    rig.needs(weights);
    weights.needs(rig);
    line.add("--heat", options.heat, "its bone heat weights (JSON)").needs(rig);
    line.add("--motions", options.motions, "the folder of the CMU motions");
    line.add("--bind", options.method, "how our ratios are found")
        .oneOf({"smooth", "paper", "weights"})
        .showDefault();
    const auto json = line.add("--json", options.json, "a file to write the figures to");
    line.add("--shapes", options.shapes,
             "only what shapes do: limbs folded, and the clips, with and without them")
        .excludes(json);
    line.add("--no-sweeps", options.noSweeps, "leave out the sweeps, which take longest");
    line.add("--rigger", options.rigger, "only what a rigger looks at first");
    const auto people = line.add(
        "--people", options.people,
        "only the distance from captured people: the folder of FAUST's scans with 5,000 vertices");
    line.add("--subject", options.subjects, "a person, as often as wanted; default: all of 0 to 9")
        .needs(people);
    line.add("--fitted-joints", options.fittedJoints,
             "people's joints where fitSkeleton() puts them, not where their bodies turn")
        .needs(people);
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
    const std::string shape = shapeOf(files);
    const std::vector<MeasuredSkin> skins =
        makeSkins(files, shape.empty() ? options.heat : makeHumanHeat(shape));
    std::vector<RiggerFigures> figures =
        measureRigger(skins, standardPoses(options.motions, skins.front().subject));
    if (shape.empty()) return figures;
    // The heat weights are for the CMU rig only, which has no finger joints.
    for (const MeasuredSkin& skin : makeSkins(makeHumanFiles(shape, "game_engine"), {}))
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
        printTable(measureShapes(subject, standardPoses(options.motions, subject)), std::cout);
    }
}

void reportPeople(const Options& options) {
    if (options.method == "weights")
        throw std::runtime_error(
            "--people: nobody has painted these bodies, expected --bind smooth "
            "or paper");
    const Ratios ratios = options.method == "paper" ? Ratios::AsPrinted : Ratios::Smooth;
    std::vector<PersonFigures> people;
    for (const std::size_t subject : options.subjects) {
        const CapturedPerson person = readPerson(options.people, subject);
        std::cerr << person.name << '\n';
        people.push_back(
            measurePerson(person, ratios, options.fittedJoints ? Joints::Fitted : Joints::Solved));
    }
    printTable(people, std::cout);
}

void run(const Options& options) {
    if (!options.people.empty()) return reportPeople(options);
    if (options.shapes) return reportShapes(options);
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
    example::CommandLine line(
        "osgskin_quality",
        "Measures deformed bodies: ours beside linear blending and dual quaternions with "
        "painted weights");
    Options options;
    define(line, options);
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);
        run(options);
        return 0;
    });
}
