// SPDX-License-Identifier: MIT
#include <osgSkin/Binding>

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace osgSkin;

TEST(Influence, IsFractionalOrPartial) {
    struct Case {
        float bend, twist;
        bool fractional, partial;
    };
    for (const Case& c : {Case{0.0f, 0.0f, false, false}, Case{1.0f, 1.0f, false, false},
                          Case{0.0f, 1.0f, false, true}, Case{1.0f, 0.0f, false, true},
                          Case{0.5f, 0.5f, true, true}, Case{1.0f, 0.25f, true, true},
                          Case{1e-30f, 0.0f, true, true}}) {
        const Influence influence{0, c.bend, c.twist};
        EXPECT_EQ(influence.isFractional(), c.fractional) << c.bend << " " << c.twist;
        EXPECT_EQ(influence.isPartial(), c.partial) << c.bend << " " << c.twist;
    }
}

namespace {

/// Joints from their names, each after its parent's: "Hips Spine<Hips ...".
std::vector<BoundJoint> makeJoints(const std::string& tree) {
    std::vector<BoundJoint> joints;
    std::map<std::string, int> index;
    std::istringstream words(tree);
    for (std::string word; words >> word;) {
        const std::size_t at = word.find('<');
        BoundJoint joint;
        joint.name = word.substr(0, at);
        joint.parent = at == std::string::npos ? -1 : index.at(word.substr(at + 1));
        index[joint.name] = static_cast<int>(joints.size());
        joints.push_back(joint);
    }
    return joints;
}

std::string orderOf(const std::string& tree) {
    const std::vector<BoundJoint> joints = makeJoints(tree);
    std::string result;
    for (const std::uint32_t j : productOrder(joints))
        result += (result.empty() ? "" : " ") + joints[j].name;
    return result;
}

} // namespace

TEST(ProductOrder, IsIndependentOfTheFileOrder) {
    const std::string expected = "Hips Spine Neck LArm LHand RArm RHand LLeg LFoot RLeg RFoot";
    EXPECT_EQ(orderOf("Hips Spine<Hips Neck<Spine LArm<Spine LHand<LArm RArm<Spine RHand<RArm "
                      "LLeg<Hips LFoot<LLeg RLeg<Hips RFoot<RLeg"),
              expected);
    EXPECT_EQ(orderOf("Hips RLeg<Hips LLeg<Hips RFoot<RLeg LFoot<LLeg Spine<Hips RArm<Spine "
                      "LArm<Spine Neck<Spine RHand<RArm LHand<LArm"),
              expected);
}

/// Skin between both legs would follow one shin before the other thigh otherwise.
TEST(ProductOrder, BranchesSideBySideGoDownTogether) {
    std::vector<BoundJoint> joints =
        makeJoints("Hips Spine<Hips Head<Spine LLeg<Hips LFoot<LLeg LToe<LFoot RLeg<Hips "
                   "RTwist<RLeg RFoot<RTwist");
    const glm::dvec3 centres[] = {{0, 4, 0},   {0, 5, 0},    {0, 6, 0},    {0.4, 4, 0}, {0.4, 2, 0},
                                  {0.4, 0, 1}, {-0.4, 4, 0}, {-0.4, 3, 0}, {-0.4, 2, 0}};
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j].centre = centres[j];
    std::string order;
    for (const std::uint32_t j : productOrder(joints)) order += joints[j].name + " ";
    EXPECT_EQ(order, "Hips Spine Head LLeg RLeg LFoot RTwist LToe RFoot ");
}

TEST(ProductOrder, HandlesLongChainsAndNoJoints) {
    EXPECT_TRUE(productOrder({}).empty());
    std::vector<BoundJoint> chain(200000);
    for (std::size_t j = 0; j < chain.size(); ++j) chain[j].parent = static_cast<int>(j) - 1;
    const std::vector<std::uint32_t> order = productOrder(chain);
    ASSERT_EQ(order.size(), chain.size());
    EXPECT_EQ(order.back(), chain.size() - 1);
}
