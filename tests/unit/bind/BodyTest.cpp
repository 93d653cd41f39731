// SPDX-License-Identifier: GPL-3.0-or-later
//
// A body is bound alike for every family of joint names.
#include "JointSpellings.h"
#include "KnownBody.h"
#include "Ratios.h"
#include "RenamedBody.h"
#include "Shapes.h"
#include "SharedBody.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinBind/RigidJoints>
#include <osgSkinBind/RigidSplit>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <set>

using namespace osgSkin;

namespace {

struct Named {
    const char* mesh;
    const char* rig;
    /// How far to move every point from the neutral body towards the male one, 0 to 1; used in
    /// place of `mesh`'s own points.
    double towardsMale = 0.0;
    const char* name = nullptr;
};

void PrintTo(const Named& named, std::ostream* out) {
    *out << named.mesh << " " << named.rig;
}

SkinMesh meshCalled(const std::string& name) {
    return shared::readObj(shared::makehuman() / "body" / (name + ".obj"));
}

RestSkeleton skeletonCalled(const std::string& name) {
    return shared::readJoints(shared::makehuman() / "rig" / ("joints_" + name + ".json"));
}

void move(glm::dvec3& from, const glm::dvec3& to, double share) {
    from += share * (to - from);
}

/// Real bodies, without preparation.
class Body : public testing::TestWithParam<Named> {
protected:
    void SetUp() override {
        const auto meshFile =
            shared::makehuman() / "body" / (std::string(GetParam().mesh) + ".obj");
        const auto rigFile =
            shared::makehuman() / "rig" / ("joints_" + std::string(GetParam().rig) + ".json");
        if (!std::filesystem::exists(meshFile) || !std::filesystem::exists(rigFile))
            GTEST_SKIP() << "needs " << meshFile << " and " << rigFile;
        mesh = meshCalled(GetParam().mesh);
        skeleton = skeletonCalled(GetParam().rig);
        if (GetParam().towardsMale != 0.0) goTowardsMale(GetParam().towardsMale);
        BindOptions options; // nothing moves fingers, toes and faces
        options.rigid =
            automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
        binding = bind(mesh, skeleton, options, &report);
    }

    /// Mean bend ratio of `joint` over the skin in the middle third of the bone from `from` to
    /// `to`.
    double middleThird(const std::string& from, const std::string& to,
                       const std::string& joint) const {
        const std::size_t a = jointCalled(binding, from), b = jointCalled(binding, to);
        const glm::dvec3 way = binding.joints[b].centre - binding.joints[a].centre;
        double sum = 0.0, count = 0.0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            if (binding.regions[v] != a && binding.regions[v] != b) continue;
            const double s =
                glm::dot(mesh.positions[v] - binding.joints[a].centre, way) / glm::dot(way, way);
            if (s < 1.0 / 3.0 || s > 2.0 / 3.0) continue;
            sum += ratiosOf(binding, v, jointCalled(binding, joint)).bend;
            count += 1.0;
        }
        return sum / count;
    }

    void goTowardsMale(double share) {
        const SkinMesh male = meshCalled("body4k_male");
        const RestSkeleton bones = skeletonCalled("cmu_mb_male");
        ASSERT_EQ(mesh.positions.size(), male.positions.size());
        ASSERT_EQ(skeleton.joints.size(), bones.joints.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            move(mesh.positions[v], male.positions[v], share);
        for (std::size_t j = 0; j < bones.joints.size(); ++j) {
            RestJoint& joint = skeleton.joints[j];
            move(joint.centre, bones.joints[j].centre, share);
            if (joint.tip && bones.joints[j].tip) move(*joint.tip, *bones.joints[j].tip, share);
        }
    }

    SkinMesh mesh;
    RestSkeleton skeleton;
    Binding binding;
    BindReport report;
};

class CmuBody : public Body {};

} // namespace

