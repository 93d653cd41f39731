// SPDX-License-Identifier: MIT
// The whole scene of a loaded character: parts, seams, bounds, and a plausible pose.
#include "CharacterFiles.h"
#include "Command.h"
#include "DrawnSkin.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipCharacter>

#include <gtest/gtest.h>
#include <osg/TriangleIndexFunctor>
#include <osgAnimation/BoneMapVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace {

using osgSkin::Character;
using test::CharacterCase;

struct Triangles {
    std::vector<std::array<unsigned int, 3>> all;
    void operator()(unsigned int a, unsigned int b, unsigned int c) { all.push_back({a, b, c}); }
};

/// A triangle as a cycle of source vertices that starts with the smallest.
std::array<std::uint32_t, 3> cycle(std::array<std::uint32_t, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// The volume of a skin's box over that of the tight box around its posed vertices; 0 if a vertex
/// is outside.
double looseness(const osgSkin::DeformableSkin& skin) {
    osg::BoundingBoxd tight;
    for (const osg::Vec3& v :
         static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray()))
        tight.expandBy(v);
    const osg::BoundingBox& box = skin.getBoundingBox();
    if (!box.contains(tight._min) || !box.contains(tight._max)) return 0.0;
    const osg::Vec3d is = box._max - box._min;
    const osg::Vec3d least = tight._max - tight._min;
    return is.x() * is.y() * is.z() / (least.x() * least.y() * least.z());
}

class LoadedCharacter : public testing::TestWithParam<CharacterCase> {
protected:
    void SetUp() override {
        std::string why;
        if (!test::isAvailable(GetParam(), why)) GTEST_SKIP() << why;
        const std::string shapes = GetParam().shapes;
        osgSkin::LoadOptions options;
        options.shapes = shapes == "fast" ? osgSkin::BindOptions::Shapes::Fast
                                          : osgSkin::BindOptions::Shapes::None;
        character =
            osgSkin::loadCharacter(test::skinFile(GetParam(), test::makeTestFolder()), options);
    }

    void setFrame(std::size_t frame) { character.pose(character.motions.front(), frame); }

    osg::Vec3d joint(const std::string& name) const {
        osgAnimation::BoneMapVisitor visitor;
        character.skeleton->accept(visitor);
        return visitor.getBoneMap().at(name)->getMatrixInSkeletonSpace().getTrans();
    }

    double height() const {
        double low = 1e30, high = -1e30;
        for (const glm::dvec3& p : character.body.mesh.positions) {
            low = std::min(low, p.y);
            high = std::max(high, p.y);
        }
        return high - low;
    }

    Character character;
};

} // namespace

TEST_P(LoadedCharacter, SeamsStayClosed) {
    double gap = 0.0;
    std::size_t seamVertices = 0;
    for (std::size_t frame = 0; frame < character.motions.front().clip.frames; ++frame) {
        setFrame(frame);
        std::map<std::uint32_t, osg::Vec3d> first;
        seamVertices = 0;
        test::forEachCopy(character, [&](std::uint32_t vertex, const osg::Vec3d& place) {
            const auto inserted = first.emplace(vertex, place);
            if (inserted.second) return;
            ++seamVertices;
            gap = std::max(gap, (place - inserted.first->second).length());
        });
    }
    EXPECT_GT(seamVertices, 20u); // five seams
    EXPECT_LE(gap, 1e-5 * height());
}

TEST_P(LoadedCharacter, PartsHaveEachFaceOnce) {
    ASSERT_EQ(character.skin.skins.size(), 1u);
    EXPECT_EQ(character.skin.rigids.size(), 1u); // the head: the motions move thumbs and toes
    std::multiset<std::array<std::uint32_t, 3>> drawn;
    std::set<std::uint32_t> vertices;
    const auto collect = [&](const osgSkin::MeshPart& part) {
        osg::TriangleIndexFunctor<Triangles> triangles;
        part.geometry->accept(triangles);
        for (const auto& t : triangles.all)
            drawn.insert(
                cycle({part.sourceVertex[t[0]], part.sourceVertex[t[1]], part.sourceVertex[t[2]]}));
        vertices.insert(part.sourceVertex.begin(), part.sourceVertex.end());
    };
    for (const auto& skin : character.skin.skins) collect(skin.part);
    for (const auto& rigid : character.skin.rigids) collect(rigid.part);

    std::multiset<std::array<std::uint32_t, 3>> input;
    const auto triangles = character.body.mesh.triangles();
    for (std::size_t c = 0; c < triangles.size(); c += 3)
        input.insert(cycle({triangles[c], triangles[c + 1], triangles[c + 2]}));
    EXPECT_EQ(drawn, input);
    EXPECT_EQ(vertices.size(), character.body.mesh.positions.size());
}

