// SPDX-License-Identifier: MIT
#include <osgSkinMotion/RotateBone>

#include <gtest/gtest.h>

#include <osg/Math>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using osg::Quat;
using osg::Vec3d;
using osgSkin::LimbRotations;
using osgSkin::reachRotations;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Limb {
    Vec3d first, middle, end;

    Limb moved(const LimbRotations& by) const {
        const Vec3d bent = middle + by.lower * (end - middle);
        return {first, first + by.upper * (middle - first), first + by.upper * (bent - first)};
    }
};

const Limb kBent{Vec3d(1, 2, 3), Vec3d(1.3, 1.8, 3.1), Vec3d(1.5, 1.9, 3.2)};

void expectNear(const Vec3d& found, const Vec3d& expected, double tolerance = 1e-9) {
    EXPECT_LT((found - expected).length(), tolerance)
        << found.x() << ' ' << found.y() << ' ' << found.z();
}

struct Case {
    const char* name;
    Limb limb;
    Vec3d way; ///< from the first joint to the target
    Vec3d pole;
    bool reaches;
};
const Limb kStraight{Vec3d(), Vec3d(1, 0, 0), Vec3d(1.8, 0, 0)};
const Limb kFolded{Vec3d(), Vec3d(1, 0, 0), Vec3d(0.2, 0, 0)};
const Limb kEqual{Vec3d(), Vec3d(0, 1, 0), Vec3d(0, 1, 1)};

const Case kCases[] = {
    {"near_by", kBent, Vec3d(0.2, -0.3, 0.1), Vec3d(), true},
    {"towards_a_pole", kBent, Vec3d(0.2, -0.3, 0.1), Vec3d(0, 1, 1), true},
    {"behind", kBent, kBent.first - kBent.end, Vec3d(), true},
    {"where_it_is", kBent, kBent.end - kBent.first, Vec3d(), true},
    {"too_far", kBent, Vec3d(0, 5, 0), Vec3d(0, 0, 1), false},
    {"too_near", kBent, Vec3d(0, 1e-3, 0), Vec3d(0, 0, 1), false},
    {"straight_limb", kStraight, Vec3d(0, 0, 1.2), Vec3d(), true},
    {"straight_limb_with_a_pole", kStraight, Vec3d(1.2, 0, 0), Vec3d(0, 0, -1), true},
    {"straight_limb_along_its_pole", kStraight, Vec3d(1.2, 0, 0), Vec3d(1, 0, 0), true},
    {"straight_limb_stays", kStraight, Vec3d(1.8, 0, 0), Vec3d(), true},
    {"folded_limb", kFolded, Vec3d(0, 1.2, 0), Vec3d(), true},
    {"folds_onto_its_joint", kEqual, Vec3d(), Vec3d(1, 0, 0), true},
};

std::ostream& operator<<(std::ostream& out, const Case& each) {
    return out << each.name;
}

class Reach : public testing::TestWithParam<Case> {};

} // namespace

TEST_P(Reach, MovesTheEndToOrTowardsTheTarget) {
    const auto& [name, limb, way, pole, reaches] = GetParam();
    const LimbRotations found =
        reachRotations(limb.first, limb.middle, limb.end, limb.first + way, pole);
    EXPECT_EQ(found.reaches, reaches);
    const Limb moved = limb.moved(found);
    const double a = (limb.middle - limb.first).length(), b = (limb.end - limb.middle).length();
    EXPECT_NEAR((moved.end - moved.middle).length(), b, 1e-12);
    const double distance = std::clamp(way.length(), std::abs(a - b), a + b);
    EXPECT_NEAR((moved.end - moved.first).length(), distance, 1e-7);
    if (way.length() > 0.0)
        expectNear(moved.end, limb.first + way * (distance / way.length()), 1e-7);
}