TEST_P(Body, IsBound) {
    expectSound(binding);
    EXPECT_EQ(report.unassigned, 0u);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_LT(report.influencesPerVertex, 2.1) << report.text();
    std::size_t labelled = 0;
    for (const BindReport::Region& region : report.regions) labelled += region.vertices;
    EXPECT_EQ(labelled, mesh.positions.size());
}

TEST_P(Body, HasRigidHandsFeetAndHead) {
    const std::vector<std::string> rigid =
        automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
    ASSERT_EQ(rigid.size(), 5u);
    const RigidSplit split = splitRigid(mesh, binding, rigid);
    for (const std::string& name : rigid) {
        const std::size_t joint = jointCalled(binding, name);
        const auto faces = std::count(split.faceJoint.begin(), split.faceJoint.end(), joint);
        // Counts the faces in the joint's region, which reaches up to half of the limb above.
        std::size_t corner = 0, own = 0;
        for (const std::uint32_t size : mesh.faceSizes) {
            if (binding.regions[mesh.faceVertices[corner]] == joint) ++own;
            corner += size;
        }
        EXPECT_GT(static_cast<double>(faces), 0.5 * static_cast<double>(own)) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Body,
                         testing::Values(Named{"body4k_neutral", "cmu_mb_neutral"},
                                         Named{"body4k_male", "cmu_mb_male"},
                                         Named{"body_neutral", "cmu_mb_neutral"},
                                         Named{"body4k_male", "game_engine_male"},
                                         Named{"body4k_neutral", "default_neutral"}),
                         [](const auto& named) {
                             return std::string(named.param.mesh) + "_" + named.param.rig;
                         });

TEST_P(CmuBody, LimbsStayRigidInTheMiddle) {
    const char* const bones[][2] = {
        {"Arm", "ForeArm"}, {"ForeArm", "Hand"}, {"UpLeg", "Leg"}, {"Leg", "Foot"}};
    for (const std::string side : {"Left", "Right"})
        for (const auto& [own, next] : bones) {
            EXPECT_GE(middleThird(side + own, side + next, side + own), 0.965) << side + own;
            EXPECT_LE(middleThird(side + own, side + next, side + next), 0.01) << side + own;
        }
}

TEST_P(CmuBody, RegionsAgreeWithPaintedWeights) {
    const std::string mesh4k = GetParam().mesh;
    const auto file = shared::makehuman() / "weights" /
                      (mesh4k.substr(0, mesh4k.find('_')) + "_weights_cmu_mb.json");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const auto weights = shared::readWeights(file, skeleton, mesh.positions.size());

    // A joint's region is compared along the joint tree; joints below a rigid one and joints of no
    // length count as the one above.
    const std::vector<std::string> rigid =
        automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
    std::vector<std::size_t> shown(skeleton.joints.size());
    for (std::size_t j = 0; j < shown.size(); ++j) {
        shown[j] = j;
        if (skeleton.joints[j].parent < 0) continue;
        const std::size_t above = shown[static_cast<std::size_t>(skeleton.joints[j].parent)];
        const bool inRigid =
            std::count(rigid.begin(), rigid.end(), skeleton.joints[above].name) > 0;
        if (inRigid || skeleton.joints[j].centre == skeleton.joints[above].centre) shown[j] = above;
    }
    const auto parent = [&](std::size_t j) {
        const int p = skeleton.joints[j].parent;
        return p < 0 ? j : shown[static_cast<std::size_t>(p)];
    };
    std::size_t far = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto most = std::max_element(weights[v].begin(), weights[v].end());
        const std::size_t painted = shown[static_cast<std::size_t>(most - weights[v].begin())];
        const std::size_t ours = shown[binding.regions[v]];
        if (ours != painted && parent(ours) != painted && parent(painted) != ours) ++far;
    }
    EXPECT_LT(static_cast<double>(far), 0.025 * static_cast<double>(mesh.positions.size()));
}

