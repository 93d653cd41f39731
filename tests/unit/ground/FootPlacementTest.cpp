// SPDX-License-Identifier: MIT
// The pedestrian on stairs and slopes, beside one on the level floor of the clips.
#include "FindNodes.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/FootPlacement>

#include <gtest/gtest.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Shape>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

using osgSkin::attach;
using osgSkin::FootPlacement;
using Vertices = std::vector<osg::Vec3d>;

constexpr double kFrame = 1.0 / 60.0, kTall = 1.75;
constexpr double kStart = 1.0; ///< where stairs and slopes begin, in front of the figure
constexpr int kSteps = 12;

struct Terrain {
    std::string name;
    double tread = 0.0; ///< 0: a slope
    double rise = 0.0;  ///< of a step; of a slope in a metre
};

/// The height of the ground at a way in front of the start.
double heightAt(const Terrain& terrain, double way) {
    const double on = way - kStart;
    if (on < 0.0) return 0.0;
    if (terrain.tread == 0.0) return on * terrain.rise;
    return terrain.rise * std::min(std::floor(on / terrain.tread) + 1.0, double(kSteps));
}

FootPlacement::Ground groundOf(const Terrain& terrain) {
    return [terrain](const osg::Vec3d& above, const osg::Vec3d&, FootPlacement::Surface& surface) {
        surface.point.set(above.x(), above.y(), heightAt(terrain, -above.y()));
        surface.normal.set(0, 0, 1);
        if (terrain.tread == 0.0 && -above.y() > kStart) surface.normal.set(0, terrain.rise, 1);
        return true;
    };
}

/// A pedestrian that is moved along -Y by its clip.
struct Figure {
    osgSkin::Character character = osgSkin::loadCharacter(OSGSKIN_DATA "/pedestrian.skin");
    osg::ref_ptr<osgSkin::ClipPlayer> player = attach<osgSkin::ClipPlayer>(*character.root);
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<FootPlacement> feet;

    explicit Figure(const std::string& clip = "walk") {
        place->addChild(character.root);
        player->setRoot(osgSkin::ClipPlayer::Root::ExtractedWithTurn);
        player->setLayer(0, {player->clip(clip)});
    }

    /// Shows a time, then moves on.
    void update(double time) { test::updateAt(*place, time); }
    void move(const std::function<double(double)>& height) {
        osg::Matrixd next = player->takeRootMatrix() * osg::Matrixd(place->getMatrix());
        next.setTrans(next.getTrans().x(), next.getTrans().y(), height(-next.getTrans().y()));
        place->setMatrix(next);
    }
    osg::Vec3d joint(const std::string& role) {
        return (osg::Matrixd(character.boneByRole(role)->getMatrixInSkeletonSpace()) *
                character.toWorld * place->getMatrix())
            .getTrans();
    }
    Vertices vertices(bool atRest = false) {
        Vertices result;
        for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(*place)) {
            const osg::Geometry& geometry =
                atRest ? *found.node->getRestGeometry() : *found.node->getDeformedGeometry();
            for (const osg::Vec3& vertex :
                 static_cast<const osg::Vec3Array&>(*geometry.getVertexArray()))
                result.push_back(osg::Vec3d(vertex) * found.toWorld);
        }
        return result;
    }
};

/// The vertices of a foot's sole.
std::vector<std::size_t> soleOf(Figure& figure, std::size_t side) {
    const Vertices rest = figure.vertices(true);
    std::vector<std::size_t> result;
    for (std::size_t v = 0; v < rest.size(); ++v)
        if (rest[v].z() < 0.01 && (rest[v].x() > 0.0) == (side == 0)) result.push_back(v);
    return result;
}

class Grounds : public testing::TestWithParam<Terrain> {};

