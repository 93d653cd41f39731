// SPDX-License-Identifier: MIT
#include "CullFrame.h"
#include "LoadBench.h"
#include "LoadedFile.h"

#include <osgSkin/CharacterGroup>
#include <osgSkin/DeformPool>
#include <osgSkinMotion/MakeWalker>

#include <benchmark/benchmark.h>
#include <osg/Geode>
#include <osg/MatrixTransform>
#include <osg/Shape>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace bench {
namespace {

constexpr std::size_t kWalkers = 1000;

/// The walker that osgskinbake makes of data/pedestrian.skin.
const std::string& savedWalker() {
    static const SavedFile walker(
        *osgSkin::makeWalker(*load(OSGSKIN_DATA "/pedestrian.skin", "colours=merged")),
        "WriteImageHint=IncludeData Compressor=zlib");
    return walker.path;
}

/// A copy as esmini makes it.
osg::ref_ptr<osg::Node> copyOf(const osg::Node& walker) {
    return osg::clone(&walker, osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_DRAWABLES |
                                   osg::CopyOp::DEEP_COPY_STATESETS |
                                   osg::CopyOp::DEEP_COPY_STATEATTRIBUTES);
}

/// Pedestrians who go round in circles, a fifth of them standing, between as many boxes.
class Street {
public:
    explicit Street(const osg::ref_ptr<osg::Group>& people) : _people(people) {
        const osg::ref_ptr<osg::Node> walker = load(savedWalker());
        const osg::ref_ptr<osg::Geode> box = new osg::Geode;
        box->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.5f)));
        for (std::size_t i = 0; i < kWalkers; ++i) {
            const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
            place->addChild(copyOf(*walker));
            _people->addChild(place);
            _places.push_back(place);
            const osg::ref_ptr<osg::MatrixTransform> corner = new osg::MatrixTransform(
                osg::Matrix::translate(2.0 * double(i % 32) + 1.0, 2.0 * double(i / 32), 0.0));
            corner->addChild(box);
            _scene->addChild(corner);
        }
        _scene->addChild(_people);
        for (int i = 0; i < 60; ++i) show(); // until all have found their gait
    }

    /// Moves all, and updates, deforms and culls.
    /// \return seconds, without the moving
    double show() {
        _time += 1.0 / 60.0;
        for (std::size_t i = 0; i < kWalkers; ++i) {
            const double speed = 0.5 * double(i % 5), radius = 1.5, at = speed / radius * _time;
            _places[i]->setMatrix(
                osg::Matrix::rotate(at + osg::PI_2, osg::Vec3d(0, 0, 1)) *
                osg::Matrix::translate(2.0 * double(i % 32) + radius * std::cos(at),
                                       2.0 * double(i / 32) + radius * std::sin(at), 0.0));
        }
        const auto start = std::chrono::steady_clock::now();
        _frame.update();
        update = secondsSince(start);
        _frame.cull();
        return secondsSince(start);
    }

    double update = 0.0; ///< seconds of the last one

private:
    static double secondsSince(std::chrono::steady_clock::time_point start) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    const osg::ref_ptr<osg::Group> _people;
    const osg::ref_ptr<osg::Group> _scene = new osg::Group;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> _places;
    CullFrame _frame{*_scene};
    double _time = 0.0;
};

double median(std::vector<double> of) {
    std::sort(of.begin(), of.end());
    return of[of.size() / 2];
}

/// Frames of one street and another in turn.
void frames(benchmark::State& state, unsigned int threads) {
    const osg::ref_ptr<osgSkin::CharacterGroup> group = new osgSkin::CharacterGroup;
    group->setPool(new osgSkin::DeformPool(threads));
    Street grouped(group), plain(new osg::Group);
    std::vector<double> with, without, ratios, updates;
    for ([[maybe_unused]] auto iteration : state) {
        with.push_back(grouped.show());
        without.push_back(plain.show());
        ratios.push_back(with.back() / without.back());
        updates.push_back(plain.update);
        state.SetIterationTime(with.back());
    }
    state.counters["group ms"] = 1e3 * median(with);
    state.counters["any group ms"] = 1e3 * median(without);
    state.counters["update us"] = 1e6 * median(updates) / double(kWalkers);
    state.counters["ratio"] = median(ratios);
}

/// Nothing of the file is alive; the plug-ins are loaded.
void loadWalker(benchmark::State& state) {
    load(savedWalker());
    for ([[maybe_unused]] auto iteration : state) load(savedWalker());
}

void memory(benchmark::State& state) {
    const osg::ref_ptr<osg::Node> first = load(savedWalker());
    for ([[maybe_unused]] auto iteration : state) {
        std::vector<osg::ref_ptr<osg::Node>> all(kWalkers);
        const double before = allocated();
        for (osg::ref_ptr<osg::Node>& each : all) each = copyOf(*first);
        state.counters["kB each"] = 1e-3 * (allocated() - before) / double(kWalkers);
    }
    state.counters["file kB"] = 1e-3 * double(std::filesystem::file_size(savedWalker()));
}

} // namespace

void addWalkers() {
    const auto add = [](const char* name, auto run, auto... more) {
        return benchmark::RegisterBenchmark(name, run, more...)->Unit(benchmark::kMillisecond);
    };
    add("walkers/load", loadWalker);
    add("walkers/memory of 1000", memory)->Iterations(1);
    add("walkers/1000 in a street, one thread", frames, 1U)->UseManualTime();
    add("walkers/1000 in a street, 2 threads", frames, 2U)->UseManualTime();
}

} // namespace bench