TEST_P(CmuBody, WristTwistSpreadsOverTheForearm) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t i = 0; i < corners.size(); ++i)
        edges.insert(std::minmax(corners[i], corners[i - i % 3 + (i + 1) % 3]));

    const std::vector<glm::dmat4> unmoved(binding.joints.size(), glm::dmat4(1.0));
    const std::vector<glm::dvec3> rest = deform(binding, mesh.positions, unmoved); // rounded alike
    struct Limit {
        double degrees, strain;
    };
    const std::size_t hand = jointCalled(binding, "LeftHand");
    for (const Limit& limit : {Limit{60, 0.03}, Limit{120, 0.07}, Limit{170, 0.105}}) {
        std::vector<glm::dmat4> skinning(binding.joints.size(), glm::dmat4(1.0));
        const glm::dvec3 c = binding.joints[hand].centre;
        for (std::size_t j = hand; j < skinning.size(); ++j)
            if (skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(hand)))
                skinning[j] = glm::translate(glm::dmat4(1.0), c) *
                              glm::rotate(glm::dmat4(1.0), glm::radians(limit.degrees),
                                          binding.joints[hand].twistAxis) *
                              glm::translate(glm::dmat4(1.0), -c);
        const std::vector<glm::dvec3> posed = deform(binding, mesh.positions, skinning);
        double sum = 0.0, count = 0.0;
        for (const auto& [a, b] : edges) {
            const double strain =
                glm::distance(posed[a], posed[b]) / glm::distance(rest[a], rest[b]) - 1.0;
            if (std::abs(strain) < 1e-5) continue; // moved as a whole, or not at all
            sum += strain * strain;
            count += 1.0;
        }
        EXPECT_GT(count, 100.0);
        EXPECT_LE(std::sqrt(sum / count), limit.strain) << "at " << limit.degrees << " degrees";
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, CmuBody,
    testing::Values(Named{"body4k_neutral", "cmu_mb_neutral", 0.0, "Neutral"},
                    Named{"body4k_male", "cmu_mb_male", 0.0, "Male"},
                    Named{"body4k_neutral", "cmu_mb_neutral", -1.0, "AwayFromMale"},
                    Named{"body4k_neutral", "cmu_mb_neutral", 0.5, "HalfWay"},
                    Named{"body4k_neutral", "cmu_mb_neutral", 1.5, "BeyondMale"}),
    [](const auto& named) { return std::string(named.param.name); });

namespace {

enum class LastBone { Tip, EndJoint, Nothing };

/// A cylinder, radius 1 and 8 long, over two joints; the upper half rotates.
class Cylinder : public testing::TestWithParam<std::tuple<int, LastBone>> {
protected:
    void SetUp() override {
        const auto [sides, last] = GetParam();
        mesh = shapes::cylinder(8.0, sides);
        RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
        if (last != LastBone::Tip) skeleton.joints.back().tip.reset();
        if (last == LastBone::EndJoint)
            shapes::addJoint(skeleton, "end", skeleton.joints.back().name, {0, 8, 0});
        BindOptions options; // the ratios alone: pressing folds flat reduces the volume
        options.shapes = BindOptions::Shapes::None;
        binding = bind(mesh, skeleton, options);
    }

    std::vector<glm::dvec3> turned(const glm::dvec3& axis, double degrees) const {
        const glm::dmat4 unit(1.0);
        const glm::dmat4 turn = glm::translate(unit, glm::dvec3(0, 4, 0)) *
                                glm::rotate(unit, glm::radians(degrees), axis) *
                                glm::translate(unit, glm::dvec3(0, -4, 0));
        std::vector<glm::dmat4> skinning(binding.joints.size(), turn);
        skinning[0] = unit;
        return deform(binding, mesh.positions, skinning);
    }