TEST_P(LoadedCharacter, RigidPartsAreLarge) {
    for (const auto& rigid : character.skin.rigids)
        EXPECT_GE(rigid.part.sourceFace.size(), 100u) << rigid.node->getName();
}

TEST_P(LoadedCharacter, FeetStayOnTheFloor) {
    double floor = 1e30;
    for (const glm::dvec3& p : character.body.mesh.positions) floor = std::min(floor, p.y);
    const std::size_t frames = character.motions.front().clip.frames;
    for (std::size_t frame = 0; frame < frames; frame += std::max<std::size_t>(1, frames / 50)) {
        setFrame(frame);
        double lowest = 1e30;
        test::forEachCopy(character, [&](std::uint32_t, const osg::Vec3d& place) {
            lowest = std::min(lowest, place.y());
        });
        EXPECT_NEAR(lowest, floor, 0.03 * height()) << "frame " << frame;
    }
}

TEST_P(LoadedCharacter, HandsRiseAsInTheMotion) {
    const std::string name = GetParam().name;
    const bool pitch = name.find("pitch") != std::string::npos;
    const bool walk = name.find("walk") != std::string::npos;
    const std::size_t frames = character.motions.front().clip.frames;
    bool above = false;
    for (std::size_t frame = 0; frame < frames; frame += pitch ? 1 : 10) {
        setFrame(frame);
        for (const char* side : {"Left", "Right"}) {
            const osg::Vec3d hand = joint(side + std::string("Hand"));
            const osg::Vec3d shoulder = joint(side + std::string("Arm"));
            if (hand.y() > shoulder.y()) above = true;
        }
    }
    EXPECT_EQ(above, !walk); // a pitcher's hand rises above the shoulder, a walker's does not
}

TEST_P(LoadedCharacter, BoundsContainTheSkinTightly) {
    const auto& skin = *character.skin.skins.front().drawable;
    const std::size_t frames = character.motions.front().clip.frames;
    double loosest = 0.0, mean = 0.0; // volume over the tight box's
    for (std::size_t frame = 0; frame < frames; ++frame) {
        setFrame(frame);
        const double ratio = looseness(skin);
        ASSERT_GT(ratio, 0.0) << frame;
        loosest = std::max(loosest, ratio);
        mean += ratio / static_cast<double>(frames);
    }
    RecordProperty("loosest", std::to_string(loosest));
    RecordProperty("mean", std::to_string(mean));
    EXPECT_LE(mean, 1.9);
    EXPECT_LE(loosest, 2.6);
}

TEST_P(LoadedCharacter, BakedBoundsContainTheSkinBetweenSamples) {
    const auto copies = osgSkin::ClipCharacter::create(*character.root);
    const auto clip = copies->sample(*copies->animations().front(), 30.0);
    copies->bake(clip);
    const auto copy = copies->makeInstance();
    auto* const place = copy.node->getChild(0)->asGroup();
    const auto& skin = dynamic_cast<const osgSkin::DeformableSkin&>(*place->getChild(0));
    constexpr int kTimes = 500; // at uneven steps
    double mean = 0.0;
    for (int i = 0; i < kTimes; ++i) {
        copy.player->setLayer(0, {clip, std::fmod(0.618034 * i, 1.0) * clip->duration()});
        ASSERT_TRUE(copy.player->pose());
        const double ratio = looseness(skin);
        ASSERT_GT(ratio, 0.0) << i;
        mean += ratio / kTimes;
    }
    RecordProperty("mean", std::to_string(mean));
    EXPECT_LE(mean, 1.9);
}

INSTANTIATE_TEST_SUITE_P(Characters, LoadedCharacter, testing::ValuesIn(test::characterCases()),
                         [](const auto& c) { return std::string(c.param.name); });
