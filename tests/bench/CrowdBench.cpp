// SPDX-License-Identifier: MIT
//
// A thousand characters that share one model, each in its own phase: poses set and skins deformed.
#include "CrowdBench.h"

#include "BenchBody.h"

#include <osgSkin/DeformPool>

#include <osg/ref_ptr>

namespace bench {
namespace {

constexpr std::size_t kCharacters = 1000;

/// Poses and outputs of the whole crowd; two output buffers each, as a DeformableSkin has.
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
        // Phases 7 samples apart: neighbours share neither a pose nor what it leaves in a cache.
        pool->forEach(kCharacters, [&](std::size_t i) {
            const auto& skinning = body.skinning[(7 * i + frame) % body.skinning.size()];
            crowd.poses[i].set(skinning.data(), skinning.size());
            crowd.jobs[i].run();
        });
        ++frame;
    }
    state.counters["vertices"] = static_cast<double>(kCharacters * crowd.model->vertexCount());
}

} // namespace bench