TEST_P(Reach, BendsTowardsThePole) {
    const auto& [name, limb, way, pole, reaches] = GetParam();
    const Vec3d side = pole - way * ((pole * way) / way.length2());
    if (!reaches || !(side.length() > 1e-9)) return; // no pole, or along the limb
    const Limb moved =
        limb.moved(reachRotations(limb.first, limb.middle, limb.end, limb.first + way, pole));
    const Vec3d middle = moved.middle - moved.first;
    const Vec3d bent = middle - way * ((middle * way) / way.length2());
    EXPECT_GT(bent.length(), 0.1);
    expectNear(bent / bent.length(), side / side.length());
}

TEST_P(Reach, KeepsTheBendPlaneWithoutAPole) {
    const auto& [name, limb, way, pole, reaches] = GetParam();
    const Vec3d plane = (limb.middle - limb.first) ^ (limb.end - limb.middle);
    if (pole.length() > 0.0 || !(plane.length() > 1e-9)) return;
    const LimbRotations found =
        reachRotations(limb.first, limb.middle, limb.end, limb.first + way, pole);
    const Limb moved = limb.moved(found);
    const Vec3d after = (moved.middle - moved.first) ^ (moved.end - moved.middle);
    expectNear(after / after.length(), found.upper * plane / plane.length());
}

INSTANTIATE_TEST_SUITE_P(Cases, Reach, testing::ValuesIn(kCases),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(ReachRotations, AreIdentitiesForInvalidInput) {
    const Vec3d nan(kNan, 0, 0), remote(1e308, 1e308, 0);
    const std::vector<Limb> limbs{{nan, Vec3d(1, 0, 0), Vec3d(2, 0, 0)},
                                  {Vec3d(), nan, Vec3d(2, 0, 0)},
                                  {Vec3d(), Vec3d(), Vec3d(2, 0, 0)},
                                  {Vec3d(), Vec3d(1, 0, 0), Vec3d(1, 0, 0)},
                                  {Vec3d(), remote, Vec3d(1, 0, 0)}};
    const auto expectNone = [](const LimbRotations& found) {
        EXPECT_FALSE(found.reaches);
        EXPECT_TRUE(found.lower.zeroRotation());
        EXPECT_TRUE(found.upper.zeroRotation());
    };
    for (const Limb& limb : limbs)
        expectNone(reachRotations(limb.first, limb.middle, limb.end, Vec3d(1, 1, 0)));
    expectNone(reachRotations(kBent.first, kBent.middle, kBent.end, nan));
    expectNone(reachRotations(kBent.first, kBent.middle, kBent.end, Vec3d(1, 1, 0), nan));
}

namespace {

/// An arm below a trunk that has moved, each bone with axes of its own.
struct Arm {
    osg::ref_ptr<osgAnimation::Bone> trunk = new osgAnimation::Bone("trunk"),
                                     upper = new osgAnimation::Bone("upper"),
                                     lower = new osgAnimation::Bone("lower"),
                                     hand = new osgAnimation::Bone("hand");
    Arm() {
        place(*trunk, nullptr, Quat(0.3, Vec3d(0, 1, 0)), Vec3d(0.1, 1, 0));
        place(*upper, trunk, Quat(1.2, Vec3d(0, 0, 1)), Vec3d(0.2, 0.4, 0));
        place(*lower, upper, Quat(0.5, Vec3d(1, 0, 0)), Vec3d(0, 0.3, 0));
        place(*hand, lower, Quat(), Vec3d(0, 0.25, 0));
    }
    static void place(osgAnimation::Bone& bone, osgAnimation::Bone* parent, const Quat& rotation,
                      const Vec3d& offset) {
        osg::Matrixd matrix = osg::Matrixd::rotate(rotation) * osg::Matrixd::translate(offset);
        bone.setMatrix(matrix);
        if (parent) {
            parent->addChild(&bone);
            matrix *= parent->getMatrixInSkeletonSpace();
        }
        bone.setMatrixInSkeletonSpace(matrix);
        bone.setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(matrix));
    }
    static Vec3d joint(const osgAnimation::Bone& bone) {
        return osg::Matrixd(bone.getMatrixInSkeletonSpace()).getTrans();
    }
    /// Whether all matrices in skeleton space are the products of the bones' own.
    bool isConsistent() const {
        for (const osgAnimation::Bone* bone : {upper.get(), lower.get(), hand.get()}) {
            const osg::Matrixd product =
                bone->getMatrix() * bone->getBoneParent()->getMatrixInSkeletonSpace();
            for (int i = 0; i < 16; ++i)
                if (std::abs(product.ptr()[i] - bone->getMatrixInSkeletonSpace().ptr()[i]) > 1e-9)
                    return false;
        }
        return true;
    }
};

} // namespace

