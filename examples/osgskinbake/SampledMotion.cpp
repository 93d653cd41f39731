// SPDX-License-Identifier: GPL-3.0-or-later
#include "SampledMotion.h"

#include <osgSkin/Error>

#include <algorithm>
#include <cmath>

namespace bake {
namespace {

constexpr double kMostSamples = 1e9;

using osgSkin::Character;
using osgSkin::CharacterMotion;

SampledMotion ownSamples(Character& character, const CharacterMotion& motion) {
    return {motion.name(), motion.clip.frames, motion.clip.frameTime, motion.report.feetText(),
            [&character, &motion](std::size_t frame) { character.pose(motion, frame); }};
}

SampledMotion samplesAt(Character& character, const CharacterMotion& motion, double rate) {
    // Files have times as floats, and those round.
    const double frames = motion.animation->getDuration() * rate;
    const double last = std::floor(frames + std::min(0.01, 1e-6 * (1.0 + frames)));
    if (!(last < kMostSamples))
        throw osgSkin::Error(character.file + ": motion \"" + motion.name() + "\" has " +
                             std::to_string(last) + " frames, expected less than 1e9");
    return {motion.name(),
            static_cast<std::size_t>(last) + 1,
            1.0 / rate,
            {},
            [&character, &motion, rate](std::size_t frame) {
                character.poseAt(motion, static_cast<double>(frame) / rate);
            }};
}

} // namespace

std::vector<SampledMotion> sampledMotions(Character& character, double rate) {
    std::vector<SampledMotion> result;
    for (const CharacterMotion& motion : character.motions)
        result.push_back(motion.isSampled() ? ownSamples(character, motion)
                                            : samplesAt(character, motion, rate));
    return result;
}

} // namespace bake
