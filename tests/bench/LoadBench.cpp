// SPDX-License-Identifier: MIT
//
// Loading a saved character: processor time and memory. And its frames, with rigid parts as nodes
// below bones and merged into the skin: update and cull traversals, deformation included; nothing
// is drawn.
#include <osgSkin/DeformableSkin>

#include <benchmark/benchmark.h>
#include <osg/FrameStamp>
#include <osg/Group>
#include <osg/NodeVisitor>
#include <osg/ref_ptr>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

#include <malloc.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

namespace {

std::string saved, savedMerged; ///< the thrower as .osgb, and with rigid=merged

osg::ref_ptr<osg::Node> load(const std::string& file, osgDB::Options* options = nullptr) {
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, options);
    if (!node) {
        std::cerr << "osgskin_load_bench: cannot read " << file
                  << "; OSG_LIBRARY_PATH must name the plug-ins' folder\n";
        std::exit(1);
    }
    return node;
}

/// Nothing of the file is alive; the plug-ins are loaded.
void loadFirst(benchmark::State& state, const std::string& file) {
    load(file);
    for ([[maybe_unused]] auto iteration : state) load(file);
}

/// A character of the same file is alive.
void loadAgain(benchmark::State& state) {
    const osg::ref_ptr<osg::Node> first = load(saved);
    for ([[maybe_unused]] auto iteration : state) load(saved);
}

std::vector<osgSkin::DeformableSkin*> skinsOf(osg::Node& scene) {
    struct Visitor : osg::NodeVisitor {
        Visitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Drawable& drawable) override {
            if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable))
                found.push_back(skin);
        }
        std::vector<osgSkin::DeformableSkin*> found;
    } visitor;
    scene.accept(visitor);
    return visitor.found;
}

double allocated() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

/// A thousand characters of one file, beside as many copies of its skin, which have a pose and
/// buffers of their own.
void memory(benchmark::State& state) {
    constexpr std::size_t kCharacters = 1000;
    for ([[maybe_unused]] auto iteration : state) {
        const osg::ref_ptr<osg::Node> first = load(saved);
        std::vector<osg::ref_ptr<osg::Referenced>> all;
        all.reserve(2 * kCharacters);
        const double before = allocated();
        for (std::size_t i = 0; i < kCharacters; ++i) all.emplace_back(load(saved));
        const double between = allocated();
        for (std::size_t i = 0; i < kCharacters; ++i)
            for (osgSkin::DeformableSkin* skin : skinsOf(*first))
                all.emplace_back(osg::clone(skin, osg::CopyOp::SHALLOW_COPY));
        const double after = allocated();
        state.counters["kB each"] = 1e-3 * (between - before) / kCharacters;
        state.counters["kB pose and buffers"] = 1e-3 * (after - between) / kCharacters;
        state.counters["ratio"] = (between - before) / (after - between);
    }
}

/// A frame of a hundred characters that were loaded one by one.
class Frames {
public:
    explicit Frames(bool merged) {
        for (int i = 0; i < 100; ++i) _scene->addChild(load(merged ? savedMerged : saved));
        _update->setFrameStamp(_stamp);
        _cull->setFrameStamp(_stamp);
        for (int i = 0; i < 3; ++i) { // these frames still allocate
            update();
            cull();
        }
    }

    void update() {
        _stamp->setFrameNumber(++_frame);
        _stamp->setSimulationTime(_frame / 60.0);
        _update->setTraversalNumber(_frame);
        _scene->accept(*_update);
        _bound = _scene->getBound();
    }

    void cull() {
        const double r = 1.2 * static_cast<double>(_bound.radius());
        _graph->clean();
        _stage->reset();
        _cull->reset();
        _cull->setTraversalNumber(_frame);
        _cull->setStateGraph(_graph);
        _cull->setRenderStage(_stage);
        _cull->pushViewport(_viewport);
        _cull->pushProjectionMatrix(new osg::RefMatrix(osg::Matrix::ortho(-r, r, -r, r, 0, 4 * r)));
        const osg::Vec3d centre = _bound.center();
        _cull->pushModelViewMatrix(
            new osg::RefMatrix(
                osg::Matrix::lookAt(centre + osg::Vec3d(0, 0, 2 * r), centre, osg::Vec3d(0, 1, 0))),
            osg::Transform::ABSOLUTE_RF);
        _scene->accept(*_cull);
        _cull->popModelViewMatrix();
        _cull->popProjectionMatrix();
        _cull->popViewport();
    }

private:
    osg::ref_ptr<osg::Group> _scene = new osg::Group;
    osg::BoundingSphere _bound;
    osg::ref_ptr<osg::FrameStamp> _stamp = new osg::FrameStamp;
    osg::ref_ptr<osgUtil::UpdateVisitor> _update = new osgUtil::UpdateVisitor;
    osg::ref_ptr<osgUtil::CullVisitor> _cull = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> _graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> _stage = new osgUtil::RenderStage;
    osg::ref_ptr<osg::Viewport> _viewport = new osg::Viewport(0, 0, 1000, 800);
    unsigned int _frame = 0;
};

void updates(benchmark::State& state, bool merged) {
    Frames frames(merged);
    for ([[maybe_unused]] auto iteration : state) frames.update();
}

void culls(benchmark::State& state, bool merged) {
    Frames frames(merged);
    for ([[maybe_unused]] auto iteration : state) {
        state.PauseTiming();
        frames.update();
        state.ResumeTiming();
        frames.cull();
    }
}

} // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    const std::string skin = OSGSKIN_DATA "/thrower.skin";
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    saved = (folder / "osgskin_load_bench.osgb").string();
    savedMerged = (folder / "osgskin_load_bench_merged.osgb").string();
    const osg::ref_ptr<osgDB::Options> merged = new osgDB::Options("rigid=merged");
    if (!osgDB::writeNodeFile(*load(skin), saved) ||
        !osgDB::writeNodeFile(*load(skin, merged), savedMerged))
        return 1;
    const auto add = [](const char* name, auto run, auto... more) {
        return benchmark::RegisterBenchmark(name, run, more...)
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime();
    };
    add("load/saved, first", loadFirst, saved);
    add("load/saved, again", loadAgain);
    add("load/.skin", loadFirst, skin);
    add("update of 100/parts below bones", updates, false);
    add("update of 100/merged parts", updates, true);
    add("cull of 100/parts below bones", culls, false);
    add("cull of 100/merged parts", culls, true);
    add("memory of 1000", memory)->Iterations(1);
    benchmark::RunSpecifiedBenchmarks();
    std::filesystem::remove(saved);
    std::filesystem::remove(savedMerged);
    return 0;
}
