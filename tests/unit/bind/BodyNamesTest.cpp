// SPDX-License-Identifier: GPL-3.0-or-later
//
// A body is bound alike for every family of joint names.
#include "JointSpellings.h"
#include "KnownBody.h"
#include "RenamedBody.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinBind/RigidJoints>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <map>

using namespace osgSkin;

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

TEST_F(BodyNames, AllKnownConventionsBindAlike) {
    for (const JointNames& family : knownJointNames()) {
        if (family.roles.count("LeftThumb1") == 0) continue; // or else "extra" here
        SCOPED_TRACE(family.name);
        expectAlike(family, {});
    }
}

/// Joint names as other tools spell them; a body's head, hands and feet are the same.
TEST_F(BodyNames, RigidPartsDoNotDependOnSpelling) {
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

TEST_F(BodyNames, PrefixesAndNumbersAreIgnored) {
    RestSkeleton other = body.truth;
    for (std::size_t j = 0; j < other.joints.size(); ++j) {
        // Such as Neo_LeftArm_04Bone. Without CMU's family, fingers and hips are not recognised.
        other.joints[j].name = "Neo_" + other.joints[j].name + "_" + std::to_string(j) + "Bone";
    }
    expectSame(bind(body.mesh, body.truth), bind(body.mesh, other));
}

TEST_F(BodyNames, CustomNamesBindAlike) {
    BindOptions options;
    options.names.push_back(test::robotNames());
    expectAlike(options.names.front(), options);
}

TEST_F(BodyNames, RigidPartsAreFoundByShapeWithoutKnownNames) {
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

TEST_F(BodyNames, BindWeightsTakesPolesFromCustomNames) {
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