    /// Smallest area of a ring over that at rest.
    double leastArea(const std::vector<glm::dvec3>& points) const {
        std::map<double, std::vector<std::size_t>> rings;
        for (std::size_t v = 0; v < points.size(); ++v)
            if (glm::length(glm::dvec2(mesh.positions[v].x, mesh.positions[v].z)) > 0.99)
                rings[mesh.positions[v].y].push_back(v);
        double least = 1.0;
        for (auto& [height, ring] : rings) {
            std::sort(ring.begin(), ring.end(), [&](std::size_t a, std::size_t b) {
                const glm::dvec3 &p = mesh.positions[a], &q = mesh.positions[b];
                return std::atan2(p.z, p.x) < std::atan2(q.z, q.x);
            });
            glm::dvec3 now(0.0), rest(0.0);
            for (std::size_t k = 0; k < ring.size(); ++k) {
                const std::size_t a = ring[k], b = ring[(k + 1) % ring.size()];
                now += glm::cross(points[a] - points[ring[0]], points[b] - points[ring[0]]);
                rest += glm::cross(mesh.positions[a] - mesh.positions[ring[0]],
                                   mesh.positions[b] - mesh.positions[ring[0]]);
            }
            least = std::min(least, glm::length(now) / glm::length(rest));
        }
        return least;
    }

    double volume(const std::vector<glm::dvec3>& points) const {
        const std::vector<std::uint32_t> corners = mesh.triangles();
        double sum = 0.0;
        for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
            sum += glm::dot(points[corners[t]],
                            glm::cross(points[corners[t + 1]], points[corners[t + 2]]));
        return sum;
    }

    SkinMesh mesh;
    Binding binding;
};

} // namespace

TEST_P(Cylinder, KeepsItsCrossSectionsInTwists) {
    for (double degrees = 0.0; degrees <= 330.0; degrees += 30.0)
        EXPECT_GE(leastArea(turned({0, 1, 0}, degrees)), 0.99) << "at " << degrees;
}

TEST_P(Cylinder, KeepsItsVolumeInBends) {
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)})
        for (double degrees = 30.0; degrees <= 120.0; degrees += 30.0)
            EXPECT_NEAR(volume(turned(axis, degrees)) / volume(mesh.positions), 1.0, 0.01)
                << "at " << degrees;
}

INSTANTIATE_TEST_SUITE_P(All, Cylinder,
                         testing::Combine(testing::Values(8, 16, 48),
                                          testing::Values(LastBone::Tip, LastBone::EndJoint,
                                                          LastBone::Nothing)));

namespace {

/// Only the skeleton matters here.
glm::dvec3 boneAxis(const RestSkeleton& skeleton, const std::string& joint) {
    const Binding binding = bind(shapes::cylinder(), skeleton);
    return binding.joints[jointCalled(binding, joint)].boneAxis;
}

RestSkeleton body() {
    RestSkeleton s;
    shapes::addJoint(s, "Hips", "", {0, 1, 0});
    shapes::addJoint(s, "LHipJoint", "Hips", {0, 1, 0}); // no length
    shapes::addJoint(s, "LeftUpLeg", "LHipJoint", {0.5, 0.9, 0});
    shapes::addJoint(s, "LeftLeg", "LeftUpLeg", {0.5, 0.1, 0});
    shapes::addJoint(s, "Spine", "Hips", {0, 2, -0.1});
    shapes::addJoint(s, "Spine1", "Spine", {0, 3, 0});
    shapes::addJoint(s, "LeftShoulder", "Spine1", {0.2, 3.8, 0.3});
    shapes::addJoint(s, "RightShoulder", "Spine1", {-0.2, 3.8, 0.3});
    shapes::addJoint(s, "Neck", "Spine1", {0, 4.2, 0});
    shapes::addJoint(s, "Head", "Neck", {0, 5, 0});
    s.joints.back().tip = glm::dvec3(0, 6, 0.2);
    shapes::addJoint(s, "LeftHand", "LeftShoulder", {3, 3.8, 0});
    shapes::addJoint(s, "LeftHandThumb", "LeftHand", {3.5, 3.8, 0.01}); // in line, except for a
                                                                        // thumb
    shapes::addJoint(s, "LeftHandIndex", "LeftHand", {3.8, 3.6, 0.2});
    shapes::addJoint(s, "Tail", "LeftHandIndex", {4.4, 3.4, 0.3});
    return s;
}

} // namespace

