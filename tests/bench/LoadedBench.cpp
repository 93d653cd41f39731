// SPDX-License-Identifier: MIT
//
// Whole frames of characters as users load them: the update traversal, the skins' deformation, and
// bounds and cull traversal beside it; nothing is drawn. `update x` and `cull x` are ratios to the
// deformation of the same frames. Characters are read from one .osgb file, each in its own phase.
#include <osgSkin/DeformPool>
#include <osgSkin/DeformableSkin>
#include <osgSkin/ParallelDeformCallback>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinCharacter/LoadCharacter>

#include <benchmark/benchmark.h>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace {

/// Seconds of this thread's processor time, or of the clock where other threads work, too.
double now(bool isThreaded) {
    if (isThreaded)
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

class Skins : public osg::NodeVisitor {
public:
    Skins() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) found.push_back(skin);
    }
    std::vector<osgSkin::DeformableSkin*> found;
};

/// A file with the character of the data folder, which is removed at the end.
class SavedCharacter {
public:
    SavedCharacter()
        : _file((std::filesystem::temp_directory_path() /
                 ("osgskin-bench-" + std::to_string(std::random_device()()) + ".osgb"))
                    .string()) {
        osgDB::writeNodeFile(*osgSkin::loadCharacter(OSGSKIN_DATA "/thrower.skin").root, _file);
    }
    ~SavedCharacter() { std::filesystem::remove(_file); }
    SavedCharacter(const SavedCharacter&) = delete;
    SavedCharacter& operator=(const SavedCharacter&) = delete;

    osg::ref_ptr<osg::Node> read() const {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
        options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
        return osgDB::readRefNodeFile(_file, options);
    }

private:
    std::string _file;
};

/// How the characters are played.
struct Mode {
    bool bonesFollow = false;
    unsigned int threads = 0; ///< of a ParallelDeformCallback; 0: none
    bool sharesModel = false; ///< copies of one character in place of loads
};

class Scene {
public:
    Scene(std::size_t count, const Mode& mode) {
        static const SavedCharacter saved;
        constexpr double kPhase = 0.37; // seconds from one to the next
        osg::ref_ptr<osg::Node> first;
        const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(double(count))));
        for (std::size_t i = 0; i < count; ++i) {
            osg::ref_ptr<osg::Node> character;
            if (first && mode.sharesModel)
                character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES |
                                                        osg::CopyOp::DEEP_COPY_CALLBACKS |
                                                        osg::CopyOp::DEEP_COPY_DRAWABLES);
            else
                character = saved.read();
            if (!first) first = character;
            const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
                osg::Matrix::translate(2.0 * double(i % columns), 2.0 * double(i / columns), 0.0));
            place->addChild(character);
            _scene->addChild(place);
            _managers.push_back(
                dynamic_cast<osgAnimation::BasicAnimationManager*>(character->getUpdateCallback()));
        }
        if (mode.bonesFollow) osgSkin::setBonesFollow(*_scene, true);
        if (mode.threads > 0)
            _scene->setUpdateCallback(
                new osgSkin::ParallelDeformCallback(new osgSkin::DeformPool(mode.threads)));
        Skins skins;
        _scene->accept(skins);
        _skins = skins.found;
        _update->setFrameStamp(_stamp);
        _cull->setFrameStamp(_stamp);
        update();
        for (std::size_t i = 0; i < count; ++i)
            _managers[i]->getAnimationList().front()->setStartTime(-kPhase * double(i));
        for (int i = 0; i < 3; ++i) { // these frames still allocate
            update();
            cull();
        }
    }

    double vertices() const {
        double result = 0.0;
        for (const osgSkin::DeformableSkin* skin : _skins)
            result += double(skin->getModel()->vertexCount());
        return result;
    }

    void update() {
        _stamp->setFrameNumber(++_frame);
        _stamp->setSimulationTime(_frame / 60.0);
        _update->setTraversalNumber(_frame);
        _scene->accept(*_update);
    }
    void deform() const {
        for (osgSkin::DeformableSkin* skin : _skins) skin->getDeformedGeometry();
    }
    void cull() {
        const osg::BoundingSphere bound = _scene->getBound();
        const double r = 1.2 * static_cast<double>(bound.radius());
        _graph->clean();
        _stage->reset();
        _cull->reset();
        _cull->setTraversalNumber(_frame);
        _cull->setStateGraph(_graph);
        _cull->setRenderStage(_stage);
        _cull->pushViewport(_viewport);
        _cull->pushProjectionMatrix(
            new osg::RefMatrix(osg::Matrix::ortho(-r, r, -r, r, 0.0, 4 * r)));
        const osg::Vec3d centre = bound.center();
        const osg::ref_ptr<osg::RefMatrix> view = new osg::RefMatrix(osg::Matrix::lookAt(
            centre + osg::Vec3d(0.0, -2.0 * r, 0.0), centre, osg::Vec3d(0.0, 0.0, 1.0)));
        _cull->pushModelViewMatrix(view, osg::Transform::ABSOLUTE_RF);
        _scene->accept(*_cull);
        _cull->popModelViewMatrix();
        _cull->popProjectionMatrix();
        _cull->popViewport();
    }

private:
    osg::ref_ptr<osg::Group> _scene = new osg::Group;
    std::vector<osgAnimation::BasicAnimationManager*> _managers;
    std::vector<osgSkin::DeformableSkin*> _skins;
    osg::ref_ptr<osg::FrameStamp> _stamp = new osg::FrameStamp;
    osg::ref_ptr<osgUtil::UpdateVisitor> _update = new osgUtil::UpdateVisitor;
    osg::ref_ptr<osgUtil::CullVisitor> _cull = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> _graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> _stage = new osgUtil::RenderStage;
    osg::ref_ptr<osg::Viewport> _viewport = new osg::Viewport(0, 0, 1000, 800);
    unsigned int _frame = 0;
};

void loaded(benchmark::State& state, Mode mode) {
    const auto count = static_cast<std::size_t>(state.range(0));
    Scene scene(count, mode);
    double update = 0.0, deform = 0.0, cull = 0.0;
    for ([[maybe_unused]] auto iteration : state) {
        const double start = now(mode.threads > 0);
        scene.update();
        const double updated = now(mode.threads > 0) - start;
        scene.deform();
        const double deformed = now(mode.threads > 0) - start;
        scene.cull();
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
    state.counters["vertices"] = scene.vertices() / double(count);
}

} // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    for (const int count : {20, 100, 1000})
        for (const auto& [name, mode] :
             {std::pair("bones as needed", Mode{}),
              {"bones follow", Mode{true}},
              {"bones as needed, 2 threads", Mode{false, 2}},
              {"copies, bones as needed", Mode{false, 0, true}},
              {"copies, bones as needed, 2 threads", Mode{false, 2, true}}})
            benchmark::RegisterBenchmark(("loaded, " + std::string(name)).c_str(), loaded, mode)
                ->Arg(count)
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
