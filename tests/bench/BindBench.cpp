// SPDX-License-Identifier: MIT
//
// Measures binding, which happens once per character: time and the process's peak memory by the
// number of vertices.
#include "Subdivide.h"

#include <osgSkinBind/Bind>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Motion>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cstdio>
#include <filesystem>

namespace {

struct Size {
    const char* name;
    const char* body;
    std::uint32_t parts; ///< that every edge is split into
};
const Size kSizes[] = {
    {"4k", "body4k", 1}, {"13k", "body", 1}, {"53k", "body", 2}, {"400k", "body4k", 10}};

const std::string kMakeHuman = std::string(OSGSKIN_SHARED_DATA) + "/makehuman/";

osgSkin::SkinMesh meshOf(const Size& size) {
    osgSkin::SkinMesh body =
        osgSkin::importMesh(kMakeHuman + "body/" + size.body + "_neutral.obj").mesh;
    if (size.parts == 1) return body; // unchanged, with its quads
    const bench::Subdivided fine =
        bench::subdivide(body.triangles(), body.positions.size(), size.parts);
    osgSkin::SkinMesh mesh;
    for (const bench::Blend& vertex : fine.vertices) {
        glm::dvec3& p = mesh.positions.emplace_back(0.0);
        for (std::size_t k = 0; k < 3; ++k) p += vertex.share[k] * body.positions[vertex.corner[k]];
    }
    mesh.faceVertices = fine.triangles;
    mesh.faceSizes.assign(fine.triangles.size() / 3, 3);
    return mesh;
}

void bindBody(benchmark::State& state, const Size& size) {
    const osgSkin::SkinMesh mesh = meshOf(size);
    const osgSkin::RestSkeleton rig =
        osgSkin::importSkeleton(kMakeHuman + "rig/cmu_mb_neutral.bvh");
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(osgSkin::bind(mesh, rig));
    const auto vertices = static_cast<double>(mesh.positions.size());
    state.counters["vertices"] = vertices;
    state.counters["vertices/s"] =
        benchmark::Counter(vertices, benchmark::Counter::kIsIterationInvariantRate);
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    state.counters["peak MB"] = static_cast<double>(use.ru_maxrss) / 1024.0; // of all sizes so far
}

} // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    if (!std::filesystem::exists(kMakeHuman)) {
        std::printf("Nothing to bind: needs %s\n", kMakeHuman.c_str());
        return 0;
    }
    for (const Size& size : kSizes)
        benchmark::RegisterBenchmark((std::string("bind/") + size.name).c_str(), bindBody, size)
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseRealTime();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
