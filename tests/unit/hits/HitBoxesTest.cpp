// SPDX-License-Identifier: MIT
// Capsules and boxes beside the skin that they stand for.
#include "FindNodes.h"
#include "TextFile.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>
#include <osgSkin/SkinHit>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/HitBoxes>

#include <gtest/gtest.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::attach;
using osgSkin::Character;
using osgSkin::HitBoxes;

/// Frames of a clip that are shown, as a file numbers them.
struct Frames {
    std::string clip;
    double perSecond = 0.0;
    int first = 0, end = 0, step = 0;
};

struct Figure {
    std::string name;
    std::string skin; ///< file; empty: MakeHuman's body of this name with CMU's rig
    std::vector<Frames> frames;
};

/// Thirty-six frames of a walk, a pitch, a climb and jumps.
const std::vector<Frames> kCaptured = {{"12_01", 120, 10, 519, 60},
                                       {"124_01", 120, 1, 28, 3},
                                       {"01_03", 120, 400, 4399, 400},
                                       {"01_01", 120, 300, 2699, 300}};

std::string skinFile(const Figure& figure) {
    const std::string shared = OSGSKIN_SHARED_DATA;
    if (!figure.skin.empty()) return figure.skin;
    const std::string mesh = shared + "/makehuman/body/body4k_" + figure.name + ".obj";
    if (!std::filesystem::exists(mesh)) return {};
    const std::string clips = shared + "/cmu/mb/";
    return test::saveText(figure.name + ".skin", R"({ "osgskin": 1, "mesh": ")" + mesh +
                                                     R"(", "unit": 0.1, "skeleton": ")" + shared +
                                                     "/makehuman/rig/cmu_mb_" + figure.name +
                                                     R"(.bvh", "motions": [
            { "name": "12_01", "file": ")" + clips + R"(12_01_walk_pybvh.bvh" },
            { "name": "124_01", "file": ")" + clips + R"(124_01_pitch_excerpt_120hz.bvh" },
            { "name": "01_03", "file": ")" + clips + R"(01_03.bvh" },
            { "name": "01_01", "file": ")" + clips + R"(01_01.bvh" } ] })");
}

/// \param p in the shape's frame
bool isInside(const HitBoxes::Shape& shape, const osg::Vec3d& p) {
    if (shape.kind == HitBoxes::Shape::Kind::Box)
        return std::abs(p.x()) <= shape.half.x() && std::abs(p.y()) <= shape.half.y() &&
               std::abs(p.z()) <= shape.half.z();
    const double over = std::max(0.0, std::abs(p.z()) - shape.half.z());
    return osg::Vec3d(p.x(), p.y(), over).length() <= shape.half.x();
}

bool isInside(const HitBoxes& hits, std::size_t limb, const osg::Vec3d& point) {
    const auto& shapes = hits.limbs()[limb].shapes;
    return std::any_of(shapes.begin(), shapes.end(), [&](const HitBoxes::Shape& shape) {
        return isInside(shape, point * osg::Matrixd::inverse(shape.frame * hits.motion(limb)));
    });
}

double volumeOf(const HitBoxes& hits) {
    double sum = 0.0;
    for (const HitBoxes::Limb& limb : hits.limbs())
        for (const HitBoxes::Shape& shape : limb.shapes) sum += shape.volume();
    return sum;
}

/// The volume of the space that the shapes fill at rest, where overlaps count once, by a grid.
double filledBy(const HitBoxes& hits) {
    std::vector<std::pair<const HitBoxes::Shape*, osg::Matrixd>> shapes; // and into their frames
    osg::BoundingBoxd box;
    for (const HitBoxes::Limb& limb : hits.limbs())
        for (const HitBoxes::Shape& shape : limb.shapes) {
            shapes.emplace_back(&shape, osg::Matrixd::inverse(shape.frame));
            box.expandBy(
                osg::BoundingSphered(shape.frame.getTrans(), shape.half.length() + shape.half.x()));
        }
    const double step = std::cbrt(volumeOf(hits) / 20000.0);
    std::size_t count = 0;
    for (double x = box.xMin(); x < box.xMax(); x += step)
        for (double y = box.yMin(); y < box.yMax(); y += step)
            for (double z = box.zMin(); z < box.zMax(); z += step)
                count += std::any_of(shapes.begin(), shapes.end(), [&](const auto& shape) {
                    return isInside(*shape.first, osg::Vec3d(x, y, z) * shape.second);
                });
    return double(count) * step * step * step;
}