/// A foot stands where its sole is still on the level floor, and as flat as at rest.
TEST_P(Grounds, CarryTheSolesOfAWalk) {
    const Terrain& terrain = GetParam();
    Figure figure, level;
    figure.feet = attach<FootPlacement>(*figure.character.root);
    figure.feet->setGround(groundOf(terrain));
    const std::array<std::vector<std::size_t>, 2> soles{soleOf(level, 0), soleOf(level, 1)};
    ASSERT_GT(soles[0].size(), 10u);
    // Up and down the middle of the steps.
    const auto slope = [&](double way) {
        if (terrain.tread == 0.0) return heightAt(terrain, way);
        const double step = (way - kStart) / terrain.tread + 0.5;
        return terrain.rise * std::clamp(step, 0.0, double(kSteps));
    };
    const Vertices rest = level.vertices(true);
    Vertices before;
    osg::Vec3d hips;
    std::size_t stood = 0;
    double worst = 0.0, fastest = 0.0, knees = 1e9;
    for (int frame = 0; frame < 300; ++frame) {
        figure.update(frame * kFrame);
        level.update(frame * kFrame);
        const Vertices now = figure.vertices(), flat = level.vertices();
        for (std::size_t side = 0; side < 2 && frame > 0; ++side) {
            double lifted = 0.0, speed = 0.0, nearest = 1e9;
            for (const std::size_t v : soles[side]) {
                lifted = std::max(lifted, flat[v].z() - rest[v].z());
                speed = std::max(speed, (flat[v] - before[v]).length() / kFrame);
                const double over = now[v].z() - heightAt(terrain, -now[v].y());
                nearest = std::min(nearest, over);
            }
            const std::string name = side == 0 ? "Left" : "Right";
            const osg::Vec3d hip = figure.joint(name + "UpperLeg");
            osg::Vec3d line = figure.joint(name + "Foot") - hip;
            line.normalize();
            const osg::Vec3d knee = figure.joint(name + "LowerLeg") - hip;
            knees = std::min(knees, -(knee - line * (knee * line)).y());
            if (lifted > 0.003 || speed > 0.15) continue;
            ++stood;
            worst = std::max(worst, std::abs(nearest));
        }
        const osg::Vec3d hipsNow = figure.joint("Hips");
        if (frame > 0) fastest = std::max(fastest, std::abs(hipsNow.z() - hips.z()));
        hips = hipsNow;
        before = flat;
        figure.move(slope);
        level.move([](double) { return 0.0; });
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_GT(stood, 100u);
    EXPECT_GT(-figure.place->getMatrix().getTrans().y(), 6.0);
    EXPECT_LE(worst, 0.005);
    EXPECT_LE(fastest, 0.03);
    EXPECT_GT(knees, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, Grounds,
                         testing::Values(Terrain{"Upstairs", 0.29, 0.17},
                                         Terrain{"Downstairs", 0.29, -0.17},
                                         Terrain{"UpLowSteps", 0.36, 0.15},
                                         Terrain{"DownLowSteps", 0.36, -0.15},
                                         Terrain{"Uphill", 0.0, std::tan(0.349)},
                                         Terrain{"Downhill", 0.0, -std::tan(0.349)}),
                         [](const auto& each) { return each.param.name; });

double difference(const Vertices& a, const Vertices& b) {
    double most = a.size() == b.size() ? 0.0 : 1e9;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        most = std::max(most, (a[i] - b[i]).length());
    return most;
}

/// Two figures that walk side by side, one of them over a ground.
struct Comparison {
    Figure figure, level;
    int frame = 0;

    Comparison() { figure.feet = attach<FootPlacement>(*figure.character.root); }

    /// The largest difference that the ground makes in some frames of a walk.
    double differenceOn(const FootPlacement::Ground& ground, int frames = 15) {
        figure.feet->setGround(ground);
        double most = 0.0;
        for (const int end = frame + frames; frame < end; ++frame) {
            figure.update(frame * kFrame);
            level.update(frame * kFrame);
            most = std::max(most, difference(figure.vertices(), level.vertices()));
            figure.move([](double) { return 0.0; });
            level.move([](double) { return 0.0; });
        }
        return most;
    }
};

TEST(FootPlacement, ChangeNothingOnALevelFloor) {
    EXPECT_LT(Comparison().differenceOn(groundOf({"level", 0.0, 0.0}), 70), 1e-3 * kTall);
}

TEST(FootPlacement, ChangeNothingWithoutAUsableGround) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    using Surface = FootPlacement::Surface;
    const auto set = [](const osg::Vec3d& point, const osg::Vec3d& normal) {
        return [=](const osg::Vec3d& above, const osg::Vec3d&, Surface& surface) {
            surface.point = osg::Vec3d(above.x(), above.y(), 0.2) + point;
            surface.normal = normal;
            return true;
        };
    };
    const osg::Vec3d up(0, 0, 1);
    Comparison walk;
    EXPECT_EQ(walk.differenceOn({}), 0.0);
    EXPECT_LT(walk.differenceOn([](const auto&, const auto&, Surface&) { return false; }), 1e-5);
    EXPECT_LT(walk.differenceOn(set(osg::Vec3d(0, 0, kNan), up)), 1e-5);
    EXPECT_LT(walk.differenceOn(set({}, osg::Vec3d(0, kNan, 1))), 1e-5);
    EXPECT_LT(walk.differenceOn(set({}, {})), 1e-5);
    EXPECT_LT(walk.differenceOn(set(up, up)), 1e-5); // too high
    EXPECT_GT(walk.differenceOn(set({}, up)), 0.15);
    EXPECT_LT(walk.differenceOn(set({}, osg::Vec3d(0, 0, kNan))), 1e-5);
}

osg::ref_ptr<osg::Node> makeBox(double height) {
    return new osg::ShapeDrawable(
        new osg::Box(osg::Vec3(0, 0, float(0.5 * height)), 4.0f, 4.0f, float(height)));
}

TEST(FootPlacement, StandOnANodeBelowATransform) {
    Figure figure("idle");
    const osg::ref_ptr<osg::MatrixTransform> above =
        new osg::MatrixTransform(osg::Matrixd::translate(0, 0, 0.05));
    const osg::ref_ptr<osg::Node> box = makeBox(0.1);
    above->addChild(box);
    figure.feet = attach<FootPlacement>(*figure.character.root);
    figure.feet->setGround(box.get());
    figure.update(0.0);
    const double hips = figure.joint("Hips").z();
    figure.feet->setGround(nullptr);
    figure.update(0.1);
    EXPECT_NEAR(hips - figure.joint("Hips").z(), 0.15, 0.005); // it breathes
}

TEST(FootPlacement, LeaveOutNodesByTheMask) {
    Figure figure("idle");
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(figure.place);
    scene->addChild(makeBox(0.1));
    figure.place->setNodeMask(2);
    figure.feet = attach<FootPlacement>(*figure.character.root);
    figure.feet->setGround(scene.get(), 1);
    figure.update(0.0);
    double lowest = 1e9;
    for (const osg::Vec3d& vertex : figure.vertices()) lowest = std::min(lowest, vertex.z());
    EXPECT_NEAR(lowest, 0.1, 0.005);
}

TEST(FootPlacement, StandUnderTheManagerOfACharacterAndInItsCopies) {
    const osgSkin::Character character = osgSkin::loadCharacter(OSGSKIN_DATA "/pedestrian.skin");
    attach<FootPlacement>(*character.root)->setGround(groundOf({"", 1e9, 0.1}));
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(0, -2, 0));
    place->addChild(character.root);
    const osg::ref_ptr<osg::MatrixTransform> copy =
        osg::clone(place.get(), osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_CALLBACKS |
                                    osg::CopyOp::DEEP_COPY_DRAWABLES);
    for (const auto& each : {place, copy}) {
        test::updateAt(*each, 0.0);
        test::updateAt(*each, 0.02);
        double lowest = 1e9;
        for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(*each))
            for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(
                     *found.node->getDeformedGeometry()->getVertexArray()))
                lowest = std::min(lowest, (osg::Vec3d(vertex) * found.toWorld).z());
        EXPECT_NEAR(lowest, 0.1, 0.005);
    }
}

