// SPDX-License-Identifier: MIT
//
// Poses of an actor on a body of another size, one at a time.
#include "BenchBody.h"
#include "CharacterBench.h"

#include <osgSkinRig/LiveRetarget>

#include <vector>

namespace bench {
namespace {

/// An iteration is one pose: the body's own clip, on its skeleton with shorter limbs.
void live(benchmark::State& state) {
    const Body& body = bench::body(1);
    osgSkin::RestSkeleton rig = body.rig;
    for (osgSkin::RestJoint& joint : rig.joints) {
        joint.centre *= glm::dvec3(0.8, 0.9, 0.9);
        if (joint.tip) *joint.tip *= glm::dvec3(0.8, 0.9, 0.9);
    }
    osgSkin::LiveRetarget retarget(body.rig, rig);
    std::vector<osgSkin::JointSample> joints(rig.joints.size());
    std::size_t frame = 0;
    for ([[maybe_unused]] auto iteration : state) {
        retarget.apply(&body.clip.rotations[frame * body.clip.joints],
                       body.clip.rootPositions[frame], joints.data());
        benchmark::DoNotOptimize(joints.data());
        frame = (frame + 1) % body.clip.frames;
    }
    state.counters["joints"] = static_cast<double>(rig.joints.size());
}

} // namespace

void addLive() {
    benchmark::RegisterBenchmark("live", live);
}

} // namespace bench
