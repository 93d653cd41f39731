// SPDX-License-Identifier: MIT
// Bodies whose skeleton is in another unit, has another axis up or stands elsewhere.
#include "Command.h"
#include "Notices.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>

#include <osg/Matrixd>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace {

const std::string kBodyThatFits = OSGSKIN_DATA "/thrower";

/// Weights of the thrower: each joint has its share of the vertices, one after the other.
void paint(const std::string& path) {
    const osgSkin::RestSkeleton rest = osgSkin::importSkeleton(kBodyThatFits + ".bvh");
    const std::size_t vertices = osgSkin::importMesh(kBodyThatFits + ".obj").mesh.positions.size();
    std::ofstream file(path);
    file << "{\"weights\": {";
    for (std::size_t j = 0; j < rest.joints.size(); ++j) {
        file << (j > 0 ? "], \"" : "\"") << rest.joints[j].name << "\": [";
        for (std::size_t v = j; v < vertices; v += rest.joints.size())
            file << (v > j ? ", [" : "[") << v << ", 1]";
    }
    file << "]}}";
}

/// What is told of the thrower where his body is moved, and the skeleton, his own if no other is
/// given, is not.
/// \param painted whether weights name each of his joints
std::string misfitsOf(const osg::Matrixd& move, const std::string& skeleton = {},
                      bool painted = false) {
    const std::string folder = test::makeTestFolder();
    std::ifstream from(kBodyThatFits + ".obj");
    std::ofstream body(folder + "/body.obj");
    for (std::string line; std::getline(from, line);) {
        std::istringstream words(line);
        std::string kind;
        osg::Vec3d p;
        if (words >> kind && kind == "v" && words >> p.x() >> p.y() >> p.z()) {
            p = p * move;
            body << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
        } else {
            body << line << "\n";
        }
    }
    body.close();
    if (!skeleton.empty()) std::ofstream(folder + "/other.bvh") << skeleton;
    std::ofstream(folder + "/c.skin")
        << "{\"osgskin\": 1, \"mesh\": \"body.obj\", \"skeleton\": \""
        << (skeleton.empty() ? kBodyThatFits : folder + "/other") << ".bvh\""
        << (painted ? ", \"bind\": \"weights\", \"weights\": \"w.json\"}" : "}");
    if (painted) paint(folder + "/w.json");
    const test::Notices notices;
    const osgSkin::Character character = osgSkin::loadCharacter(folder + "/c.skin");
    std::string result;
    for (const std::string& note : character.notes) result += note + "\n";
    EXPECT_TRUE(notices.say(result));
    return result;
}

} // namespace

TEST(Misfit, SkeletonsInAnotherUnitAreToldOf) {
    for (const double scale : {0.01, 0.0254, 10.0, 39.37, 100.0})
        EXPECT_NE(misfitsOf(osg::Matrixd::scale(scale, scale, scale))
                      .find(" times as long as the skeleton, expected both in the same unit"),
                  std::string::npos)
            << scale;
}

TEST(Misfit, SkeletonsInAnotherPlaceAreToldOf) {
    for (const osg::Matrixd& move :
         {osg::Matrixd::translate(0, 0, 1e3), osg::Matrixd::translate(0, 1e3, 0),
          osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)),
          osg::Matrixd::rotate(-osg::PI_2, osg::Vec3d(1, 0, 0))})
        EXPECT_NE(misfitsOf(move).find(" joints lie outside the skin, expected"),
                  std::string::npos);
}

TEST(Misfit, PaintedOnesAreToldOfToo) {
    for (const double scale : {0.01, 39.37, 100.0})
        EXPECT_NE(misfitsOf(osg::Matrixd::scale(scale, scale, scale), {}, true)
                      .find(" times as long as the skeleton, expected both in the same unit"),
                  std::string::npos)
            << scale;
    EXPECT_NE(misfitsOf(osg::Matrixd::translate(5, 0, 0), {}, true)
                  .find(" joints lie outside the skin, expected"),
              std::string::npos);
    EXPECT_EQ(misfitsOf(osg::Matrixd(), {}, true), "");
}

TEST(Misfit, JointsInOnePointHaveNoLengthToCompare) {
    const std::string channels = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
    const std::string note = misfitsOf(
        osg::Matrixd(),
        "HIERARCHY\nROOT a\n{\nOFFSET 5 1 0\n" + channels + "JOINT b\n{\nOFFSET 0 0 0\n" +
            channels + "End Site\n{\nOFFSET 0 0 0\n}\n}\n}\nMOTION\nFrames: 0\nFrame Time: 1\n");
    EXPECT_NE(note.find("1 of 1 joints lie outside the skin"), std::string::npos) << note;
}

TEST(Misfit, BodiesThatSinglePrecisionRoundsAreToldOf) {
    const std::string note = misfitsOf(osg::Matrixd::translate(0, 4e6, 0));
    EXPECT_NE(note.find("body.obj: the body is 4e+06 from the origin and "), std::string::npos)
        << note;
    EXPECT_NE(note.find("single precision rounds its vertices by 0.238;"), std::string::npos);
}

TEST(Misfit, OthersAreNot) {
    EXPECT_EQ(misfitsOf(osg::Matrixd()), "");
    EXPECT_EQ(misfitsOf(osg::Matrixd::translate(0, 1e3, 0)).find("rounds"), std::string::npos);
}
