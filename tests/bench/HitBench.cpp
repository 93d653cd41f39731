// SPDX-License-Identifier: MIT
//
// Shapes of a character's limbs: fitted once, moved each frame, and picked.
#include "CharacterBench.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/HitBoxes>

#include <cmath>
#include <string>

namespace bench {
namespace {

void fit(benchmark::State& state) {
    const osgSkin::Character character =
        osgSkin::loadCharacter(std::string(OSGSKIN_DATA) + "/thrower.skin");
    for ([[maybe_unused]] auto iteration : state)
        benchmark::DoNotOptimize(osgSkin::attach<osgSkin::HitBoxes>(*character.root));
}

osg::ref_ptr<osgSkin::HitBoxes> fitted(const osgSkin::Character& character,
                                       benchmark::State& state) {
    const osg::ref_ptr<osgSkin::HitBoxes> hits =
        osgSkin::attach<osgSkin::HitBoxes>(*character.root);
    std::size_t shapes = 0;
    for (const osgSkin::HitBoxes::Limb& limb : hits->limbs()) shapes += limb.shapes.size();
    state.counters["limbs"] = static_cast<double>(hits->limbs().size());
    state.counters["shapes"] = static_cast<double>(shapes);
    return hits;
}

void update(benchmark::State& state) {
    const osgSkin::Character character =
        osgSkin::loadCharacter(std::string(OSGSKIN_DATA) + "/thrower.skin");
    const osg::ref_ptr<osgSkin::HitBoxes> hits = fitted(character, state);
    for ([[maybe_unused]] auto iteration : state) hits->update();
}

/// Lines from all sides through the figure, one in each iteration.
void pick(benchmark::State& state) {
    const osgSkin::Character character =
        osgSkin::loadCharacter(std::string(OSGSKIN_DATA) + "/thrower.skin");
    const osg::ref_ptr<osgSkin::HitBoxes> hits = fitted(character, state);
    double angle = 0.0;
    for ([[maybe_unused]] auto iteration : state) {
        const osg::Vec3d side(2.0 * std::cos(angle), 2.0 * std::sin(angle), 1.0);
        benchmark::DoNotOptimize(hits->pick(side, {-side.x(), -side.y(), 1.2}));
        angle += 0.1;
    }
}

} // namespace

void addHits() {
    benchmark::RegisterBenchmark("hits/fit", fit)->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("hits/update", update);
    benchmark::RegisterBenchmark("hits/pick", pick);
}

} // namespace bench
