// SPDX-License-Identifier: MIT
// From an intersection of osgUtil to the point of a character: vertices, rest position and joint.
#include "FindNodes.h"
#include "TubeSkin.h"
#include "UpdateAt.h"

#include <osgSkin/Deform>
#include <osgSkin/GlmOsg>
#include <osgSkin/RigidPart>
#include <osgSkin/SkinHit>

#include <osg/KdTree>
#include <osg/MatrixTransform>
#include <osg/TriangleFunctor>
#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace {

using osgSkin::DeformableSkin;
using osgSkin::SkinHit;

osgUtil::LineSegmentIntersector::Intersection firstHit(osg::Node& scene, const osg::Vec3d& from,
                                                       const osg::Vec3d& to) {
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
        new osgUtil::LineSegmentIntersector(from, to);
    osgUtil::IntersectionVisitor visitor(line);
    scene.accept(visitor);
    return line->getFirstIntersection();
}

/// Lines from outside to triangles of a drawable, in the world.
struct Lines {
    osg::Matrixd toWorld;
    unsigned int count = 0;
    std::vector<std::pair<osg::Vec3d, osg::Vec3d>> found;

    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false) {
        if (count++ % 23 != 0) return;
        const osg::Vec3d first = osg::Vec3d(a) * toWorld, second = osg::Vec3d(b) * toWorld,
                         third = osg::Vec3d(c) * toWorld;
        osg::Vec3d normal = (second - first) ^ (third - first);
        if (normal.normalize() == 0.0) return;
        const osg::Vec3d point = first * 0.6 + second * 0.3 + third * 0.1;
        found.emplace_back(point + normal * 0.1, point - normal * 0.1);
    }
};

osg::Vec3d mixed(const SkinHit& hit, const std::vector<glm::vec3>& values) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < 3; ++i) sum += hit.ratios[i] * glm::dvec3(values[hit.vertices[i]]);
    return osgSkin::toOsg(sum);
}

} // namespace

/// Rest positions, moved as the scalar reference and the skinning matrices move them, are where the
/// lines hit.
TEST(SkinHit, ReturnsTheRestPositionOfAPosedCharacter) {
    for (const char* options : {"", "rigid=merged", "gpu=on"}) {
        const osg::ref_ptr<osgDB::Options> read = new osgDB::Options(options);
        const osg::ref_ptr<osg::Node> thrower =
            osgDB::readRefNodeFile(OSGSKIN_DATA "/thrower.skin", read);
        ASSERT_NE(thrower, nullptr);
        test::updateAt(*thrower, 0.0);
        test::updateAt(*thrower, 1.3);
        Lines lines;
        for (const auto& found : test::findNodes<osg::Drawable>(*thrower)) {
            osg::TriangleFunctor<Lines> functor;
            functor.toWorld = found.toWorld;
            found.node->accept(functor);
            lines.found.insert(lines.found.end(), functor.found.begin(), functor.found.end());
        }
        const auto skeleton = test::findNodes<osgAnimation::Skeleton>(*thrower).at(0);
        const DeformableSkin& skin = *test::findNodes<DeformableSkin>(*thrower).at(0).node;
        const std::vector<glm::dmat4> skinning = skin.getPose().skinning();
        const auto& joints = skin.getModel()->joints();
        const double size = 1.8;
        std::size_t skins = 0, parts = 0;
        std::set<std::string> names;
        for (const auto& [from, to] : lines.found) {
            const auto at = firstHit(*thrower, from, to);
            const auto hit = osgSkin::skinHit(at);
            if (!hit) continue; // the ball
            names.insert(hit->joint);
            const osg::Vec3d posed =
                at.getWorldIntersectPoint() * osg::Matrixd::inverse(skeleton.toWorld);
            const double unit = osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), skeleton.toWorld)
                                    .length(); // metres
            osg::Vec3d expected;
            if (hit->skin) {
                ++skins;
                const osgSkin::SkinModel& model = *hit->skin->getModel();
                osgSkin::DeformOptions scalar;
                scalar.reference = true;
                expected =
                    mixed(*hit, osgSkin::deform(model, hit->skin->getPose(), scalar).positions);
                EXPECT_LT((mixed(*hit, model.positions()) - hit->rest).length() * unit,
                          1e-9 * size);
            } else {
                ++parts;
                const auto joint = std::find_if(joints.begin(), joints.end(), [&](const auto& one) {
                    return one.name == hit->joint;
                });
                ASSERT_NE(joint, joints.end()) << hit->joint;
                expected =
                    hit->rest * osgSkin::toOsg(skinning[std::size_t(joint - joints.begin())]);
                const auto& array =
                    static_cast<const osg::Vec3Array&>(*hit->geometry->getVertexArray());
                osg::Vec3d local;
                for (std::size_t i = 0; i < 3; ++i)
                    local += osg::Vec3d(array[hit->vertices[i]]) * hit->ratios[i];
                EXPECT_LT((local - at.getLocalIntersectPoint()).length() * unit, 1e-5 * size);
            }
            EXPECT_LT((expected - posed).length() * unit, 1e-5 * size) << options << hit->joint;
        }
        EXPECT_GT(skins, 100u) << options;
        EXPECT_EQ(parts > 10, std::string(options) != "rigid=merged") << options << parts;
        EXPECT_GT(names.size(), 12u) << options;
        EXPECT_EQ(names.count("Head"), 1u) << options;
    }
}

