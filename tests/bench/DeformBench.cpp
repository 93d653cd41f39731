// SPDX-License-Identifier: MIT
//
// The cost of one frame of a skin: ours, osgAnimation's software rig, and a plain copy, in one run.
#include "BenchBody.h"
#include "CharacterBench.h"
#include "LoadBench.h"
#include "SomeMorphs.h"
#include "core/SimdTargets.h"

#include <osgSkin/DeformPool>
#include <osgSkin/MorphedRest>
#include <osgSkin/PoseBounds>

#include <benchmark/benchmark.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace bench {

namespace {

/// Prints Google Benchmark's output, then a table of medians: microseconds of processor time per
/// update, nanoseconds per vertex, and ratios to memcpy and to osgAnimation's rig in the same run.
///
/// Benchmarks are named WHAT/SIZE and report their number of vertices as the counter "vertices".
class RatioTable : public benchmark::ConsoleReporter {
public:
    RatioTable() : benchmark::ConsoleReporter(OO_Tabular) {}

    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    struct Row {
        std::string what, size;
        double vertices = 0.0;
        std::vector<double> seconds; ///< of each repetition
        double reportedMedian = 0.0; ///< if only aggregates are reported
        double median() const;
    };
    const Row* find(const std::string& what, const std::string& size) const;

    std::vector<Row> _rows;
};

/// The deformation of the same skins, with which a frame is compared.
std::string aloneOf(const std::string& frame) {
    return frame.find("shapes") == std::string::npos ? "frame, alone" : "frame, fast shapes, alone";
}

double RatioTable::Row::median() const {
    if (seconds.empty()) return reportedMedian;
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

const RatioTable::Row* RatioTable::find(const std::string& what, const std::string& size) const {
    for (const Row& row : _rows)
        if (row.what == what && row.size == size) return &row;
    return nullptr;
}

void RatioTable::ReportRuns(const std::vector<Run>& runs) {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
        const bool isMedian = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
        if ((run.run_type != Run::RT_Iteration && !isMedian) || run.iterations == 0) continue;
        const std::string& name = run.run_name.function_name;
        const std::size_t slash = name.rfind('/');
        if (slash == std::string::npos) continue;
        const std::string what = name.substr(0, slash), size = name.substr(slash + 1);
        auto row = std::find_if(_rows.begin(), _rows.end(),
                                [&](const Row& r) { return r.what == what && r.size == size; });
        if (row == _rows.end()) row = _rows.insert(row, Row{what, size, 0.0, {}, 0.0});
        const auto vertices = run.counters.find("vertices");
        if (vertices != run.counters.end()) row->vertices = vertices->second;
        // Processor time, which other programs on the machine disturb less; for a benchmark with
        // manual timing it is the same.
        const bool manual = !run.run_name.time_type.empty();
        const double seconds = (manual ? run.real_accumulated_time : run.cpu_accumulated_time) /
                               static_cast<double>(run.iterations);
        if (isMedian)
            row->reportedMedian = seconds;
        else
            row->seconds.push_back(seconds);
    }
}

void RatioTable::Finalize() {
    ConsoleReporter::Finalize();
    std::printf("\nMedians, positions and normals, pose set-up included\n"
                "%-42s %8s %12s %10s %12s %18s\n",
                "", "vertices", "us/update", "ns/vertex", "x memcpy", "x osgAnimation");
    for (const Row& row : _rows) {
        const double seconds = row.median();
        std::printf("%-42s ", (row.what + "/" + row.size).c_str());
        if (row.vertices == 0.0) {
            std::printf("%8s %12.2f\n", "", 1e6 * seconds);
            continue;
        }
        std::printf("%8.0f %12.2f %10.2f", row.vertices, 1e6 * seconds,
                    1e9 * seconds / row.vertices);
        const bool isFrame = row.what.rfind("frame, ", 0) == 0;
        const Row* copy = find(isFrame ? aloneOf(row.what) : "memcpy", row.size);
        if (copy) std::printf(" %10.2f x%s", seconds / copy->median(), isFrame ? " alone" : "");
        if (const Row* rig = find(isFrame ? "frame, osgAnimation" : "osgAnimation", row.size))
            std::printf(" %11.1f x faster", rig->median() / seconds);
        std::printf("\n");
    }
}

} // namespace

} // namespace bench

