// SPDX-License-Identifier: MIT
#include "WalkingFigure.h"

#include <osgSkin/Error>
#include <osgSkinMotion/Gaits>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

namespace {

using osgSkin::Gaits;

Gaits::Set goodSet() {
    return walking::makeFigureWalker()->getGaits()->get();
}

TEST(Gaits, ContactMayRunOverTheEndOfTheCycle) {
    const Gaits::Contact contact{0.8, 0.2};
    EXPECT_TRUE(contact.contains(0.9));
    EXPECT_TRUE(contact.contains(0.1));
    EXPECT_FALSE(contact.contains(0.5));
    EXPECT_FALSE(Gaits::Contact().contains(0.0));
}

TEST(Gaits, AreSetOnce) {
    const osg::ref_ptr<Gaits> gaits = new Gaits;
    gaits->set(goodSet());
    EXPECT_THROW(gaits->set(goodSet()), osgSkin::Error);
}

struct Fault {
    std::string name, said;
    std::function<void(Gaits::Set&)> make;
};

class BadGaits : public testing::TestWithParam<Fault> {};

TEST_P(BadGaits, AreRejected) {
    Gaits::Set set = goodSet();
    GetParam().make(set);
    const osg::ref_ptr<Gaits> gaits = new Gaits;
    try {
        gaits->set(set);
        FAIL() << "expected an error";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().said), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(gaits->get().standing, nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    Gaits, BadGaits,
    testing::Values(
        Fault{"NoWalk", "no clip", [](Gaits::Set& set) { set.walking.clip = nullptr; }},
        Fault{"NoStanding", "no clip", [](Gaits::Set& set) { set.standing = nullptr; }},
        Fault{"NoStride", "stride", [](Gaits::Set& set) { set.walking.stride = 0.0; }},
        Fault{"NearlyNoStride", "expected 1e-9 to 1e12",
              [](Gaits::Set& set) { set.walking.stride = 5e-324; }},
        Fault{"EndlessStride", "expected 1e-9 to 1e12",
              [](Gaits::Set& set) { set.walking.stride = 1e300; }},
        Fault{"SoleFarAway", "a sole is not within",
              [](Gaits::Set& set) { set.legs[0].ball.y = 1e19; }},
        Fault{
            "StrideNotANumber", "stride",
            [](Gaits::Set& set) { set.running.stride = std::numeric_limits<double>::quiet_NaN(); }},
        Fault{"ContactBeyondTheCycle", "within 0 to 1",
              [](Gaits::Set& set) { set.walking.contacts[1].end = 1.5; }},
        Fault{"KneeAboveHip", "not below each other",
              [](Gaits::Set& set) { std::swap(set.legs[0].knee, set.legs[0].hip); }},
        Fault{"AnkleNotThere", "not below each other",
              [](Gaits::Set& set) { set.legs[1].ankle = 1000; }},
        Fault{"UnevenScale", "even scale",
              [](Gaits::Set& set) { set.toWalker.preMultScale(osg::Vec3d(1, 2, 1)); }},
        Fault{"OtherJoints", "other joints",
              [](Gaits::Set& set) {
                  set.others = {osgSkin::SampledClip::create("x", {{"a", -1, {}}}, {{}}, 1.0)};
              }}),
    [](const testing::TestParamInfo<Fault>& fault) { return fault.param.name; });

} // namespace
