// SPDX-License-Identifier: MIT
// Pictures of a person who is as small as those that show shared poses.
#include "SmallCamera.h"
#include "WalkedPath.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>
#include <osgSkinMotion/MakeWalker>

#include <osg/TriangleIndexFunctor>
#include <osgDB/Options>

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace {

constexpr int kWidth = 160, kHeight = 130;

/// A picture without perspective: which pixels a figure covers.
struct Silhouette {
    std::vector<bool> covered = std::vector<bool>(std::size_t(kWidth * kHeight));

    bool at(int x, int y) const {
        return x >= 0 && y >= 0 && x < kWidth && y < kHeight &&
               covered[std::size_t(y * kWidth + x)];
    }
    void add(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c) {
        const auto side = [](const osg::Vec2d& p, const osg::Vec2d& q, const osg::Vec2d& at) {
            return (q.x() - p.x()) * (at.y() - p.y()) - (q.y() - p.y()) * (at.x() - p.x());
        };
        const int left = int(std::min({a.x(), b.x(), c.x()})),
                  top = int(std::min({a.y(), b.y(), c.y()}));
        for (int y = std::max(top, 0);
             y < std::min(kHeight, int(std::max({a.y(), b.y(), c.y()})) + 1); ++y)
            for (int x = std::max(left, 0);
                 x < std::min(kWidth, int(std::max({a.x(), b.x(), c.x()})) + 1); ++x) {
                const osg::Vec2d at(x + 0.5, y + 0.5);
                const double ab = side(a, b, at), bc = side(b, c, at), ca = side(c, a, at);
                if ((ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0))
                    covered[std::size_t(y * kWidth + x)] = true;
            }
    }
};

struct Triangles {
    std::vector<unsigned int> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        corners.insert(corners.end(), {a, b, c});
    }
};

/// \param angle from which it is looked at, about the vertical
/// \param toPicture from the space of the vertices to pixels, Z up
Silhouette silhouetteOf(const std::set<const osg::Drawable*>& drawn, double angle,
                        const osg::Matrixd& toPicture) {
    Silhouette result;
    for (const osg::Drawable* drawable : drawn) {
        osg::TriangleIndexFunctor<Triangles> triangles;
        drawable->accept(triangles);
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*drawable->asGeometry()->getVertexArray());
        const auto at = [&](std::size_t corner) {
            const osg::Vec3d vertex = osg::Vec3d(vertices[triangles.corners[corner]]) * toPicture;
            return osg::Vec2d(0.5 * kWidth + vertex.x() * std::cos(angle) +
                                  vertex.y() * std::sin(angle),
                              10.0 + vertex.z());
        };
        for (std::size_t i = 0; i < triangles.corners.size(); i += 3)
            result.add(at(i), at(i + 1), at(i + 2));
    }
    return result;
}

/// By how many pixels what one covers is away from what the other one covers, at most.
int apart(const Silhouette& a, const Silhouette& b) {
    const auto covers = [](const Silhouette& s, int x, int y, int reach) {
        for (int v = y - reach; v <= y + reach; ++v)
            for (int u = x - reach; u <= x + reach; ++u)
                if (s.at(u, v)) return true;
        return false;
    };
    int most = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            while (most < kHeight && ((a.at(x, y) && !covers(b, x, y, most)) ||
                                      (b.at(x, y) && !covers(a, x, y, most))))
                ++most;
    return most;
}

} // namespace

TEST(Silhouette, OfASharedPoseIsThatOfTheOwnToAPixel) {
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options("colours=merged");
    const osg::ref_ptr<osgSkin::Walker> person = osgSkin::makeWalker(
        *osgSkin::loadCharacter(OSGSKIN_DATA "/pedestrian.skin", osgSkin::toLoadOptions(words))
             .root);
    person->setVaried(false);
    constexpr double kTall = 1.75; // m
    const double scale = person->getOwnPoseSize() / kTall;
    const osg::Matrixd toPicture =
        person->getGaits()->get().toWalker * osg::Matrixd::scale(scale, scale, scale);
    for (const double speed : {0.0, 0.5, 0.7, 1.0, 1.3, 1.5, 2.0, 3.2, -0.8}) {
        walking::Walk own(osg::clone(person.get(), osg::CopyOp()));
        walking::Walk shared(osg::clone(person.get(), osg::CopyOp()));
        own.walker->setOwnPoseSize(80.0);
        shared.walker->setOwnPoseSize(1e6);
        walking::Camera camera(17.0); // which sees 89 pixels
        int worst = 0;
        for (int i = 0; i < 190; ++i) {
            for (walking::Walk* walk : {&own, &shared})
                walk->show({speed * i / 60.0, 0, 0}, 0.0, 1.0 / 60.0);
            const auto drawnOwn = camera.see(*own.transform),
                       drawnShared = camera.see(*shared.transform);
            if (i < 90) continue; // until it keeps its speed
            ASSERT_NE(drawnOwn, drawnShared);
            for (const double angle : {0.0, 0.8}) {
                const int off = apart(silhouetteOf(drawnOwn, angle, toPicture),
                                      silhouetteOf(drawnShared, angle, toPicture));
                worst = std::max(worst, off);
            }
        }
        EXPECT_LE(worst, 1) << speed;
    }
}
