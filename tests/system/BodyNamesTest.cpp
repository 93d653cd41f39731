// SPDX-License-Identifier: MIT
// The same body, read by the plug-in with names of several families: it must bend, keep its rigid
// parts and move alike.
#include "Command.h"
#include "FindNodes.h"
#include "RenamedBody.h"
#include "SkinFiles.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>
#include <osgSkinImport/ImportSkeleton>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace {

using osgSkin::RestSkeleton;

void writeJoint(std::ostream& out, const RestSkeleton& skeleton, int joint) {
    const osgSkin::RestJoint& rest = skeleton.joints[static_cast<std::size_t>(joint)];
    const auto offset = [&out](const glm::dvec3& o) {
        out << "{\nOFFSET " << o.x << " " << o.y << " " << o.z << "\n";
    };
    out << (rest.parent < 0 ? "ROOT " : "JOINT ") << rest.name << "\n";
    offset(rest.parent < 0
               ? rest.centre
               : rest.centre - skeleton.joints[static_cast<std::size_t>(rest.parent)].centre);
    out << "CHANNELS 3 Zrotation Yrotation Xrotation\n";
    for (const int child : skeleton.children(joint)) writeJoint(out, skeleton, child);
    if (skeleton.children(joint).empty()) {
        out << "End Site\n";
        offset(rest.tip ? *rest.tip - rest.centre : glm::dvec3(0, 0, 1e-3));
        out << "}\n";
    }
    out << "}\n";
}

/// A BVH file of one sample, the rest pose.
void writeBvh(const RestSkeleton& skeleton, const std::string& file) {
    std::ofstream out(file);
    out << std::setprecision(17) << "HIERARCHY\n";
    writeJoint(out, skeleton, 0);
    out << "MOTION\nFrames: 1\nFrame Time: 0.1\n";
    for (std::size_t i = 0; i < 3 * skeleton.joints.size(); ++i) out << "0 ";
    out << "\n";
}

/// The drawn geometry of a character at a time, in the world.
struct Drawn {
    explicit Drawn(osg::Node& scene) {
        for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(scene)) {
            const auto& vertices = static_cast<const osg::Vec3Array&>(
                *found.node->getDeformedGeometry()->getVertexArray());
            skin.insert(skin.end(), vertices.begin(), vertices.end());
        }
        for (const auto& found : test::findNodes<osgSkin::RigidPart>(scene))
            rigids[found.node->getParent(0)->getName()] = found.toWorld;
    }

    std::vector<osg::Vec3> skin;                ///< vertices of the skins, one after the other
    std::map<std::string, osg::Matrixd> rigids; ///< by the name of their bone
};

/// Reads the thrower on `skeleton` with its throw, at a time when its hands are rotated.
Drawn drawn(const RestSkeleton& skeleton, const std::string& extra) {
    const std::string folder = test::makeTestFolder();
    writeBvh(skeleton, folder + "/rig.bvh");
    const std::string file =
        test::saveSkin(folder + "/body.skin",
                       R"(, "motions": [{"file": ")" OSGSKIN_DATA R"(/throw.bvh"}])" + extra,
                       OSGSKIN_DATA "/thrower.obj", "rig.bvh");
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file);
    if (!scene) return Drawn(*osg::ref_ptr<osg::Node>(new osg::Node));
    for (const double time : {0.0, 1.1}) test::updateAt(*scene, time); // the first starts the clock
    return Drawn(*scene);
}

std::string asJson(const osgSkin::JointNames& names) {
    std::string result = R"(, "names": { ")" + names.name + R"(": {)", comma;
    for (const auto& [role, members] : names.roles) {
        result += comma + " \"" + role + "\": [";
        for (std::size_t i = 0; i < members.size(); ++i)
            result += (i > 0 ? ", \"" : " \"") + members[i] + "\"";
        result += " ]";
        comma = ",";
    }
    return result + " } }";
}

class BodyNames : public testing::Test {
protected:
    void SetUp() override {
        body = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
        // VRM has no names for these.
        for (const char* joint : {"Neck1", "LHipJoint", "RHipJoint", "LeftFingerBase",
                                  "RightFingerBase", "LeftHandIndex1", "RightHandIndex1"})
            body = test::without(body, joint);
    }

    void expectAlike(const osgSkin::JointNames& family, const std::string& extra) {
        const auto names = test::namesIn(body, family);
        const Drawn expected = drawn(body, {}), found = drawn(test::renamed(body, names), extra);
        ASSERT_EQ(expected.rigids.size(), 1u); // the head: thumbs and toes move
        ASSERT_GT(expected.skin.size(), 1000u);
        // The joints' names decide the order of the legs in the product, and so of the vertices.
        ASSERT_EQ(found.skin.size(), expected.skin.size());
        std::size_t exact = 0;
        for (const osg::Vec3& v : found.skin) {
            float nearest = HUGE_VALF;
            for (const osg::Vec3& w : expected.skin) nearest = std::min(nearest, (v - w).length2());
            EXPECT_LT(std::sqrt(nearest), 2e-3f); // metres
            if (nearest == 0.0f) ++exact;
        }
        EXPECT_GT(exact, found.skin.size() * 95 / 100);
        EXPECT_EQ(found.rigids.size(), expected.rigids.size());
        for (const auto& [bone, matrix] : expected.rigids) {
            ASSERT_EQ(found.rigids.count(names.at(bone)), 1u) << bone << ": no rigid part";
            EXPECT_EQ(found.rigids.at(names.at(bone)), matrix) << bone;
        }
    }

    RestSkeleton body;
};

} // namespace

TEST_F(BodyNames, VrmNamesGiveTheSamePicture) {
    expectAlike(test::knownNames("VRM"), {});
}

TEST_F(BodyNames, NamesOfTheFileGiveTheSamePicture) {
    expectAlike(test::robotNames(), asJson(test::robotNames()));
}
