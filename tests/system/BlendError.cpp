// SPDX-License-Identifier: MIT
#include "BlendError.h"

#include "DrawnSkin.h"
#include "GltfReference.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>

namespace test {
namespace {

constexpr int kTimes = 7; ///< a clip

/// Adds the means of one pose.
void compare(osgSkin::Character& character, const std::vector<glm::dvec3>& expected,
             const std::vector<bool>& whole, const std::string& clip, BlendError& result) {
    double sums[2] = {0.0, 0.0}, counts[2] = {0.0, 0.0};
    forEachCopy(character, [&](std::uint32_t vertex, const osg::Vec3d& found) {
        const glm::dvec3& p = expected[vertex];
        sums[whole[vertex] ? 0 : 1] += (found - osg::Vec3d(p.x, p.y, p.z)).length();
        counts[whole[vertex] ? 0 : 1] += 1.0;
    });
    const double size = character.body.mesh.size();
    if (counts[0] > 0.0 && sums[0] / counts[0] / size >= result.whole) {
        result.whole = sums[0] / counts[0] / size;
        result.clip = clip;
    }
    if (counts[1] > 0.0) result.mixed = std::max(result.mixed, sums[1] / counts[1] / size);
}

} // namespace

BlendError blendError(osgSkin::Character& character, const std::string& file) {
    GltfReference reference(file);
    const std::vector<bool> whole = reference.wholeWeights();
    BlendError result;
    EXPECT_EQ(whole.size(), character.body.mesh.positions.size()) << file;
    if (whole.size() != character.body.mesh.positions.size()) return result;
    if (character.motions.empty())
        compare(character, reference.verticesAt(-1, 0.0), whole, "at rest", result);
    for (const osgSkin::CharacterMotion& motion : character.motions) {
        const nlohmann::json& animations = reference.json["animations"];
        int index = -1;
        for (std::size_t a = 0; a < animations.size(); ++a)
            if (animations[a].value("name", "") == motion.name()) index = int(a);
        EXPECT_GE(index, 0) << motion.name();
        if (index < 0) continue;
        const double first = reference.firstKey(std::size_t(index));
        for (int k = 0; k < kTimes; ++k) { // between keys, and before the end, which equals the
                                           // start
            const double seconds = motion.duration() * (k + 0.3) / kTimes;
            character.poseAt(motion, seconds);
            compare(character, reference.verticesAt(index, first + seconds), whole, motion.name(),
                    result);
        }
        ++result.clips;
    }
    return result;
}

BlendError blendError(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    return blendError(character, file);
}

} // namespace test
