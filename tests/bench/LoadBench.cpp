// SPDX-License-Identifier: MIT
#include "LoadBench.h"

#include "CullFrame.h"
#include "LoadedFile.h"

#include <osgSkin/DeformPool>
#include <osgSkin/DeformableSkin>
#include <osgSkin/ParallelDeformCallback>

#include <benchmark/benchmark.h>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osgAnimation/BasicAnimationManager>

#include <chrono>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

namespace bench {

namespace {

const char* const kThrower = OSGSKIN_DATA "/thrower.skin";

const std::string& saved() {
    static const SavedFile thrower(*load(kThrower));
    return thrower.path;
}

const std::string& savedMerged() {
    static const SavedFile thrower(*load(kThrower, "rigid=merged"));
    return thrower.path;
}

/// Nothing of the file is alive; the plug-ins are loaded.
void loadFirst(benchmark::State& state, bool isSaved) {
    const std::string file = isSaved ? saved() : kThrower;
    load(file);
    for ([[maybe_unused]] auto iteration : state) load(file);
}

/// A character of the same file is alive.
void loadAgain(benchmark::State& state) {
    const osg::ref_ptr<osg::Node> first = load(saved());
    for ([[maybe_unused]] auto iteration : state) load(saved());
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

/// A thousand characters of one file, beside as many copies of its skin, which have a pose and
/// buffers of their own.
void memory(benchmark::State& state) {
    constexpr std::size_t kCharacters = 1000;
    for ([[maybe_unused]] auto iteration : state) {
        const osg::ref_ptr<osg::Node> first = load(saved());
        std::vector<osg::ref_ptr<osg::Referenced>> all;
        all.reserve(2 * kCharacters);
        const double before = allocated();
        for (std::size_t i = 0; i < kCharacters; ++i) all.emplace_back(load(saved()));
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

/// How the characters are loaded and played.
struct Mode {
    unsigned int threads = 0; ///< of a ParallelDeformCallback; 0: none
    bool sharesModel = false; ///< copies of one character in place of loads
    bool merged = false;      ///< rigid parts merged into the skin
};

/// Characters that were loaded from one file, each in its own phase.
class Scene {
public:
    Scene(std::size_t count, const Mode& mode) {
        constexpr double kPhase = 0.37; // seconds from one to the next
        osg::ref_ptr<osg::Node> first;
        std::vector<osgAnimation::BasicAnimationManager*> managers;
        const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(double(count))));
        for (std::size_t i = 0; i < count; ++i) {
            osg::ref_ptr<osg::Node> character;
            if (first && mode.sharesModel)
                character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES |
                                                        osg::CopyOp::DEEP_COPY_CALLBACKS |
                                                        osg::CopyOp::DEEP_COPY_DRAWABLES);
            else
                character = load(mode.merged ? savedMerged() : saved());
            if (!first) first = character;
            const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
                osg::Matrix::translate(2.0 * double(i % columns), 2.0 * double(i / columns), 0.0));
            place->addChild(character);
            _scene->addChild(place);
            managers.push_back(
                dynamic_cast<osgAnimation::BasicAnimationManager*>(character->getUpdateCallback()));
        }
        if (mode.threads > 0)
            _scene->setUpdateCallback(
                new osgSkin::ParallelDeformCallback(new osgSkin::DeformPool(mode.threads)));
        _skins = skinsOf(*_scene);
        frame.update();
        for (std::size_t i = 0; i < count; ++i)
            managers[i]->getAnimationList().front()->setStartTime(-kPhase * double(i));
        frame.warmUp();
    }

    double vertices() const {
        double result = 0.0;
        for (const osgSkin::DeformableSkin* skin : _skins)
            result += double(skin->getModel()->vertexCount());
        return result;
    }
    void deform() const {
        for (osgSkin::DeformableSkin* skin : _skins) skin->getDeformedGeometry();
    }

private:
    osg::ref_ptr<osg::Group> _scene = new osg::Group;
    std::vector<osgSkin::DeformableSkin*> _skins;

public:
    CullFrame frame{*_scene};
};

/// Seconds of this thread's processor time, or of the clock where other threads work, too.
double now(bool isThreaded) {
    if (isThreaded)
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

void loadedFrames(benchmark::State& state, Mode mode, std::size_t count) {
    Scene scene(count, mode);
    double update = 0.0, deform = 0.0, cull = 0.0;
    for ([[maybe_unused]] auto iteration : state) {
        const double start = now(mode.threads > 0);
        scene.frame.update();
        const double updated = now(mode.threads > 0) - start;
        scene.deform();
        const double deformed = now(mode.threads > 0) - start;
        scene.frame.cull();
        const double culled = now(mode.threads > 0) - start;
        update += updated;
        deform += deformed - updated;
        cull += culled - deformed;
        state.SetIterationTime(culled);
    }
    const double frames = 1e-6 * double(state.iterations()) * double(count);
    state.counters["update us"] = update / frames;
    state.counters["deform us"] = deform / frames;
    state.counters["cull us"] = cull / frames;
    if (mode.threads == 0) {
        state.counters["update x"] = update / deform;
        state.counters["cull x"] = cull / deform;
    }
    state.counters["vertices"] = scene.vertices();
}

} // namespace

void addLoads() {
    const auto add = [](const char* name, auto run, auto... more) {
        return benchmark::RegisterBenchmark(name, run, more...)->Unit(benchmark::kMillisecond);
    };
    add("load/saved, first", loadFirst, true);
    add("load/saved, again", loadAgain);
    add("load/.skin", loadFirst, false);
    add("load/memory of 1000", memory)->Iterations(1);
}

void addLoadedFrames() {
    for (const std::size_t count : {20u, 100u, 1000u})
        for (const auto& [name, mode] : {std::pair("one thread", Mode{}),
                                         {"parts merged", Mode{0, false, true}},
                                         {"2 threads", Mode{2}},
                                         {"copies", Mode{0, true}},
                                         {"copies, 2 threads", Mode{2, true}}})
            benchmark::RegisterBenchmark(
                ("frame of loaded, " + std::string(name) + "/" + std::to_string(count)).c_str(),
                loadedFrames, mode, count)
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
}

} // namespace bench
