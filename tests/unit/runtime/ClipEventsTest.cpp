// SPDX-License-Identifier: MIT
// Events of clips that a player reaches.
#include "BentClip.h"

#include <osgSkinMotion/ClipPlayer>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace played;

using osgSkin::ClipPlayer;
using osgSkin::SampledClip;

namespace {

/// A player of a clip of 12 samples, 0.4 seconds, that writes down the events that it reaches.
struct Listening {
    osg::ref_ptr<const SampledClip> clip = SampledClip::create(someClip(12, 0.3), tubeRig());
    osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    std::string reached;

    void add(double time, char name) {
        player->addEvent(clip, time, {name},
                         [this, name](ClipPlayer&, std::size_t) { reached += name; });
    }
    std::string after(double seconds) {
        reached.clear();
        player->advance(seconds);
        return reached;
    }
};

} // namespace

TEST(ClipEvents, EachTimeIsReachedOnce) {
    for (const double speed : {1.0, 0.3, 2.5, -1.0, -7.0})
        for (const double step : {0.001, kFrame, 0.1, 0.4, 0.7, 5.0}) {
            Listening figure;
            std::vector<int> calls(4, 0);
            const double times[] = {0.0, 0.1, 0.25, 0.3999};
            for (std::size_t e = 0; e < 4; ++e)
                figure.player->addEvent(figure.clip, times[e], "any",
                                        [&, e](ClipPlayer&, std::size_t) { ++calls[e]; });
            figure.player->setLayer(0, {figure.clip, 0.05, speed});
            for (int i = 0; i < 400; ++i) {
                figure.player->advance(step);
                const double time = figure.player->getLayer(0).time;
                for (std::size_t e = 0; e < 4; ++e) {
                    const double first = (0.05 - times[e]) / 0.4, last = (time - times[e]) / 0.4;
                    const double expected = speed > 0.0 ? std::floor(last) - std::floor(first)
                                                        : std::ceil(first) - std::ceil(last);
                    if (std::abs(last - std::round(last)) > 1e-9) {
                        ASSERT_EQ(calls[e], static_cast<int>(expected)) << speed << ' ' << step;
                    }
                }
            }
        }
}

TEST(ClipEvents, AreCalledInTheirOrder) {
    Listening figure;
    figure.add(0.3, 'b');
    figure.add(0.1, 'a');
    figure.player->setLayer(0, {figure.clip});
    EXPECT_EQ(figure.after(1.0), "ababa");
    EXPECT_EQ(figure.after(-0.8), "abab");
    figure.player->setLayer(0, {figure.clip, 0.05});
    EXPECT_EQ(figure.after(0.2), "a");
    EXPECT_EQ(figure.after(-0.2), "a");
    // Of several layers by the time at which each is reached.
    figure.player->setLayer(3, {figure.clip, 0.25, 2.0});
    EXPECT_EQ(figure.after(0.16), "baa") << "b of the faster layer, a of the other, and its own";
}

TEST(ClipEvents, CountWhereALayerStarts) {
    Listening figure;
    figure.add(0.0, 'a');
    figure.player->setLayer(0, {figure.clip, 0.0, 0.0});
    EXPECT_EQ(figure.after(1.0), "") << "it stands still";
    figure.player->setSpeed(0, 1.0);
    EXPECT_EQ(figure.after(0.1), "a");
    EXPECT_EQ(figure.after(0.1), "");
    figure.player->seek(0, 0.0);
    EXPECT_EQ(figure.after(0.1), "a");
    figure.player->setLayer(0, figure.player->getLayer(0));
    figure.player->setLayer(0, {figure.clip, 0.0});
    EXPECT_EQ(figure.after(-0.1), "a");
    EXPECT_EQ(figure.after(0.05), "");
}

TEST(ClipEvents, NeedAWeightAndACallback) {
    Listening figure;
    figure.add(0.1, 'a');
    figure.add(std::nan(""), 'b');
    figure.player->addEvent(nullptr, 0.1, "a", [](ClipPlayer&, std::size_t) {});
    figure.player->addEvent(figure.clip, 0.1, "a");
    ClipPlayer::Layer layer{figure.clip};
    layer.weight = 0.0;
    figure.player->setLayer(1, layer);
    EXPECT_EQ(figure.after(0.2), "");
    figure.player->fade(1, 1.0, 1.0);
    EXPECT_EQ(figure.after(0.4), "a");
    figure.player->removeEvents(figure.clip);
    EXPECT_EQ(figure.after(0.4), "");
    EXPECT_NEAR(figure.player->getLayer(1).time, 1.0, 1e-9);
}

TEST(ClipEvents, GetTheirFunctionByName) {
    Listening figure;
    for (const double time : {0.1, 0.3}) figure.player->addEvent(figure.clip, time, "step");
    figure.add(0.2, 'b');
    figure.player->setLayer(0, {figure.clip});
    EXPECT_EQ(figure.after(0.4), "b");
    figure.player->onEvent("step", [&](ClipPlayer&, std::size_t) { figure.reached += 's'; });
    EXPECT_EQ(figure.after(0.4), "sbs");
}

TEST(ClipEvents, OfClipsThatPlayOnce) {
    Listening figure;
    figure.add(0.0, 'a');
    figure.add(0.4, 'z'); // after the last sample
    ClipPlayer::Layer layer{figure.clip, 0.0, 1.0, false};
    figure.player->setLayer(0, layer);
    EXPECT_EQ(figure.after(3.0), "az");
    EXPECT_EQ(figure.after(3.0), "");
    layer.fadeOut = 0.1;
    figure.player->setLayer(0, layer);
    EXPECT_EQ(figure.after(11.0 * kFrame), "az");
    EXPECT_FALSE(figure.player->getLayer(0).clip);
}

TEST(ClipEvents, OfOneStepAreLimited) {
    Listening figure;
    figure.add(0.1, 'a');
    figure.player->setLayer(0, {figure.clip});
    EXPECT_EQ(figure.after(1e6).size(), 1000u);
    EXPECT_LE(figure.after(1e300).size(), 1000u);
}

TEST(ClipEvents, MayChangeWhatIsPlayed) {
    Listening figure;
    std::vector<std::size_t> layers;
    figure.player->addEvent(figure.clip, 0.1, "a", [&](ClipPlayer& player, std::size_t layer) {
        layers.push_back(layer);
        player.removeEvents(figure.clip);
        figure.add(0.3, 'c');
        player.setLayer(7, {figure.clip, 0.2});
        player.advance(0.15); // reaches c in both layers
    });
    figure.player->setLayer(2, {figure.clip, 0.0});
    EXPECT_EQ(figure.after(0.2), "cc");
    EXPECT_EQ(layers, std::vector<std::size_t>{2});
    EXPECT_EQ(figure.after(0.4), "cc");
}
