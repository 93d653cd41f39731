// SPDX-License-Identifier: MIT
#include "CullFrame.h"
#include "LoadBench.h"
#include "LoadedFile.h"

#include <osgSkin/CharacterGroup>
#include <osgSkin/DeformPool>
#include <osgSkinMotion/MakeWalker>

#include <benchmark/benchmark.h>
#include <osg/MatrixTransform>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace bench {
namespace {

constexpr std::size_t kWalkers = 1000; ///< of the memory of copies

/// The walker that osgskinbake makes of data/pedestrian.skin.
const std::string& savedWalker() {
    static const SavedFile walker(
        *osgSkin::makeWalker(*load(OSGSKIN_DATA "/pedestrian.skin", "colours=merged")),
        "WriteImageHint=IncludeData Compressor=zlib");
    return walker.path;
}

/// A copy as esmini makes it, with callbacks of its own: copies that share them show one pose.
osg::ref_ptr<osg::Node> copyOf(const osg::Node& walker) {
    return osg::clone(&walker, osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_DRAWABLES |
                                   osg::CopyOp::DEEP_COPY_CALLBACKS |
                                   osg::CopyOp::DEEP_COPY_STATESETS |
                                   osg::CopyOp::DEEP_COPY_STATEATTRIBUTES);
}

/// How many people a camera at street level sees, and how far they are.
struct Place {
    std::size_t people;
    double nearest, farthest; ///< m
};

/// With 60 degrees and 1,080 lines, 3 % are higher than 100 pixels.
constexpr double kFarthest = 97.0;
constexpr Place kStreet{1000, 2.0, kFarthest}, kCity{10000, 2.0, kFarthest};
/// All are higher than 300 pixels.
constexpr Place kClose{1000, 3.5, 4.9};

double processSeconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

/// People who go round in small circles, a fifth of them standing, evenly spread over what the
/// camera sees.
class Street {
public:
    Street(const osg::ref_ptr<osg::Group>& people, const osg::Node& person, const Place& place)
        : _people(people) {
        const double before = allocated();
        for (std::size_t i = 0; i < place.people; ++i) {
            const double share = (double(i) + 0.5) / double(place.people);
            const double near2 = place.nearest * place.nearest;
            const double away =
                std::sqrt(near2 + share * (place.farthest * place.farthest - near2));
            const double at = 0.618034 * double(i), side = 1.4 * (at - std::floor(at)) - 0.7;
            const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
            transform->setDataVariance(osg::Object::DYNAMIC);
            transform->addChild(copyOf(person));
            _people->addChild(transform);
            _places.push_back(transform);
            _centres.emplace_back(away * std::sin(side), away * std::cos(side), 0.0);
        }
        _radius = std::min(1.5, 0.1 * (place.nearest + place.farthest));
        _scene->addChild(_people);
        for (int i = 0; i < 60; ++i) show(); // until all have found their gait
        bytes = (allocated() - before) / double(place.people);
    }

    /// Moves all, and updates, deforms and culls.
    /// \return seconds of processor time, without the moving
    double show() {
        _time += 1.0 / 60.0;
        for (std::size_t i = 0; i < _places.size(); ++i) {
            const double speed = 0.5 * double(i % 5), at = speed / _radius * _time;
            _places[i]->setMatrix(
                osg::Matrix::rotate(at + osg::PI_2, osg::Vec3d(0, 0, 1)) *
                osg::Matrix::translate(
                    _centres[i] + osg::Vec3d(_radius * std::cos(at), _radius * std::sin(at), 0.0)));
        }
        const auto start = std::chrono::steady_clock::now();
        const double before = processSeconds();
        _frame.update();
        update = processSeconds() - before;
        _frame.cull(osg::Matrix::perspective(60.0, 16.0 / 9.0, 0.1, 500.0),
                    osg::Matrix::lookAt(osg::Vec3d(0, 0, 1.7), osg::Vec3d(0, 50, 1.0),
                                        osg::Vec3d(0, 0, 1)));
        wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return processSeconds() - before;
    }

    double update = 0.0, wall = 0.0; ///< seconds of the last one: processor time, and both threads'
    double bytes = 0.0;              ///< of the heap, each

private:
    const osg::ref_ptr<osg::Group> _people;
    const osg::ref_ptr<osg::Group> _scene = new osg::Group;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> _places;
    std::vector<osg::Vec3d> _centres;
    CullFrame _frame{*_scene, 1920, 1080};
    double _radius = 1.5, _time = 0.0;
};

double median(std::vector<double> of) {
    std::sort(of.begin(), of.end());
    return of[of.size() / 2];
}

/// Frames of a street of one figure in a CharacterGroup, or in any group.
/// \param threads of the group; 0: any group
void frames(benchmark::State& state, const std::string& file, const Place& place,
            unsigned int threads) {
    osg::ref_ptr<osg::Group> people = new osg::Group;
    if (threads > 0) {
        const osg::ref_ptr<osgSkin::CharacterGroup> group = new osgSkin::CharacterGroup;
        group->setPool(new osgSkin::DeformPool(threads));
        people = group;
    }
    Street street(people, *load(file.empty() ? savedWalker() : file), place);
    std::vector<double> all, updates, walls;
    for ([[maybe_unused]] auto iteration : state) {
        all.push_back(street.show());
        updates.push_back(street.update);
        walls.push_back(street.wall);
        state.SetIterationTime(all.back());
    }
    state.counters["processor ms"] = 1e3 * median(all);
    state.counters["update ms"] = 1e3 * median(updates);
    state.counters["wall ms"] = 1e3 * median(walls);
    state.counters["kB each"] = 1e-3 * street.bytes;
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
    const std::string thrower = OSGSKIN_DATA "/thrower.skin";
    add("walkers/1000 in a street, any group", frames, "", kStreet, 0U)->UseManualTime();
    add("walkers/1000 in a street, 2 threads", frames, "", kStreet, 2U)->UseManualTime();
    add("walkers/10000 in a street, 2 threads", frames, "", kCity, 2U)->UseManualTime();
    add("walkers/1000 close by, 2 threads", frames, "", kClose, 2U)->UseManualTime();
    add("walkers/1000 throwers, any group", frames, thrower, kStreet, 0U)->UseManualTime();
    add("walkers/1000 throwers, 2 threads", frames, thrower, kStreet, 2U)->UseManualTime();
}

} // namespace bench