double volumeOf(const Character& character) {
    const auto& mesh = character.body.mesh;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    double sum = 0.0;
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        osg::Vec3d p[3];
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& position = mesh.positions[corners[t + i]];
            p[i] = osg::Vec3d(position.x, position.y, position.z) * character.toWorld;
        }
        sum += p[0] * (p[1] ^ p[2]) / 6.0;
    }
    return std::abs(sum);
}

/// The limb of a joint: its own, or that of the nearest joint above that has one.
std::size_t limbOf(const Character& character, const HitBoxes& hits, int joint) {
    while (joint >= 0) {
        const auto& at = character.rest.joints[std::size_t(joint)];
        if (const int limb = hits.find(at.name); limb >= 0) return std::size_t(limb);
        joint = at.parent;
    }
    return 0;
}

/// The joint whose rotation a vertex of the binding takes by half or more.
int jointOf(const osgSkin::Binding& binding, std::size_t vertex) {
    int joint = 0;
    for (auto i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1]; ++i)
        if (binding.influences[i].bend >= 0.5f) joint = int(binding.influences[i].joint);
    return joint;
}

/// The part of the posed vertices that are inside the shapes of their own limb.
double insideOf(const Character& character, const HitBoxes& hits) {
    std::size_t inside = 0, all = 0;
    const auto count = [&](const osg::Geometry& geometry, const osg::Matrixd& toWorld,
                           const auto& limb) {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            inside += isInside(hits, limb(v), osg::Vec3d(vertices[v]) * toWorld);
            ++all;
        }
    };
    for (const auto& skin : character.skin.skins)
        count(*skin.drawable->getDeformedGeometry(), character.toWorld, [&](std::size_t v) {
            return limbOf(character, hits, jointOf(character.binding, skin.part.sourceVertex[v]));
        });
    for (const auto& part : test::findNodes<osgSkin::RigidPart>(*character.root)) {
        const std::size_t limb =
            limbOf(character, hits, character.rest.find(part.node->getParent(0)->getName()));
        count(*part.node->getChild(0)->asGeometry(), part.toWorld,
              [limb](std::size_t) { return limb; });
    }
    return double(inside) / double(all);
}

class Fitted : public testing::TestWithParam<Figure> {};

} // namespace

