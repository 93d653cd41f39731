// SPDX-License-Identifier: MIT
//
// Layers of clips on the body's joints, without a skin.
#include "BenchBody.h"
#include "CharacterBench.h"

#include <osgSkinMotion/ClipPlayer>

#include <string>
#include <vector>

namespace bench {
namespace {

enum class Mask { None, AllJoints, UpperBody };

/// An iteration is one frame: times advance, and all joints are sampled and blended.
void layers(benchmark::State& state, std::size_t count, Mask mask) {
    const Body& body = bench::body(1);
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < count; ++i) {
        osgSkin::ClipPlayer::Layer layer{osgSkin::SampledClip::create(body.clip, body.rig),
                                         0.3 * static_cast<double>(i)};
        if (i > 0) layer.weight = 0.6;
        if (i > 0 && mask == Mask::AllJoints)
            layer.joints = osgSkin::jointsBelow(*layer.clip, body.rig.joints[0].name);
        if (i > 0 && mask == Mask::UpperBody)
            layer.joints = osgSkin::jointsBelow(*layer.clip, "Spine");
        layer.additive = i == 3;
        moved += layer.joints.empty() ? body.rig.joints.size() : layer.joints.size();
        player->setLayer(i, layer);
    }
    for ([[maybe_unused]] auto iteration : state) {
        player->advance(0.0117);
        benchmark::DoNotOptimize(player->pose());
    }
    state.counters["joints"] = static_cast<double>(moved);
}

} // namespace

void addLayers() {
    benchmark::RegisterBenchmark("layers/1", layers, 1, Mask::None);
    benchmark::RegisterBenchmark("layers/2", layers, 2, Mask::None);
    benchmark::RegisterBenchmark("layers/4, all joints", layers, 4, Mask::AllJoints);
    benchmark::RegisterBenchmark("layers/4, upper body", layers, 4, Mask::UpperBody);
}

} // namespace bench
