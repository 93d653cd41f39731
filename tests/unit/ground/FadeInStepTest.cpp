// SPDX-License-Identifier: MIT
// Fades between a walk and a run at random times: feet stay on the ground.
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/MakeWalker>

#include <gtest/gtest.h>

#include <osg/MatrixTransform>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>

namespace {

using osgSkin::ClipPlayer;
using Clip = osg::ref_ptr<const osgSkin::SampledClip>;

constexpr double kUpdate = 1.0 / 60.0, kFade = 0.3;
constexpr double kLow = 0.04; ///< leg lengths above the lowest place of a clip alone

struct Gaits {
    const char* name;
    std::string mesh, walk, run; ///< clips of the mesh, or motion files
};

/// A character's walk and run, its feet and the way to the world.
struct Walkers {
    Clip walk, run;
    /// Heel, ball and tip of the left and the right sole: a joint, and a point of rest space.
    std::array<std::array<std::pair<std::string, osg::Vec3d>, 3>, 2> soles;
    osg::Matrixd toWorld;
    double leg = 0.0;

    explicit Walkers(const Gaits& gaits) {
        const bool isFile = gaits.walk.find('/') != std::string::npos;
        osgSkin::LoadOptions options;
        if (isFile) {
            options.motion = gaits.walk;
            options.moreMotions = {gaits.run};
        }
        const osgSkin::Character character = osgSkin::loadCharacter(gaits.mesh, options);
        osgSkin::WalkerOptions named;
        named.walking = isFile ? std::filesystem::path(gaits.walk).stem().string() : gaits.walk;
        named.running = isFile ? std::filesystem::path(gaits.run).stem().string() : gaits.run;
        const osg::ref_ptr<osgSkin::Walker> walker = osgSkin::makeWalker(*character.root, named);
        const osgSkin::Gaits::Set& set = walker->getGaits()->get();
        walk = set.walking.clip;
        run = set.running.clip;
        toWorld = set.toWalker;
        for (std::size_t side = 0; side < 2; ++side) {
            const osgSkin::Gaits::Leg& joints = set.legs[side];
            const std::string foot = walk->joints()[joints.ankle].name;
            soles[side] = {
                {{foot, {joints.heel.x, joints.heel.y, joints.heel.z}},
                 {foot, {joints.ball.x, joints.ball.y, joints.ball.z}},
                 {walk->joints()[joints.toe].name, {joints.tip.x, joints.tip.y, joints.tip.z}}}};
            const auto place = [&](std::size_t joint) {
                const glm::dvec3& centre = walk->joints()[joint].centre;
                return osg::Vec3d(centre.x, centre.y, centre.z) * toWorld;
            };
            leg += 0.5 * (place(joints.hip) - place(joints.ankle)).length();
        }
    }
};

/// Plays a figure's clips, moved along the ground by them, and watches its feet.
struct Played {
    explicit Played(const Walkers& figure) : _figure(figure) {
        const osg::Matrixd toRest = osg::Matrixd::inverse(figure.toWorld);
        player->setRoot(ClipPlayer::Root::FromFeet,
                        osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), toRest));
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t point = 0; point < 3; ++point)
                player->addRigid(_soles[side][point] = new osg::MatrixTransform,
                                 figure.soles[side][point].first, figure.toWorld);
    }

    void play(const Clip& clip, bool inStep) {
        ClipPlayer::Layer layer{clip};
        layer.inStep = inStep;
        player->play(layer, player->getLayer(0).clip ? kFade : 0.0);
    }

    /// One frame.
    /// \param floor of the balls
    void update(double floor) {
        player->advance(kUpdate);
        EXPECT_TRUE(player->pose());
        _place = osg::Matrixd::inverse(_figure.toWorld) * player->takeRootMatrix() *
                 _figure.toWorld * _place;
        std::array<osg::Vec3d, 2> balls;
        std::array<double, 2> heights{1e9, 1e9};
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t point = 0; point < 3; ++point) {
                const osg::Vec3d at =
                    _figure.soles[side][point].second * _soles[side][point]->getMatrix() * _place;
                heights[side] = std::min(heights[side], at.z());
                if (point == 1) balls[side] = at;
            }
        const std::size_t low = balls[0].z() < balls[1].z() ? 0 : 1;
        const osg::Vec3d moved = balls[low] - _before[low];
        lowest = std::min(heights[0], heights[1]);
        if (_isMoved && balls[low].z() < floor + kLow * _figure.leg) {
            slide += std::hypot(moved.x(), moved.y());
            seconds += kUpdate;
        }
        ball = balls[low].z();
        _before = balls;
        _isMoved = true;
    }

    osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    double ball = 0.0, lowest = 0.0; ///< heights of the lower ball and of the soles

    double slide = 0.0, seconds = 0.0; ///< of the lower foot while it is on the floor

