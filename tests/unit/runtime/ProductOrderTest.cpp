// SPDX-License-Identifier: MIT
// The product's order is the tree's, whatever the order in the file.
#include <osgSkin/Binding>

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

using namespace osgSkin;

namespace {

/// Joints by their names, each after its parent's: "Hips Spine<Hips ...".
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

TEST(ProductOrder, DoesNotFollowTheFiles) {
    const std::string expected = "Hips Spine Neck LArm LHand RArm RHand LLeg LFoot RLeg RFoot";
    EXPECT_EQ(orderOf("Hips Spine<Hips Neck<Spine LArm<Spine LHand<LArm RArm<Spine RHand<RArm "
                      "LLeg<Hips LFoot<LLeg RLeg<Hips RFoot<RLeg"),
              expected);
    EXPECT_EQ(orderOf("Hips RLeg<Hips LLeg<Hips RFoot<RLeg LFoot<LLeg Spine<Hips RArm<Spine "
                      "LArm<Spine Neck<Spine RHand<RArm LHand<LArm"),
              expected);
}

TEST(ProductOrder, LongChainsAndNoneAreOrdered) {
    EXPECT_TRUE(productOrder({}).empty());
    std::vector<BoundJoint> chain(200000);
    for (std::size_t j = 0; j < chain.size(); ++j) chain[j].parent = static_cast<int>(j) - 1;
    const std::vector<std::uint32_t> order = productOrder(chain);
    ASSERT_EQ(order.size(), chain.size());
    EXPECT_EQ(order.back(), chain.size() - 1);
}
