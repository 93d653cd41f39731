// SPDX-License-Identifier: MIT
//
// A thousand characters that share one model, each in its own phase: poses set and skins deformed.
#include "CharacterBench.h"

#include "BenchBody.h"
#include "CullFrame.h"

#include <osgSkin/DeformJob>
#include <osgSkin/DeformPool>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include <osg/ref_ptr>
#include <osgAnimation/BasicAnimationManager>

#include <algorithm>
#include <ctime>
#include <memory>
#include <vector>

namespace bench {

namespace {

constexpr std::size_t kCharacters = 1000;

/// Poses and outputs of the whole crowd; two output buffers per character, like a DeformableSkin.
struct Crowd {
    explicit Crowd(const Body& body) : model(body.model()), poses(kCharacters) {
        for (osgSkin::Pose& pose : poses) pose = osgSkin::Pose(model->joints());
        for (auto& buffer : outputs)
            buffer.assign(kCharacters, std::vector<glm::vec3>(2 * model->vertexCount()));
        jobs.resize(kCharacters);
        for (std::size_t i = 0; i < kCharacters; ++i) {
            jobs[i].model = model.get();
            jobs[i].pose = &poses[i];
            jobs[i].positionCount = jobs[i].normalCount = model->vertexCount();
        }
    }
    void swap(std::size_t frame) {
        for (std::size_t i = 0; i < kCharacters; ++i) {
            jobs[i].positions = outputs[frame % 2][i].data();
            jobs[i].normals = jobs[i].positions + model->vertexCount();
        }
    }

    osg::ref_ptr<const osgSkin::SkinModel> model;
    std::vector<osgSkin::Pose> poses;
    std::vector<std::vector<glm::vec3>> outputs[2];
    std::vector<osgSkin::DeformJob> jobs;
};

} // namespace

void crowd(benchmark::State& state, unsigned int threads) {
    const Body& body = bench::body(1);
    static Crowd crowd(body);
    const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(threads);
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state) {
        crowd.swap(frame);
        // Phases 7 samples apart, so that neighbours share neither a pose nor cached data.
        pool->forEach(kCharacters, [&](std::size_t i) {
            const auto& skinning = body.skinning[(7 * i + frame) % body.skinning.size()];
            crowd.poses[i].set(skinning.data(), skinning.size());
            crowd.jobs[i].run();
        });
        ++frame;
    }
    state.counters["vertices"] = static_cast<double>(kCharacters * crowd.model->vertexCount());
}

namespace {

constexpr unsigned int kInScene = 20;
constexpr double kPhase = 0.37; // seconds from one to the next

osg::ref_ptr<osgSkin::DeformableSkin>
makeSkin(const Body& body, const osg::ref_ptr<const osgSkin::SkinModel>& model) {
    const auto array = [](const std::vector<glm::vec3>& vectors) {
        const osg::ref_ptr<osg::Vec3Array> result = new osg::Vec3Array(
            osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(vectors.size()));
        std::copy(vectors.begin(), vectors.end(), osgSkin::asGlm(result->asVector().data()));
        return result;
    };
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(array(body.positions));
    geometry->setNormalArray(array(body.normals));
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, static_cast<unsigned int>(body.triangles.size()), body.triangles.data()));
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(geometry, model);
    return skin;
}

/// Adds the node to a manager that plays the body's clip.
osg::ref_ptr<osg::Group> animated(const Body& body, osg::Node* skeleton, double phase) {
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(skeleton);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    const osg::ref_ptr<osgAnimation::Animation> animation =
        osgSkin::makeAnimation(body.clip, body.rig);
    animation->setStartTime(-phase);
    manager->registerAnimation(animation);
    group->setUpdateCallback(manager);
    manager->buildTargetReference();
    manager->playAnimation(animation);
    return group;
}

osg::ref_ptr<osg::Group>
ownCharacter(const Body& body, const osg::ref_ptr<const osgSkin::SkinModel>& model, double phase) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(body.rig);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = makeSkin(body, model);
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    skeleton->addChild(skin);
    return animated(body, skeleton, phase);
}

/// A scene and its frames.
class Scene {
public:
    Scene(Player player, Kind kind) {
        const Body& body = bench::body(1, kind);
        const auto model = body.model();
        osg::ref_ptr<osgSkin::ClipCharacter> copies;
        osg::ref_ptr<const osgSkin::SampledClip> clip;
        if (player == Player::Baked || player == Player::Between || player == Player::Sampled) {
            const osg::ref_ptr<osg::Group> character = ownCharacter(body, model, 0.0);
            copies = osgSkin::ClipCharacter::create(*character);
            clip = copies->sample(*copies->animations().front());
            if (player != Player::Sampled) copies->bake(clip);
        }
        for (unsigned int i = 0; i < kInScene; ++i) {
            const double phase = kPhase * i;
            if (copies) {
                const auto copy = copies->makeInstance();
                copy.player->setInterpolated(player != Player::Baked);
                copy.player->setLayer(0, {clip, phase});
                _scene->addChild(copy.node);
            } else if (player == Player::Skeleton) {
                _scene->addChild(ownCharacter(body, model, phase));
            } else {
                _rigs.push_back(std::make_unique<OsgRig>(body));
                _scene->addChild(animated(body, _rigs.back()->skeleton(), phase));
            }
        }
        _frame.warmUp();
    }

