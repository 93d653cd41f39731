// SPDX-License-Identifier: MIT
// Whether an actor lies, where a .skin file says which axis is up.
#include "SkinFiles.h"
#include "TextFile.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinRig/ForwardKinematics>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <sstream>

namespace {

/// The thrower's skeleton laid down, with its trunk along +z, and one frame of it.
std::string laidDown() {
    std::istringstream in(test::fileText(OSGSKIN_DATA "/thrower.bvh"));
    std::ostringstream out;
    std::size_t channels = 0;
    for (std::string line; std::getline(in, line) && line.find("MOTION") == std::string::npos;) {
        std::istringstream words(line);
        std::string word;
        double x = 0.0, y = 0.0, z = 0.0;
        if (words >> word && word == "OFFSET" && words >> x >> y >> z)
            out << "OFFSET " << x << " " << -z << " " << y << "\n";
        else if (word == "CHANNELS" && channels++ == 0)
            out << "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n";
        else
            out << line << "\n";
    }
    out << "MOTION\nFrames: 1\nFrame Time: 0.04\n0 0 0";
    for (std::size_t i = 0; i < 3 * channels; ++i) out << " 0";
    return test::saveText("laid_down.bvh", out.str() + "\n");
}

/// How far the head is above the hips, in the first frame.
double headHeight(const std::string& skinMembers, const std::string& motionMembers) {
    const std::string file =
        test::saveSkin(testing::TempDir() + "laid_down.skin",
                       skinMembers + R"(, "shapes": "none", "motions": [{"file": ")" + laidDown() +
                           "\"" + motionMembers + "}]",
                       OSGSKIN_DATA "/thrower.obj", OSGSKIN_DATA "/thrower.bvh");
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    const osgSkin::Clip& clip = character.motions.front().clip;
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> centres;
    osgSkin::worldRotations(character.rest, clip.rotations.data(), rotations);
    osgSkin::worldPositions(character.rest, rotations, clip.rootPositions.front(), centres);
    return centres[std::size_t(character.rest.find("Head"))].y -
           centres[std::size_t(character.rest.find("Hips"))].y;
}

} // namespace

TEST(MotionUp, IsSetByFileOrMotion) {
    EXPECT_GT(headHeight("", ""), 0.5) << "nothing is known of a floor";
    EXPECT_LT(headHeight(R"(, "up": "y")", ""), 0.1);
    EXPECT_LT(headHeight("", R"(, "up": "y")"), 0.1);
    EXPECT_GT(headHeight("", R"(, "up": "z")"), 0.5);
    EXPECT_GT(headHeight(R"(, "up": "y")", R"(, "up": "z")"), 0.5) << "the motion's goes first";
}