private:
    const Walkers& _figure;
    std::array<std::array<osg::ref_ptr<osg::MatrixTransform>, 3>, 2> _soles;

    osg::Matrixd _place;
    std::array<osg::Vec3d, 2> _before;
    bool _isMoved = false;
};

struct Alone {
    double floor = 1e9;                ///< of the balls
    double sole = 1e9, highest = -1e9; ///< of the soles

    double slide = 0.0, seconds = 0.0;
};

Alone playAlone(const Walkers& figure, const Clip& clip) {
    Alone result;
    for (const bool isFirst : {true, false}) {
        Played played(figure);
        played.play(clip, true);
        for (int i = 0; i < 600; ++i) {
            played.update(isFirst ? -1e9 : result.floor);
            result.floor = std::min(result.floor, played.ball);
            result.sole = std::min(result.sole, played.lowest);

            result.highest = std::max(result.highest, played.lowest);
        }
        result.slide = played.slide;
        result.seconds = played.seconds;
    }
    return result;
}

class FadeInStep : public testing::TestWithParam<Gaits> {};

} // namespace

TEST_P(FadeInStep, KeepsFeetOnTheGround) {
    const Gaits& gaits = GetParam();
    for (const std::string& file : {gaits.mesh, gaits.walk, gaits.run})
        if (file.find('/') != std::string::npos && !std::filesystem::exists(file))
            GTEST_SKIP() << "needs " << file << ", which is missing";
    const Walkers figure(gaits);
    ASSERT_TRUE(figure.run);
    ASSERT_TRUE(figure.walk->footContacts().hasSteps());
    ASSERT_TRUE(figure.run->footContacts().hasSteps());
    const Alone walk = playAlone(figure, figure.walk), run = playAlone(figure, figure.run);
    const double floor = std::min(walk.floor, run.floor);
    const double own = (walk.slide + run.slide) / (walk.seconds + run.seconds);
    std::array<double, 2> slides{}, airs{};
    for (const bool inStep : {false, true}) {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> pause(0.2, 2.0);
        Played played(figure);
        played.play(figure.walk, inStep);
        double air = -1e9;
        for (int fade = 0; fade < 40; ++fade) {
            const bool walks = fade % 2 == 0;
            const int frames = static_cast<int>((kFade + pause(random)) / kUpdate);
            for (int i = 0; i < frames; ++i) {
                played.update(floor);
                if (walks && !played.player->getLayer(1).clip) air = std::max(air, played.lowest);
            }
            played.play(walks ? figure.run : figure.walk, inStep);
        }
        slides[inStep] = played.slide / played.seconds / own;
        airs[inStep] = (air - walk.sole) / figure.leg;
    }
    std::printf(
        "%s: slide of the clips' own %.3f leg lengths a second; fades %.2f, in step %.2f x; "
        "soles in a walk up to %.3f, in step %.3f, the clip's own %.3f leg lengths\n",
        gaits.name, own / figure.leg, slides[0], slides[1], airs[0], airs[1],
        (walk.highest - walk.sole) / figure.leg);
    EXPECT_LT(slides[1], 1.3);
    EXPECT_LT(airs[1], (walk.highest - walk.sole) / figure.leg + kLow);
}

INSTANTIATE_TEST_SUITE_P(Characters, FadeInStep,
                         testing::Values(Gaits{"Knight",
                                               OSGSKIN_SHARED_DATA "/characters/Knight.glb",
                                               "Walking_A", "Running_A"},
                                         Gaits{"CMU", OSGSKIN_DATA "/pedestrian.skin",
                                               OSGSKIN_SHARED_DATA "/cmu/daz/07_01.bvh",
                                               OSGSKIN_SHARED_DATA "/cmu/daz/09_01.bvh"}),
                         [](const auto& each) { return std::string(each.param.name); });