TEST(FootPlacement, LeaveTheUpperBodyToItsLayers) {
    Figure figure, level;
    for (Figure* each : {&figure, &level})
        each->player->playOn("Spine", {each->player->clip("wave")}, 0.0);
    figure.feet = attach<FootPlacement>(*figure.character.root);
    figure.feet->setGround([](const osg::Vec3d& above, const osg::Vec3d&, auto& surface) {
        surface.point.set(above.x(), above.y(), above.x() > 0.0 ? 0.1 : 0.0);
        return true;
    });
    figure.update(0.3);
    level.update(0.3);
    const osg::Vec3d lift = figure.joint("Hips") - level.joint("Hips");
    for (const std::string role : {"Head", "RightHand", "LeftHand"})
        EXPECT_NEAR((figure.joint(role) - level.joint(role) - lift).length(), 0.0, 1e-6);
}

TEST(FootPlacement, ShowAPartByTheirWeight) {
    Figure figure("idle");
    figure.feet = attach<FootPlacement>(*figure.character.root);
    std::array<double, 3> hips{};
    for (std::size_t i = 0; i < hips.size(); ++i) {
        figure.feet->setGround([](const osg::Vec3d& above, const osg::Vec3d&, auto& surface) {
            surface.point.set(above.x(), above.y(), 0.2);
            return true;
        });
        figure.feet->setWeight(0.5 * double(i));
        figure.update(0.0);
        hips[i] = figure.joint("Hips").z();
    }
    EXPECT_NEAR(hips[1] - hips[0], 0.1, 1e-3);
    EXPECT_NEAR(hips[2] - hips[0], 0.2, 1e-3);
    figure.feet->setWeight(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(figure.feet->getWeight(), 1.0);
}

} // namespace