TEST_P(Fitted, ContainsTheSkinInAllPoses) {
    const std::string file = skinFile(GetParam());
    if (file.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    Character character = osgSkin::loadCharacter(file);
    const osg::ref_ptr<HitBoxes> hits = attach<HitBoxes>(*character.root);
    std::size_t shapes = 0;
    for (const auto& limb : hits->limbs()) shapes += limb.shapes.size();
    const double volumes = volumeOf(*hits) / volumeOf(character);
    const double filled = filledBy(*hits) / volumeOf(character);
    EXPECT_LE(filled, 1.58);
    EXPECT_GE(filled, 0.95) << "hollow";
    EXPECT_LE(shapes, 116u);
    double least = insideOf(character, *hits), sum = least;
    int poses = 1; // the rest pose
    for (const Frames& frames : GetParam().frames) {
        character.play(frames.clip);
        test::updateAt(*character.root, 0.0);
        for (int frame = frames.first; frame < frames.end; frame += frames.step) {
            test::updateAt(*character.root, frame / frames.perSecond);
            const double inside = insideOf(character, *hits);
            sum += inside;
            least = std::min(least, inside);
            ++poses;
        }
    }
    EXPECT_GE(sum / poses, 0.95);
    EXPECT_GE(least, 0.93);
    std::printf("%s: %zu limbs, %zu shapes, sum of volumes %.2f, filled %.2f; inside in %d poses: "
                "mean %.3f, least %.3f\n",
                GetParam().name.c_str(), hits->limbs().size(), shapes, volumes, filled, poses,
                sum / poses, least);
}

INSTANTIATE_TEST_SUITE_P(
    Figures, Fitted,
    testing::Values(Figure{"thrower", OSGSKIN_DATA "/thrower.skin", {{"throw", 60, 0, 185, 5}}},
                    Figure{"pedestrian",
                           OSGSKIN_DATA "/pedestrian.skin",
                           {{"walk", 60, 0, 60, 5},
                            {"run", 60, 0, 40, 5},
                            {"wave", 60, 0, 80, 10},
                            {"idle", 60, 0, 90, 10}}},
                    Figure{"neutral", "", kCaptured}, Figure{"child", "", kCaptured},
                    Figure{"female_old", "", kCaptured}, Figure{"male_heavy", "", kCaptured},
                    Figure{"girl", "", kCaptured}, Figure{"toddler", "", kCaptured}),
    [](const auto& figure) { return figure.param.name; });

namespace {

/// The pedestrian in the middle of a step, or at rest.
class Pedestrian : public testing::Test {
protected:
    void SetUp() override {
        character = osgSkin::loadCharacter(OSGSKIN_DATA "/pedestrian.skin");
        place->addChild(character.root);
    }
    std::size_t limb(const std::string& role) {
        return std::size_t(hits->find(character.boneByRole(role)->getName()));
    }
    void show(double time) {
        character.play("walk");
        test::updateAt(*place, 0.0);
        test::updateAt(*place, time);
    }

    Character character;
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<HitBoxes> hits;
};

/// Where a bone carries a point that is given at rest.
osg::Vec3d carried(const osgAnimation::Bone& bone, const osg::Matrixd& toWorld,
                   const osg::Vec3d& point) {
    return point * osg::Matrixd::inverse(toWorld) * bone.getInvBindMatrixInSkeletonSpace() *
           bone.getMatrixInSkeletonSpace() * toWorld;
}

} // namespace

TEST_F(Pedestrian, HasLimbsWithParentsFirst) {
    hits = attach<HitBoxes>(*character.root);
    std::set<std::string> joints;
    for (std::size_t i = 0; i < hits->limbs().size(); ++i) {
        const HitBoxes::Limb& at = hits->limbs()[i];
        EXPECT_TRUE(joints.insert(at.joint).second) << at.joint;
        EXPECT_LT(at.parent, int(i));
        EXPECT_EQ(at.parent < 0, i == 0) << at.joint;
        ASSERT_FALSE(at.shapes.empty());
        for (const HitBoxes::Shape& shape : at.shapes) EXPECT_GT(shape.volume(), 0.0);
        const osg::Vec3d centre =
            osg::Vec3d(
                osg::Matrixd::inverse(character.bone(at.joint)->getInvBindMatrixInSkeletonSpace())
                    .getTrans()) *
            character.toWorld;
        EXPECT_LT((at.centre - centre).length(), 1e-6) << at.joint;
    }
    EXPECT_EQ(hits->limbs()[std::size_t(hits->limbs()[limb("LeftLowerArm")].parent)].joint,
              character.boneByRole("LeftUpperArm")->getName());
    EXPECT_EQ(hits->find("Tail"), -1);
}

TEST_F(Pedestrian, BendsKneesBackwardsAndElbowsForwards) {
    hits = attach<HitBoxes>(*character.root);
    for (const std::string side : {"Left", "Right"}) {
        const auto& knee = hits->limbs()[limb(side + "LowerLeg")];
        EXPECT_GT(knee.hinge.x(), 0.95) << side; // shins hang down, and go to +Y
        EXPECT_NEAR(knee.straight, 0.0, 0.2);
        const auto& elbow = hits->limbs()[limb(side + "LowerArm")];
        osg::Vec3d forearm = hits->limbs()[limb(side + "Hand")].centre - elbow.centre;
        forearm.normalize();
        EXPECT_LT((elbow.hinge ^ forearm).y(), -0.9) << side; // the figure faces -Y
        EXPECT_NEAR(elbow.bent - elbow.straight, 2.6, 1e-9);
    }
    EXPECT_EQ(hits->limbs()[limb("Head")].hinge, osg::Vec3d());
}

TEST_F(Pedestrian, HasOneShapeALimbIfAsked) {
    HitBoxes::Options options;
    options.maxShapes = 0; // clamped
    options.smallest = 0.004;
    hits = attach<HitBoxes>(*character.root, options);
    EXPECT_GE(hits->limbs().size(), 15u);
    EXPECT_LE(hits->limbs().size(), 20u);
    for (const HitBoxes::Limb& at : hits->limbs()) EXPECT_EQ(at.shapes.size(), 1u) << at.joint;
    EXPECT_LT(volumeOf(*hits), 2.4 * volumeOf(character));
    EXPECT_GT(insideOf(character, *hits), 0.9);
}

TEST_F(Pedestrian, IsPickedAsItsSkinIs) {
    hits = attach<HitBoxes>(*character.root);
    show(0.3);
    int both = 0, skinOnly = 0, near = 0, sameLimb = 0;
    double sum = 0.0;
    for (double x = -0.4; x <= 0.4; x += 0.02)
        for (double z = 0.05; z <= 1.75; z += 0.05) {
            const osg::Vec3d start(x, -2.0, z), end(x, 2.0, z);
            const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
                new osgUtil::LineSegmentIntersector(start, end);
            osgUtil::IntersectionVisitor visitor(line);
            character.root->accept(visitor);
            const auto hit = hits->pick(start, end);
            if (!line->containsIntersections()) continue;
            if (!hit) {
                ++skinOnly;
                continue;
            }
            ++both;
            const auto at = line->getFirstIntersection();
            const double away = (at.getWorldIntersectPoint() - hit->point).length();
            near += away < 0.05;
            sum += away;
            sameLimb += limbOf(character, *hits,
                               character.rest.find(osgSkin::skinHit(at)->joint)) == hit->limb;
            EXPECT_NEAR(hit->distance, (hit->point - start).length(), 1e-9);
            EXPECT_NEAR(hit->normal.length(), 1.0, 1e-9);
            EXPECT_LT(hit->normal * (end - start), 0.0);
        }
    std::printf("%d lines, %d miss; mean %.4f m, within 5 cm %d, same limb %d\n", both, skinOnly,
                sum / both, near, sameLimb);
    ASSERT_GT(both, 200);
    EXPECT_LT(skinOnly, 0.03 * both);
    EXPECT_LT(sum / both, 0.035);
    EXPECT_GT(near, 0.8 * both);
    EXPECT_GT(sameLimb, 0.8 * both);
}

TEST_F(Pedestrian, IsMissedBesideIt) {
    hits = attach<HitBoxes>(*character.root);
    EXPECT_FALSE(hits->pick({2, -2, 1}, {2, 2, 1}));
    EXPECT_FALSE(hits->pick({0, -2, 1}, {0, -1, 1})) << "ends before it";
    EXPECT_FALSE(hits->pick({0, -2, 1}, {0, -3, 1})) << "away from it";
    const auto within = hits->pick({0, 0, 1}, {0, -3, 1});
    ASSERT_TRUE(within);
    EXPECT_EQ(within->distance, 0.0) << "starts inside";
    EXPECT_FALSE(hits->pick({0, std::nan(""), 1}, {0, 2, 1}));
    EXPECT_FALSE(hits->pick({0, -2, 1}, {0, std::numeric_limits<double>::infinity(), 1}));
}

TEST_F(Pedestrian, HasDistances) {
    hits = attach<HitBoxes>(*character.root);
    for (const osg::Vec3d& point : {osg::Vec3d(0.5, -0.3, 1.2), osg::Vec3d(0, 0, 2.0),
                                    osg::Vec3d(-0.3, 0.4, 0.2), osg::Vec3d(0, 0.0, 1.1)}) {
        const auto nearest = hits->nearest(point);
        ASSERT_TRUE(nearest);
        EXPECT_NEAR(std::abs(nearest->distance), (nearest->point - point).length(), 1e-9);
        EXPECT_LT((point + nearest->normal * -nearest->distance - nearest->point).length(), 1e-9);
        EXPECT_EQ(nearest->distance < 0.0, point.x() == 0.0 && point.z() < 1.5);
        // Nothing is met on the way to it, and it is met on the way through it.
        if (nearest->distance < 0.0) continue;
        EXPECT_FALSE(hits->pick(point, point + (nearest->point - point) * 0.999));
        EXPECT_TRUE(hits->pick(point, point + (nearest->point - point) * 1.001));
    }
    EXPECT_FALSE(hits->nearest({0, std::nan(""), 0}));
}

TEST_F(Pedestrian, MovesWithItsBones) {
    hits = attach<HitBoxes>(*character.root);
    for (const double time : {0.2, 0.5, 0.7}) {
        show(time);
        for (std::size_t i = 0; i < hits->limbs().size(); ++i) {
            const HitBoxes::Limb& at = hits->limbs()[i];
            const osg::Vec3d point = at.shapes[0].frame.getTrans() + osg::Vec3d(0.1, 0.2, 0.3);
            const osg::Vec3d expected =
                carried(*character.bone(at.joint), character.toWorld, point);
            EXPECT_LT((point * hits->motion(i) - expected).length(), 1e-6) << at.joint;
        }
    }
}

TEST_F(Pedestrian, StaysInTheFiguresSpace) {
    hits = attach<HitBoxes>(*character.root);
    show(0.3);
    const osg::Matrixd before = hits->motion(3);
    place->setMatrix(osg::Matrixd::translate(7, 8, 9)); // the application's own
    test::updateAt(*place, 0.3);
    EXPECT_EQ(hits->motion(3), before);
}

TEST_F(Pedestrian, IgnoresScalesOfBones) {
    hits = attach<HitBoxes>(*character.root);
    osgAnimation::Bone& bone = *character.boneByRole("Head");
    bone.setMatrixInSkeletonSpace(osg::Matrixd::scale(2, 3, 4) *
                                  osg::Matrixd(bone.getMatrixInSkeletonSpace()));
    hits->update();
    osg::Matrixd inverse;
    ASSERT_TRUE(inverse.invert(hits->motion(limb("Head"))));
    EXPECT_LT(((osg::Vec3d(1, 2, 3) * hits->motion(limb("Head"))) -
               (osg::Vec3d(0, 0, 0) * hits->motion(limb("Head"))))
                      .length() -
                  std::sqrt(14.0),
              1e-6);
}

TEST_F(Pedestrian, KeepsThePoseWhereABoneIsNotFinite) {
    hits = attach<HitBoxes>(*character.root);
    show(0.3);
    const std::size_t arm = limb("LeftUpperArm");
    const osg::Matrixd before = hits->motion(arm);
    osg::Matrixd broken;
    broken(3, 1) = std::nan("");
    character.boneByRole("LeftUpperArm")->setMatrixInSkeletonSpace(broken);
    hits->update();
    EXPECT_EQ(hits->motion(arm), before);
    EXPECT_TRUE(hits->pick({0, -2, 1.2}, {0, 2, 1.2}));
}

TEST_F(Pedestrian, CarriesLimbsWhoseBoneIsMissing) {
    hits = attach<HitBoxes>(*character.root);
    osgAnimation::Bone& arm = *character.boneByRole("LeftUpperArm");
    const osg::ref_ptr<osgAnimation::Bone> forearm = character.boneByRole("LeftLowerArm");
    const std::size_t upper = limb("LeftUpperArm"), lower = limb("LeftLowerArm");
    const osg::Matrixd before = hits->motion(upper);
    arm.removeChild(forearm);
    const osg::ref_ptr<osg::Node> copy =
        osg::clone(character.root.get(),
                   osg::CopyOp(osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_CALLBACKS));
    test::updateAt(*copy, 0.3);
    const HitBoxes* copied = nullptr;
    for (osg::Callback* c = copy->getUpdateCallback(); c; c = c->getNestedCallback())
        if (auto* found = dynamic_cast<HitBoxes*>(c)) copied = found;
    ASSERT_TRUE(copied);
    EXPECT_EQ(&copied->limbs(), &hits->limbs()) << "shared";
    EXPECT_NE(copied->motion(upper), before);
    EXPECT_EQ(copied->motion(lower), copied->motion(upper));
    EXPECT_EQ(hits->motion(upper), before) << "the original has not moved";
}

TEST_F(Pedestrian, TakesThePoseThatItGives) {
    hits = attach<HitBoxes>(*character.root);
    show(0.3);
    std::vector<osg::Matrixd> pose;
    for (std::size_t i = 0; i < hits->limbs().size(); ++i)
        pose.push_back(hits->motion(i) * osg::Matrixd::translate(0.5, 0.0, 0.25));
    struct Take : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            traverse(node, nv);
            EXPECT_TRUE(hits->takePose(*pose));
        }
        HitBoxes* hits = nullptr;
        const std::vector<osg::Matrixd>* pose = nullptr;
    };
    const osg::ref_ptr<Take> take = new Take;
    take->hits = hits;
    take->pose = &pose;
    character.bone(hits->limbs()[0].joint)->addUpdateCallback(take);
    show(0.8); // another pose of the clip
    for (std::size_t i = 0; i < pose.size(); ++i) {
        const osg::Vec3d centre = hits->limbs()[i].centre;
        for (const osg::Vec3d& point : {centre, centre + osg::Vec3d(0.1, 0.2, 0.3)})
            EXPECT_LT((point * hits->motion(i) - point * pose[i]).length(), 2e-3)
                << hits->limbs()[i].joint;
    }
    EXPECT_GT(insideOf(character, *hits), 0.94) << "the skin follows";
}