TEST(SkinHit, ReturnsTheJointAndTriangle) {
    const auto skin = test::makeSkin();
    test::bend(*skin, osg::PI_2); // beyond y = 2 the tube points along +z
    const auto joint = [&](const osg::Vec3d& point) {
        const auto hit = osgSkin::skinHit(firstHit(*skin, point + osg::Vec3d(3, 0, 0), point));
        EXPECT_TRUE(hit.has_value());
        if (!hit) return std::string();
        EXPECT_EQ(hit->skin, skin);
        EXPECT_EQ(hit->geometry, skin->getRestGeometry());
        const auto& rest =
            static_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
        for (const unsigned int vertex : hit->vertices)
            EXPECT_LT((osg::Vec3d(rest[vertex]) - hit->rest).length(), 0.6);
        return hit->joint;
    };
    EXPECT_EQ(joint({0, 0.6, 0.1}), "root");
    EXPECT_EQ(joint({0, 2.1, 1.4}), "middle");
    EXPECT_EQ(joint({0, 2.1, 1.8}), "middle");
    EXPECT_EQ(joint({0, 2.1, 2.2}), "end");
    EXPECT_EQ(joint({0, 2.1, 3.7}), "end");
}

TEST(SkinHit, AcceptsPolytopeIntersections) {
    const auto skin = test::makeSkin();
    test::bend(*skin, osg::PI_2);
    osg::Polytope box; // 0.2 wide about a point of the bent tube's side
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            osg::Vec3d normal;
            normal[static_cast<unsigned int>(axis)] = side;
            box.add(osg::Plane(normal, osg::Vec3d(1, 2, 3) - normal * 0.1));
        }
    const osg::ref_ptr<osgUtil::PolytopeIntersector> pick = new osgUtil::PolytopeIntersector(box);
    osgUtil::IntersectionVisitor visitor(pick);
    skin->accept(visitor);
    ASSERT_TRUE(pick->containsIntersections());
    const auto hit = osgSkin::skinHit(pick->getFirstIntersection());
    ASSERT_TRUE(hit.has_value());
    EXPECT_LT((hit->rest - osg::Vec3d(1, 5, 0)).length(), 0.25);
    EXPECT_EQ(hit->joint, "end");
}

/// Rigid meshes below a bone, with transforms between, and with OSG's tree for fast picking.
TEST(SkinHit, ReturnsTheBoneOfAttachedObjects) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
    auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
    const osg::Matrixd posed =
        osg::Matrix::rotate(0.5, osg::Vec3d(0, 0, 1)) * osg::Matrix::translate(0.3, 2.2, 0.1);
    middle.setMatrix(posed);
    const osg::ref_ptr<osg::MatrixTransform> grip =
        new osg::MatrixTransform(osg::Matrix::translate(0, 0, 4));
    const osg::ref_ptr<osg::Geometry> sword = test::makeGeometry(test::Tube());
    grip->addChild(sword);
    middle.addChild(grip);
    for (const bool hasTree : {false, true}) {
        if (hasTree) {
            const osg::ref_ptr<osg::KdTreeBuilder> builder = new osg::KdTreeBuilder;
            sword->accept(*builder);
            ASSERT_NE(sword->getShape(), nullptr);
        }
        const osg::Vec3d point = osg::Vec3d(0.1, 3.3, 4) * posed;
        const auto at = firstHit(*skeleton, point + osg::Vec3d(0, 0, 3), point);
        const auto hit = osgSkin::skinHit(at);
        ASSERT_TRUE(hit.has_value());
        EXPECT_EQ(hit->skin, nullptr);
        EXPECT_EQ(hit->geometry, sword);
        EXPECT_EQ(hit->joint, "middle");
        // The bone rests at (0, 2, 0).
        EXPECT_LT((hit->rest - at.getLocalIntersectPoint() - osg::Vec3d(0, 2, 4)).length(), 1e-9);
        osg::Vec3d local;
        const auto& array = static_cast<const osg::Vec3Array&>(*sword->getVertexArray());
        for (std::size_t i = 0; i < 3; ++i)
            local += osg::Vec3d(array[hit->vertices[i]]) * hit->ratios[i];
        EXPECT_LT((local - at.getLocalIntersectPoint()).length(), 1e-5);
    }
}

TEST(SkinHit, IsEmptyForOtherDrawables) {
    const osg::ref_ptr<osg::Geometry> wall = test::makeGeometry(test::Tube());
    EXPECT_FALSE(osgSkin::skinHit(firstHit(*wall, {5, 3, 0}, {0, 3, 0})).has_value());
    EXPECT_FALSE(osgSkin::skinHit(osgUtil::LineSegmentIntersector::Intersection()).has_value());
    EXPECT_FALSE(osgSkin::skinHit(osgUtil::PolytopeIntersector::Intersection()).has_value());
}