namespace {

struct Size {
    const char* name;
    std::uint32_t parts;
};
const Size kSizes[] = {{"4k", 1}, {"40k", 3}, {"400k", 10}, {"1600k", 20}};

void count(benchmark::State& state, std::size_t vertices) {
    state.counters["vertices"] = static_cast<double>(vertices);
}

void copy(benchmark::State& state, std::uint32_t parts) {
    const bench::Body& body = bench::body(parts);
    std::vector<glm::vec3> positions(body.positions.size()), normals(body.normals.size());
    const std::size_t bytes = body.positions.size() * sizeof(glm::vec3);
    for ([[maybe_unused]] auto iteration : state) {
        std::memcpy(positions.data(), body.positions.data(), bytes);
        std::memcpy(normals.data(), body.normals.data(), bytes);
        benchmark::ClobberMemory();
    }
    count(state, positions.size());
}

/// Ours. `target` is one of Highway's instruction sets, 0 for the best, -1 for the scalar
/// reference.
void ours(benchmark::State& state, std::uint32_t parts, std::int64_t target,
          const osgSkin::DeformPool* pool) {
    const bench::Body& body = bench::body(parts);
    const auto model = body.model();
    osgSkin::Pose pose(model->joints());
    std::vector<glm::vec3> positions(body.positions.size()), normals(body.normals.size());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data();
    job.normals = normals.data();
    job.positionCount = job.normalCount = positions.size();
    if (target > 0) osgSkin::setSimdTargets(target);
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state) {
        const auto& skinning = body.skinning[frame++ % body.skinning.size()];
        pose.set(skinning.data(), skinning.size());
        if (pool)
            pool->run(&job, 1);
        else
            target < 0 ? job.runReference() : job.run();
        benchmark::ClobberMemory();
    }
    osgSkin::setSimdTargets(0);
    count(state, positions.size());
}

/// Ours with and without shapes, and positions alone beside positions with both kinds of normals.
void shapes(benchmark::State& state, std::uint32_t parts, bench::Kind kind, bool withNormals) {
    const bench::Body& body = bench::body(parts, kind);
    const auto model = body.model();
    osgSkin::Pose pose(model->joints());
    std::vector<glm::vec3> positions(body.positions.size()), normals(body.normals.size());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data();
    job.normals = withNormals ? normals.data() : nullptr;
    job.positionCount = job.normalCount = positions.size();
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state) {
        const auto& skinning = body.skinning[frame++ % body.skinning.size()];
        pose.set(skinning.data(), skinning.size());
        job.run();
        benchmark::ClobberMemory();
    }
    count(state, positions.size());
}

/// Ours with five morph targets of a face, whose weights change in every frame or stay.
void morphs(benchmark::State& state, std::uint32_t parts, bench::Kind kind, bool changing) {
    const bench::Body& body = bench::body(parts, kind);
    const auto model = body.model();
    osgSkin::MorphedRest rest(model, test::faceTargets(model->vertexCount(), 5));
    rest.set({0.1f, 0.2f, 0.3f, 0.4f, 0.5f});
    osgSkin::Pose pose(model->joints());
    std::vector<glm::vec3> positions(body.positions.size()), normals(body.normals.size());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.morphed = &rest;
    job.positions = positions.data();
    job.normals = normals.data();
    job.positionCount = job.normalCount = positions.size();
    std::size_t frame = 0;
    std::vector<float> weights(5);
    for ([[maybe_unused]] auto iteration : state) {
        const auto& skinning = body.skinning[frame++ % body.skinning.size()];
        pose.set(skinning.data(), skinning.size());
        for (float& weight : weights) weight = static_cast<float>(frame % 100 + 1) / 101.0f;
        if (changing) rest.set(weights);
        job.run();
        benchmark::ClobberMemory();
    }
    count(state, positions.size());
}

