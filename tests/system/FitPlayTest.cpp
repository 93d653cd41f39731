// SPDX-License-Identifier: MIT
// Motions on bodies with fitted skeletons: they play, and the skin does not tear.
#include "Command.h"
#include "DrawnSkin.h"
#include "SkinFiles.h"

#include <osgSkinCharacter/LoadCharacter>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace {

using osgSkin::Character;

struct Play {
    const char* name;
    const char* mesh;   ///< below OSGSKIN_SHARED_DATA; null: the thrower
    const char* motion; ///< below OSGSKIN_SHARED_DATA; null: the project's own throw
    std::size_t skipFrames;
};

void PrintTo(const Play& play, std::ostream* out) {
    *out << play.name;
}

std::string meshFile(const Play& play) {
    return play.mesh ? std::string(OSGSKIN_SHARED_DATA "/") + play.mesh
                     : OSGSKIN_DATA "/thrower.obj";
}

std::string motionFile(const Play& play) {
    return play.motion ? std::string(OSGSKIN_SHARED_DATA "/") + play.motion
                       : OSGSKIN_DATA "/throw.bvh";
}

/// The skin's current vertices, in the mesh's own order.
std::vector<glm::dvec3> posedSkin(const Character& character) {
    std::vector<glm::dvec3> result(character.body.mesh.positions.size());
    test::forEachCopy(character, [&](std::uint32_t vertex, const osg::Vec3d& p) {
        result[vertex] = {p.x(), p.y(), p.z()};
    });
    return result;
}

/// Each edge's length over its length at rest, ascending.
std::vector<double> stretches(const osgSkin::SkinMesh& mesh, const std::vector<glm::dvec3>& posed) {
    std::vector<double> result;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        for (std::size_t i = 0; i < size; ++i) {
            const std::uint32_t a = mesh.faceVertices[corner + i];
            const std::uint32_t b = mesh.faceVertices[corner + (i + 1) % size];
            const double rest = glm::distance(mesh.positions[a], mesh.positions[b]);
            if (rest > 0.0) result.push_back(glm::distance(posed[a], posed[b]) / rest);
        }
        corner += size;
    }
    std::sort(result.begin(), result.end());
    return result;
}

Character loadFitted(const std::string& mesh, const std::string& motion, std::size_t skipFrames) {
    return osgSkin::loadCharacter(test::saveSkin(test::makeTestFolder() + "/fitted.skin",
                                                 R"(, "motions": [{"file": ")" + motion +
                                                     R"(", "skipFrames": )" +
                                                     std::to_string(skipFrames) + "}]",
                                                 mesh, R"({"fit": true})"));
}

class FitPlay : public testing::TestWithParam<Play> {
protected:
    void SetUp() override {
        for (const std::string& file : {meshFile(GetParam()), motionFile(GetParam())})
            if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    }

    static Character load() {
        return loadFitted(meshFile(GetParam()), motionFile(GetParam()), GetParam().skipFrames);
    }
};

} // namespace

TEST_P(FitPlay, SkinDoesNotTear) {
    Character character = load();
    ASSERT_EQ(character.rest.joints.size(), 31u);
    EXPECT_EQ(character.fitReport.joints.size(), 31u);
    const osgSkin::CharacterMotion& motion = character.motions.front();
    for (const auto& entry : motion.report.entries)
        EXPECT_FALSE(entry.motionJoint.empty()) << entry.rigJoint;
    const std::size_t step = std::max<std::size_t>(1, motion.clip.frames / 24);
    for (std::size_t frame = 0; frame < motion.clip.frames; frame += step) {
        character.pose(motion, frame);
        const std::vector<double> edges = stretches(character.body.mesh, posedSkin(character));
        // Armpits stretch most if arms rest low and are raised. A tear would be far beyond.
        EXPECT_LT(edges.back(), 5.0) << "frame " << frame;
        EXPECT_LT(edges[edges.size() * 999 / 1000], 3.2) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, FitPlay,
    testing::Values(Play{"thrower_throws", nullptr, nullptr, 0},
                    Play{"human_throws", "human_blend/human_4282.obj", nullptr, 0},
                    Play{"human_pitches", "human_blend/human_4282.obj",
                         "cmu/mb/124_01_pitch_excerpt_120hz.bvh", 1},
                    Play{"human_walks", "human_blend/human_4282.obj", "cmu/mb/12_01_walk_pybvh.bvh",
                         1},
                    Play{"human_climbs", "human_blend/human_4282.obj", "cmu/mb/01_03.bvh", 1},
                    Play{"human_jumps", "human_blend/human_4282.obj", "cmu/mb/01_01.bvh", 1},
                    Play{"body_throws", "makehuman/body/body4k_neutral.obj", nullptr, 0}),
    [](const auto& play) { return std::string(play.param.name); });

TEST(FitPlayThrower, ThrowsAsWithItsOwnSkeleton) {
    Character fitted = loadFitted(OSGSKIN_DATA "/thrower.obj", OSGSKIN_DATA "/throw.bvh", 0);
    Character own = osgSkin::loadCharacter(OSGSKIN_DATA "/thrower.skin");
    for (std::size_t frame = 0; frame < 360; frame += 30) {
        fitted.pose(fitted.motions.front(), frame);
        own.pose(own.motions.front(), frame);
        const std::vector<glm::dvec3> a = posedSkin(fitted), b = posedSkin(own);
        double mean = 0.0;
        for (std::size_t v = 0; v < a.size(); ++v)
            mean += glm::distance(a[v], b[v]) / static_cast<double>(a.size());
        EXPECT_LT(mean, 0.04 * 1.8) << "frame " << frame;
    }
}
