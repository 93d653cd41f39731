// SPDX-License-Identifier: MIT
// Measures bodies that nobody has, made of those that there are: does binding hold its bars there?
#include "../Bars.h"
#include "../FoldFigures.h"
#include "Variations.h"
#include "WorstEdges.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <iostream>

namespace {

using namespace quality;

struct Options {
    std::string motions = OSGSKIN_SHARED_DATA "/cmu/mb";
    std::vector<std::string> only;
    std::string half = "both";
    std::size_t worst = 0;
    std::string shapes;
};

void define(CLI::App& app, Options& options) {
    app.add_option("--motions", options.motions, "the folder of the CMU motions");
    app.add_option("--only", options.only, "only variations with any of these in their names");
    app.add_option("--half", options.half, "only one half of them")
        ->check(CLI::IsMember({"both", "tuned", "held-out"}))
        ->capture_default_str();
    app.add_option("--worst", options.worst, "how many of a body's worst edges to list");
    app.add_option(
           "--shapes", options.shapes,
           "only what shapes do: to pairs of triangles that cut each other, by pose, and to "
           "edges and volumes over the clips")
        ->check(CLI::IsMember({"fast", "elastic"}));
}

PaintedBody sharedBody(const std::string& shape) {
    const std::string makehuman = OSGSKIN_SHARED_DATA "/makehuman/";
    return loadBody(makehuman + "body/body4k_" + shape + ".obj",
                    makehuman + "rig/cmu_mb_" + shape + ".bvh",
                    makehuman + "weights/body4k_weights_cmu_mb.json");
}

/// Without the sweeps and what only pictures need.
Report measure(const Subject& subject, const std::vector<NamedPose>& poses) {
    Report report;
    report.body = subject.name;
    report.vertices = subject.rest.size();
    report.poses = poses.size();
    report.motion = measureStrains(subject, poses);
    report.rigidity = measureRigidity(subject);
    report.wrist = measureWristTwists(subject);
    report.binding = measureBinding(subject);
    report.capping = measureCapping(subject, poses, report.motion[Method::Ours], report.wrist);
    return report;
}

/// The worst and the sum of a figure over a half's bodies, and how many miss its bar.
struct Tally {
    std::string name;
    double worst = 0.0, sum = 0.0;
    std::size_t bodies = 0, missed = 0;
    bool atMost = true;
};

void count(const std::vector<Bar>& all, std::vector<Tally>& tallies) {
    tallies.resize(std::max(tallies.size(), all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
        Tally& tally = tallies[i];
        const bool first = tally.bodies++ == 0;
        tally.name = all[i].name;
        tally.atMost = all[i].atMost;
        const bool worse = all[i].atMost ? all[i].value > tally.worst : all[i].value < tally.worst;
        if (first || worse) tally.worst = all[i].value;
        tally.sum += all[i].value;
        if (!all[i].passed()) ++tally.missed;
    }
}

void print(const std::string& half, const std::vector<Tally>& tallies) {
    if (tallies.empty()) return;
    std::cout << format("\n%s: %zu bodies\n  %-28s%10s%10s%8s\n", half.c_str(), tallies[0].bodies,
                        "", "mean", "worst", "missed");
    for (const Tally& tally : tallies)
        std::cout << format("  %-28s%10.4f%10.4f%8zu\n", tally.name.c_str(),
                            tally.sum / static_cast<double>(tally.bodies), tally.worst,
                            tally.missed);
}

bool isWanted(const std::string& name, const std::vector<std::string>& only) {
    return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& part) {
               return name.find(part) != std::string::npos;
           });
}

/// Calls `take` with each body that is asked for.
template <typename Take>
void forEachBody(const Options& options, Take take) {
    const PaintedBody neutral = sharedBody("neutral"), male = sharedBody("male");
    for (const Variation& variation : variations(neutral, male)) {
        if (!isWanted(variation.name, options.only)) continue;
        if (options.half == (variation.heldOut ? "tuned" : "held-out")) continue;
        PaintedBody body = variation.make();
        body.name = variation.name;
        const Subject subject = makeSubject(std::move(body));
        take(variation, subject, standardPoses(options.motions, subject));
    }
}

void runShapes(const Options& options) {
    std::size_t bodies = 0, missing = 0, poseCount = 0, worse = 0;
    std::cout << format("%-36s%18s%18s%18s%8s  %s\n", options.shapes.c_str(), "pairs, plain; now",
                        "99.9 %, plain; now", "volume", "bytes", "poses over 2 % + 2 pairs");
    forEachBody(options, [&](const Variation& variation, const Subject& subject,
                             const std::vector<NamedPose>& poses) {
        const ShapeFigures figures = measureShapes(subject, poses, options.shapes);
        const PoseFigures &plain = figures.clips.plain, &now = figures.clips.shaped;
        std::cout << format("%-36s%10.2f%8.2f%10.3f%8.3f%10.4f%8.4f%8.1f  %zu",
                            variation.name.c_str(), plain.intersections, now.intersections,
                            plain.percentile999, now.percentile999, plain.volumeError,
                            now.volumeError, figures.bytesPerVertex,
                            figures.clips.worsePoses.size());
        for (const std::string& pose : figures.clips.worsePoses) std::cout << "; " << pose;
        std::cout << std::endl;
        ++bodies;
        poseCount += poses.size();
        worse += figures.clips.worsePoses.size();
        if (!figures.clips.worsePoses.empty()) ++missing;
    });
    std::cout << format("\n%zu of %zu bodies' poses are over in %zu of %zu\n", missing, bodies,
                        worse, poseCount);
}

void run(const Options& options) {
    std::vector<Tally> tuned, heldOut;
    std::cout << format("%-36s%8s%8s%8s%8s%8s  %s\n", "", "/DQS", "/LBS", "99.9 %", "longest",
                        "volume", "bars missed");
    forEachBody(options, [&](const Variation& variation, const Subject& subject,
                             const std::vector<NamedPose>& poses) {
        const std::vector<Bar> all = bars(measure(subject, poses));
        std::cout << format("%-36s%8.3f%8.3f%8.3f%8.3f%8.4f ", variation.name.c_str(), all[0].value,
                            all[1].value, all[2].value, all[3].value, all[4].value);
        for (const Bar& bar : all)
            if (!bar.passed()) std::cout << format(" %s %.3f;", bar.name.c_str(), bar.value);
        std::cout << std::endl;
        count(all, variation.heldOut ? heldOut : tuned);
        const std::vector<WorstEdge> worst = worstEdges(subject, poses);
        for (std::size_t i = 0; i < std::min(options.worst, worst.size()); ++i)
            std::cout << "  " << lineOf(subject, worst[i]) << '\n';
    });
    print("tuned", tuned);
    print("held out", heldOut);
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures bodies made of the two shared ones, beside linear blending and dual "
                 "quaternions with painted weights");
    app.footer("Bars are reported, not enforced. Exit status: 0 done, 1 bad input, 2 bad usage.");
    Options options;
    define(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        options.shapes.empty() ? run(options) : runShapes(options);
    } catch (const std::exception& error) {
        std::cerr << "osgskin_variations: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