void osgAnimationRig(benchmark::State& state, std::uint32_t parts) {
    const bench::Body& body = bench::body(parts);
    bench::OsgRig rig(body);
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state) {
        rig.pose(frame++ % body.clip.frames);
        const std::clock_t start = std::clock();
        rig.update();
        state.SetIterationTime(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    if (rig.error((frame - 1) % body.clip.frames) > 1e-3)
        state.SkipWithError("osgAnimation's rig did not skin the body");
    count(state, body.positions.size());
}

void poseSetUp(benchmark::State& state) {
    const bench::Body& body = bench::body(1);
    osgSkin::Pose pose(body.binding.joints);
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state) {
        const auto& skinning = body.skinning[frame++ % body.skinning.size()];
        benchmark::DoNotOptimize(pose.set(skinning.data(), skinning.size()));
    }
}

double volumeOf(const glm::vec3& low, const glm::vec3& high) {
    const glm::dvec3 size = high - low;
    return size.x * size.y * size.z;
}

/// Mean volume of the poses' bounds over that of the tight boxes; 0 if a vertex is outside its
/// bounds.
double looseness(const osgSkin::SkinModel& model, const std::vector<osgSkin::Pose>& poses) {
    std::vector<glm::vec3> positions(model.vertexCount());
    osgSkin::DeformJob job;
    job.model = &model;
    job.positions = positions.data();
    job.positionCount = positions.size();
    double sum = 0.0;
    for (const osgSkin::Pose& pose : poses) {
        job.pose = &pose;
        job.run();
        glm::vec3 low = positions.front(), high = low;
        for (const glm::vec3& p : positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(model, pose);
        if (low != glm::max(low, bounds.low) || high != glm::min(high, bounds.high)) return 0.0;
        sum += volumeOf(bounds.low, bounds.high) / volumeOf(low, high);
    }
    return sum / static_cast<double>(poses.size());
}

void poseBounds(benchmark::State& state, bench::Kind kind) {
    const bench::Body& body = bench::body(1, kind);
    const auto model = body.model();
    std::vector<osgSkin::Pose> poses;
    for (const std::vector<glm::dmat4>& skinning : body.skinning) {
        poses.emplace_back(model->joints());
        poses.back().set(skinning.data(), skinning.size());
    }
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(osgSkin::computePoseBounds(*model, poses[frame++ % poses.size()]));
    count(state, body.positions.size());
    state.counters["x tight"] = looseness(*model, poses);
}

/// In the report of any format.
void describe() {
    const bench::Body& body = bench::body(1);
    std::ostringstream line;
    line << body.positions.size() << " vertices, " << body.binding.joints.size() << " joints, "
         << body.partialPerVertex() << " partial joints a vertex, " << body.clip.frames
         << " frames";
    benchmark::AddCustomContext("body " + body.name, line.str());
    benchmark::AddCustomContext("weights for osgAnimation",
                                body.weights.name + ", " +
                                    std::to_string(body.weights.groupCount()) +
                                    " weight groups (interpolated where subdivided)");
}

} // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    describe();
    const std::string joints = std::to_string(bench::body(1).binding.joints.size()) + " joints";
    benchmark::RegisterBenchmark(("pose set-up/" + joints).c_str(), poseSetUp);
    for (const auto& [name, kind] :
         {std::pair("", bench::Kind::Turned), std::pair(", surface normals", bench::Kind::Surface),
          std::pair(", fast shapes", bench::Kind::Shaped)})
        for (const auto& [larger, than] : {std::pair(" to 40k", bench::Larger::FinerMesh),
                                           std::pair(" to twice", bench::Larger::EveryVertexTwice)})
            benchmark::RegisterBenchmark(
                ("set-up share" + std::string(name) + larger + "/4k").c_str(), bench::setUpShare,
                kind, than)
                ->Unit(benchmark::kMicrosecond)
                ->UseManualTime()
                ->Iterations(1); // with many updates in it
    benchmark::RegisterBenchmark("pose bounds/4k", poseBounds, bench::Kind::Turned);
    benchmark::RegisterBenchmark("pose bounds, fast shapes/4k", poseBounds, bench::Kind::Shaped);
    std::vector<std::int64_t> targets;
    for (std::int64_t rest = osgSkin::simdTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1)
        targets.push_back(rest & -rest);
    // A pool uses a second thread only if that pays off: not at 4k.
    const osg::ref_ptr<osgSkin::DeformPool> one = new osgSkin::DeformPool(1);
    const osg::ref_ptr<osgSkin::DeformPool> two = new osgSkin::DeformPool(2);
    for (const Size& size : kSizes) {
        const auto add = [&size](const std::string& what, auto run, auto... more) {
            return benchmark::RegisterBenchmark((what + "/" + size.name).c_str(), run, size.parts,
                                                more...)
                ->Unit(benchmark::kMicrosecond);
        };
        const auto alone = static_cast<const osgSkin::DeformPool*>(nullptr);
        add("memcpy", copy);
        if (size.parts > 10) {
            add("ours", ours, std::int64_t{0}, alone);
        } else {
            for (const std::int64_t target : targets)
                add(std::string("ours ") + hwy::TargetName(target), ours, target, alone);
            add("ours reference", ours, std::int64_t{-1}, alone);
            add("osgAnimation", osgAnimationRig)->UseManualTime();
        }
        if (size.parts <= 10) {
            add("positions", shapes, bench::Kind::Turned, false);
            add("positions, fast shapes", shapes, bench::Kind::Shaped, false);
            add("normals, turned", shapes, bench::Kind::Turned, true);
            add("normals of the surface", shapes, bench::Kind::Surface, true);
            add("normals, fast shapes", shapes, bench::Kind::Shaped, true);
            add("morphs, fast shapes", morphs, bench::Kind::Shaped, false);
            add("changing morphs, fast shapes", morphs, bench::Kind::Shaped, true);
        }
        add("ours, 1 thread", ours, std::int64_t{0}, one.get())->UseRealTime();
        add("ours, 2 threads", ours, std::int64_t{0}, two.get())->UseRealTime();
    }
    for (const unsigned int threads : {1u, 2u})
        benchmark::RegisterBenchmark(("crowd, " + std::to_string(threads) +
                                      (threads == 1 ? " thread" : " threads") + "/1000")
                                         .c_str(),
                                     bench::crowd, threads)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
    // The paper's model, and the characters' default.
    for (const auto& [frame, kind] : {std::pair("frame, ", bench::Kind::Turned),
                                      std::pair("frame, fast shapes, ", bench::Kind::Shaped)}) {
        const auto add = [name = std::string(frame)](const char* what, auto run, auto... more) {
            benchmark::RegisterBenchmark((name + what + "/20").c_str(), run, more...)
                ->Unit(benchmark::kMicrosecond);
        };
        add("alone", bench::deformationAlone, kind);
        add("baked", bench::characters, bench::Player::Baked, kind);
        add("baked, between", bench::characters, bench::Player::Between, kind);
        add("sampled", bench::characters, bench::Player::Sampled, kind);
        add("skeleton", bench::characters, bench::Player::Skeleton, kind);
    }
    benchmark::RegisterBenchmark("frame, osgAnimation/20", bench::characters,
                                 bench::Player::OsgAnimation, bench::Kind::Turned)
        ->Unit(benchmark::kMicrosecond);
    bench::addLayers();
    bench::addLive();
    bench::addHits();
    bench::addLoads();
    bench::addLoadedFrames();
    bench::addWalkers();
    bench::RatioTable table;
    // Google Benchmark's own reporters write JSON and CSV, to which a table would not belong.
    const bool isConsole =
        dynamic_cast<benchmark::ConsoleReporter*>(benchmark::CreateDefaultDisplayReporter());
    benchmark::RunSpecifiedBenchmarks(isConsole ? &table : nullptr);
    return 0;
}