    void frame() {
        _frame.update();
        _frame.cull();
    }

private:
    osg::ref_ptr<osg::Group> _scene = new osg::Group;
    std::vector<std::unique_ptr<OsgRig>> _rigs;
    CullFrame _frame{*_scene};
};

} // namespace

void characters(benchmark::State& state, Player player, Kind kind) {
    Scene scene(player, kind);
    for ([[maybe_unused]] auto iteration : state) scene.frame();
    state.counters["vertices"] =
        static_cast<double>(kInScene) * static_cast<double>(bench::body(1).positions.size());
}

void deformationAlone(benchmark::State& state, Kind kind) {
    const Body& body = bench::body(1, kind);
    const auto model = body.model();
    // Every frame of the clip, since no character stands still.
    std::vector<osgSkin::Pose> poses(body.skinning.size(), osgSkin::Pose(model->joints()));
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i].set(body.skinning[i].data(), body.skinning[i].size());
    // Two alternating buffers per character, like a DeformableSkin.
    std::vector<std::vector<glm::vec3>> outputs(std::size_t{2} * kInScene);
    for (auto& output : outputs) output.resize(2 * model->vertexCount());
    std::size_t frame = 0;
    osgSkin::DeformJob job;
    job.model = model.get();
    job.positionCount = job.normalCount = model->vertexCount();
    for ([[maybe_unused]] auto iteration : state) {
        ++frame;
        for (std::size_t i = 0; i < kInScene; ++i) {
            job.pose = &poses[(37 * i + frame) % poses.size()];
            job.positions = outputs[2 * i + frame % 2].data();
            job.normals = job.positions + model->vertexCount();
            job.run();
        }
    }
    state.counters["vertices"] =
        static_cast<double>(kInScene) * static_cast<double>(model->vertexCount());
}

namespace {

/// A body's skin with every vertex repeated `times` times, in its own memory.
class UpdatedSkin {
public:
    UpdatedSkin(const Body& body, std::size_t times) : _body(body) {
        std::vector<glm::vec3> positions, normals;
        std::vector<std::uint32_t> source;
        for (std::size_t i = 0; i < times; ++i) {
            positions.insert(positions.end(), body.positions.begin(), body.positions.end());
            normals.insert(normals.end(), body.normals.begin(), body.normals.end());
            for (std::uint32_t v = 0; v < body.positions.size(); ++v) source.push_back(v);
        }
        _model =
            osgSkin::SkinModel::createInBestOrder(body.binding, positions, normals, source).model;
        _outputs.resize(2 * positions.size());
    }

    double vertexCount() const { return static_cast<double>(_model->vertexCount()); }

    /// Duration of an update in seconds, the last of several so that the caches are warm.
    double update(std::size_t frame, osgSkin::Pose& pose) {
        constexpr std::size_t kUpdates = 20;
        osgSkin::DeformJob job;
        job.model = _model.get();
        job.pose = &pose;
        job.positionCount = job.normalCount = _model->vertexCount();
        job.positions = _outputs.data();
        job.normals = job.positions + job.positionCount;
        const std::clock_t start = std::clock();
        for (std::size_t i = 0; i < kUpdates; ++i) {
            const auto& skinning = _body.skinning[(frame + i) % _body.skinning.size()];
            pose.set(skinning.data(), skinning.size());
            job.run();
            benchmark::ClobberMemory();
        }
        return static_cast<double>(std::clock() - start) / (CLOCKS_PER_SEC * kUpdates);
    }

private:
    const Body& _body;
    osg::ref_ptr<const osgSkin::SkinModel> _model;
    std::vector<glm::vec3> _outputs;
};

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    return *middle;
}

} // namespace

// A skin's speed depends on where its memory happens to be, so several are measured; the result is
// their median and spread.
void setUpShare(benchmark::State& state, Kind kind, Larger larger) {
    constexpr std::size_t kSkins = 9, kRounds = 25;
    const bool finer = larger == Larger::FinerMesh;
    const Body& body = bench::body(1, kind);
    osgSkin::Pose pose(body.binding.joints, body.binding.correctives.inputs.size());
    std::vector<UpdatedSkin> small, large;
    for (std::size_t i = 0; i < kSkins; ++i) {
        small.emplace_back(body, 1);
        large.emplace_back(finer ? bench::body(3, kind) : body, finer ? 1 : 2);
    }
    const double ratio = large.front().vertexCount() / small.front().vertexCount();
    for ([[maybe_unused]] auto iteration : state) {
        std::vector<double> rests, updates, shares;
        for (std::size_t i = 0; i < kSkins; ++i) {
            std::vector<double> smalls, larges;
            for (std::size_t round = 0; round < kRounds; ++round) {
                smalls.push_back(small[i].update(round, pose));
                larges.push_back(large[i].update(round, pose));
            }
            const double update = median(smalls);
            updates.push_back(update);
            rests.push_back(update - (median(larges) - update) / (ratio - 1.0));
            shares.push_back(100.0 * rests.back() / update);
        }
        state.SetIterationTime(std::max(0.0, median(rests)));
        state.counters["update us"] = 1e6 * median(updates);
        state.counters["set-up %"] = median(shares);
        state.counters["least %"] = *std::min_element(shares.begin(), shares.end());
        state.counters["most %"] = *std::max_element(shares.begin(), shares.end());
    }
}

} // namespace bench