TEST(Axes, FollowTheChain) {
    const RestSkeleton s = body();
    const auto towards = [&s](const std::string& from, const std::string& to) {
        const auto centre = [&s](const std::string& name) {
            return s.joints[static_cast<std::size_t>(s.find(name))].centre;
        };
        return glm::normalize(centre(to) - centre(from));
    };
    const char* const pairs[][2] = {{"Hips", "Spine"},
                                    {"LHipJoint", "LeftUpLeg"},
                                    {"LeftUpLeg", "LeftLeg"},
                                    {"Spine1", "Neck"},
                                    {"LeftHand", "LeftHandIndex"}};
    for (const auto& [from, to] : pairs)
        EXPECT_LT(glm::distance(boneAxis(s, from), towards(from, to)), 1e-12)
            << from << " should point to " << to;
    EXPECT_LT(glm::distance(boneAxis(s, "Head"), glm::normalize(glm::dvec3(0, 1, 0.2))), 1e-12);
    EXPECT_LT(glm::distance(boneAxis(s, "Tail"), boneAxis(s, "LeftHandIndex")), 1e-12)
        << "a leaf without a tip goes on like its parent";
}

TEST(Axes, SingleJointHasOne) {
    RestSkeleton s;
    shapes::addJoint(s, "only", "", {0, 1, 0});
    EXPECT_EQ(boneAxis(s, "only"), glm::dvec3(0, 1, 0));
}

namespace {

/// Heads, hands, and feet with unmoved fingers and toes.
std::vector<std::string> rigidIn(const RestSkeleton& skeleton,
                                 const std::vector<JointNames>& names = {}) {
    return automaticRigidJoints(skeleton, names, std::vector<bool>(skeleton.joints.size(), false));
}

/// Identical to the last bit, except for the joints' names.
void expectSame(const Binding& a, const Binding& b) {
    ASSERT_EQ(a.joints.size(), b.joints.size());
    for (std::size_t j = 0; j < a.joints.size(); ++j) {
        EXPECT_EQ(a.joints[j].twistAxis, b.joints[j].twistAxis) << a.joints[j].name;
        EXPECT_EQ(a.joints[j].boneAxis, b.joints[j].boneAxis) << a.joints[j].name;
    }
    EXPECT_EQ(a.regions, b.regions);
    EXPECT_EQ(a.firstInfluence, b.firstInfluence);
    ASSERT_EQ(a.influences.size(), b.influences.size());
    for (std::size_t i = 0; i < a.influences.size(); ++i) {
        ASSERT_EQ(a.influences[i].joint, b.influences[i].joint) << i;
        ASSERT_EQ(a.influences[i].bend, b.influences[i].bend) << i;
        ASSERT_EQ(a.influences[i].twist, b.influences[i].twist) << i;
    }
}

class BodyNames : public testing::Test {
protected:
    /// Binds the thrower with the joint names of `family`, and compares with CMU's.
    void expectAlike(const JointNames& family, const BindOptions& options) {
        const auto names = test::namesIn(body.truth, family);
        const RestSkeleton other = test::renamed(body.truth, names);

        std::vector<std::string> expected;
        for (const std::string& name : rigidIn(body.truth)) expected.push_back(names.at(name));
        ASSERT_EQ(expected.size(), 5u); // head, hands, feet
        EXPECT_EQ(rigidIn(other, options.names), expected);

        const Binding theirs = bind(body.mesh, other, options);
        expectSame(bind(body.mesh, body.truth), theirs);
        for (const std::string side : {"Left", "Right"}) {
            const auto hand = std::size_t(body.truth.find(side + "Hand"));
            const auto foreArm = std::size_t(body.truth.find(side + "ForeArm"));
            const glm::dvec3 above =
                glm::normalize(body.truth.joints[hand].centre - body.truth.joints[foreArm].centre);
            EXPECT_LT(glm::distance(theirs.joints[hand].twistAxis, above), 1e-9)
                << "the forearm twists with the hand";
        }
    }