TEST_F(Pedestrian, KeepsLengthsOfBonesThatArePulledApart) {
    hits = attach<HitBoxes>(*character.root);
    std::vector<osg::Matrixd> pose(hits->limbs().size());
    const std::size_t arm = limb("LeftLowerArm");
    const osg::Vec3d elbow = hits->limbs()[arm].centre;
    pose[arm] = osg::Matrixd::translate(-elbow) *
                osg::Matrixd::rotate(osg::DegreesToRadians(50.0), osg::X_AXIS) *
                osg::Matrixd::translate(elbow + osg::Vec3d(0.1, 0.0, 0.0));
    ASSERT_TRUE(hits->takePose(pose));
    hits->update();
    EXPECT_LT((elbow * hits->motion(arm) - elbow).length(), 1e-6);
    EXPECT_NEAR(osg::RadiansToDegrees(2.0 * std::acos(hits->motion(arm).getRotate().w())), 50.0,
                1e-4);
}

TEST_F(Pedestrian, RefusesUnusablePoses) {
    hits = attach<HitBoxes>(*character.root);
    std::vector<osg::Matrixd> pose(hits->limbs().size());
    pose[2](3, 0) = std::nan("");
    const osg::Matrixd before = hits->motion(2);
    EXPECT_FALSE(hits->takePose(pose));
    EXPECT_FALSE(hits->takePose({}));
    hits->update();
    EXPECT_EQ(hits->motion(2), before);
    EXPECT_TRUE((new HitBoxes)->limbs().empty());
}