TEST(RotateBone, MovesTheBonesBelow) {
    Arm arm;
    const Vec3d shoulder = Arm::joint(*arm.upper), hand = Arm::joint(*arm.hand);
    const Quat turn(0.7, Vec3d(0, 0, 1));
    osgSkin::rotateBone(*arm.upper, turn);
    expectNear(Arm::joint(*arm.upper), shoulder);
    expectNear(Arm::joint(*arm.hand), shoulder + turn * (hand - shoulder));
    EXPECT_TRUE(arm.isConsistent());
    osgSkin::rotateBone(*arm.trunk, turn); // a bone without a parent
    EXPECT_TRUE(arm.isConsistent());
}

TEST(RotateBone, ReachMovesAHandToAPoint) {
    Arm arm;
    const Vec3d target = Arm::joint(*arm.upper) + Vec3d(0.1, -0.3, 0.2);
    EXPECT_TRUE(osgSkin::reach(*arm.upper, *arm.lower, *arm.hand, target, Vec3d(0, 0, -1)));
    expectNear(Arm::joint(*arm.hand), target, 1e-7);
    EXPECT_TRUE(arm.isConsistent());
    EXPECT_FALSE(osgSkin::reach(*arm.upper, *arm.lower, *arm.hand, target * 10.0));
}

TEST(RotateBone, LookAtFacesAPointWithinItsLimit) {
    Arm arm;
    const auto facing = [&] {
        const osg::Matrixd moved = osg::Matrixd(arm.hand->getInvBindMatrixInSkeletonSpace()) *
                                   arm.hand->getMatrixInSkeletonSpace();
        return osg::Matrixd::transform3x3(Vec3d(0, 0, 2), moved);
    };
    const auto angleTo = [&](const Vec3d& way) {
        return std::acos(facing() * way / (facing().length() * way.length()));
    };
    const Vec3d way(1, 0, 1); // 45 degrees aside
    EXPECT_TRUE(osgSkin::lookAt(*arm.hand, Vec3d(0, 0, 2), Arm::joint(*arm.hand) + way, 1.0));
    EXPECT_NEAR(angleTo(way), 0.0, 1e-7);
    EXPECT_TRUE(arm.isConsistent());
    const Vec3d behind = -facing();
    EXPECT_FALSE(osgSkin::lookAt(*arm.hand, Vec3d(0, 0, 2), Arm::joint(*arm.hand) + behind, 0.5));
    EXPECT_NEAR(angleTo(behind), osg::PI - 0.5, 1e-7);
    EXPECT_TRUE(arm.isConsistent());
}

TEST(RotateBone, LookAtIgnoresInvalidInput) {
    Arm arm;
    const osg::Matrixd before = arm.hand->getMatrix();
    const Vec3d joint = Arm::joint(*arm.hand), up(0, 1, 0);
    EXPECT_FALSE(osgSkin::lookAt(*arm.hand, Vec3d(), joint + up, 1.0));
    EXPECT_FALSE(osgSkin::lookAt(*arm.hand, up, joint, 1.0));
    EXPECT_FALSE(osgSkin::lookAt(*arm.hand, up, Vec3d(kNan, 0, 0), 1.0));
    EXPECT_FALSE(osgSkin::lookAt(*arm.hand, up, joint + Vec3d(1, 0, 0), kNan));
    EXPECT_FALSE(osgSkin::lookAt(*arm.hand, up, joint + Vec3d(1, 0, 0), -0.1));
    EXPECT_EQ(arm.hand->getMatrix(), before);
}