    const KnownBody body = KnownBody::thrower();
};

} // namespace

TEST_F(BodyNames, EveryKnownFamilyIsBoundAlike) {
    for (const JointNames& family : knownJointNames()) {
        if (family.roles.count("LeftThumb1") == 0) continue; // or else "extra" here
        SCOPED_TRACE(family.name);
        expectAlike(family, {});
    }
}

/// Joint names as other tools spell them; a body's head, hands and feet are the same.
TEST_F(BodyNames, EverySpellingHasTheSameRigidParts) {
    const std::map<std::string, std::string> roles = [] {
        std::map<std::string, std::string> result;
        for (const auto& [role, members] : test::knownNames("CMU (MotionBuilder)").roles)
            for (const std::string& member : members) result.emplace(member, role);
        return result;
    }();
    const std::vector<std::string> ours = rigidIn(body.truth);
    for (const test::Dialect& dialect : test::dialects())
        for (const test::SideStyle& side : test::sideStyles())
            for (const std::string prefix : {"mixamorig_", "Neo_", "DEF-"}) {
                std::map<std::string, std::string> names;
                std::map<std::string, int> used;
                for (const RestJoint& joint : body.truth.joints) {
                    const std::string& role = roles.at(joint.name);
                    const bool left = role[0] == 'L', right = role[0] == 'R';
                    const bool has = dialect.names.count(role.substr(left ? 4 : right ? 5 : 0));
                    names[joint.name] =
                        has && used[role]++ == 0
                            ? test::spelled(dialect, role, side, prefix, "_#", names.size())
                            : prefix + "extra_" + std::to_string(names.size());
                }
                std::vector<std::string> expected;
                expected.reserve(ours.size());
                for (const std::string& name : ours) expected.push_back(names.at(name));
                EXPECT_EQ(rigidIn(test::renamed(body.truth, names)), expected)
                    << dialect.name << ", side " << side.text() << ", " << prefix;
            }
}

TEST_F(BodyNames, ASpelledBodyIsBoundAlike) {
    RestSkeleton other = body.truth;
    for (std::size_t j = 0; j < other.joints.size(); ++j) {
        // Such as Neo_LeftArm_04Bone. Without CMU's family, fingers and hips are not recognised.
        other.joints[j].name = "Neo_" + other.joints[j].name + "_" + std::to_string(j) + "Bone";
    }
    expectSame(bind(body.mesh, body.truth), bind(body.mesh, other));
}

TEST_F(BodyNames, NamesOfTheCallersAreBoundAlike) {
    BindOptions options;
    options.names.push_back(test::robotNames());
    expectAlike(options.names.front(), options);
}

TEST_F(BodyNames, WithoutThemTheShapeTells) {
    const auto names = test::namesIn(body.truth, test::robotNames());
    const RestSkeleton robot = test::renamed(body.truth, names);
    std::vector<std::string> expected;
    for (const std::string& name : rigidIn(body.truth)) expected.push_back(names.at(name));
    EXPECT_EQ(rigidIn(robot), expected);

    RestSkeleton folded = robot; // not shaped like a body
    for (RestJoint& joint : folded.joints) {
        joint.centre = glm::dvec3(0.0);
        joint.tip.reset();
    }
    EXPECT_TRUE(rigidIn(folded).empty());
}

TEST_F(BodyNames, WeightsTakeTheirPolesFromTheCallersNames) {
    BindOptions options;
    options.names.push_back(test::robotNames());
    const RestSkeleton robot =
        test::renamed(body.truth, test::namesIn(body.truth, options.names.front()));
    const VertexWeights weights(body.mesh.positions.size(), {{0, 1.0}});
    const Binding theirs = bindWeights(body.mesh, robot, weights, options);
    const Binding ours = bindWeights(body.mesh, body.truth, weights);
    for (std::size_t j = 0; j < ours.joints.size(); ++j)
        EXPECT_EQ(theirs.joints[j].twistAxis, ours.joints[j].twistAxis) << ours.joints[j].name;
}