TEST_F(Pedestrian, IsShownByLines) {
    hits = attach<HitBoxes>(*character.root);
    const osg::ref_ptr<osg::Node> lines = hits->makeLines();
    show(0.3);
    const osg::Group& group = *lines->asGroup();
    std::size_t next = 0;
    for (std::size_t i = 0; i < hits->limbs().size(); ++i)
        for (const HitBoxes::Shape& shape : hits->limbs()[i].shapes) {
            const auto& at = dynamic_cast<const osg::MatrixTransform&>(
                *group.getChild(static_cast<unsigned int>(next++)));
            EXPECT_EQ(at.getMatrix(), shape.frame * hits->motion(i));
            const osg::BoundingBox box = at.getChild(0)->asGeometry()->getBoundingBox();
            const double high =
                shape.half.z() +
                (shape.kind == HitBoxes::Shape::Kind::Capsule ? shape.half.x() : 0.0);
            EXPECT_NEAR(box.zMax(), high, 1e-5);
            EXPECT_NEAR(box.xMin(), -shape.half.x(), 1e-5);
            EXPECT_NEAR(box.yMax(), shape.half.y(), 1e-5);
        }
    EXPECT_EQ(next, group.getNumChildren());
}

TEST_F(Pedestrian, LeavesPropsOut) {
    const double plain = volumeOf(*attach<HitBoxes>(*character.root));
    Character armed = osgSkin::loadCharacter(OSGSKIN_DATA "/pedestrian.skin");
    const osg::ref_ptr<osg::Geometry> sword =
        osg::createTexturedQuadGeometry({0, 0, 0}, {3, 0, 0}, {0, 0, 3});
    armed.boneByRole("RightHand")->addChild(sword);
    EXPECT_NEAR(volumeOf(*attach<HitBoxes>(*armed.root)), plain, 1e-9);
}
