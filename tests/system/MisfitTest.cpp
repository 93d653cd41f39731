// SPDX-License-Identifier: MIT
// Bodies whose skeleton is in another unit, has another up axis or another position.
#include "Command.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>

#include <gtest/gtest.h>
#include <osg/Matrixd>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

const std::string kBodyThatFits = OSGSKIN_DATA "/thrower";

/// Weights for the thrower: each joint has an equal range of the vertices.
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

/// Warnings about the thrower after moving his body but not the skeleton.
/// \param move of the body
/// \param skeleton file; empty: his own
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

TEST(Misfit, WarnsAboutSkeletonInAnotherUnit) {
    for (const double scale : {0.01, 0.0254, 10.0, 39.37, 100.0})
        test::expectContains(misfitsOf(osg::Matrixd::scale(scale, scale, scale)),
                             " times as long as the skeleton, expected both in the same unit");
}

TEST(Misfit, WarnsAboutSkeletonInAnotherPosition) {
    for (const osg::Matrixd& move :
         {osg::Matrixd::translate(0, 0, 1e3), osg::Matrixd::translate(0, 1e3, 0),
          osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0, 0, 1))})
        test::expectContains(misfitsOf(move), " joints lie outside the skin, expected");
}

/// As Blender writes OBJ files with Y up, and BVH files with Z up.
TEST(Misfit, RotatesSkeletonWithAnotherAxisUp) {
    for (const double turn : {osg::PI_2, -osg::PI_2}) {
        const std::string notes = misfitsOf(osg::Matrixd::rotate(turn, osg::Vec3d(1, 0, 0)));
        test::expectContains(notes, "thrower.bvh has another axis up than the body: the skeleton "
                                    "is rotated by a quarter turn about x");
        EXPECT_EQ(notes.find("outside"), std::string::npos) << notes;
    }
}

TEST(Misfit, WarnsAboutPaintedBodies) {
    for (const double scale : {0.01, 39.37, 100.0})
        test::expectContains(misfitsOf(osg::Matrixd::scale(scale, scale, scale), {}, true),
                             " times as long as the skeleton, expected both in the same unit");
    test::expectContains(misfitsOf(osg::Matrixd::translate(5, 0, 0), {}, true),
                         " joints lie outside the skin, expected");
    EXPECT_EQ(misfitsOf(osg::Matrixd(), {}, true), "");
}

/// As a shirt, with the skeleton of the whole figure.
TEST(Misfit, DoesNotWarnAboutPartOfBody) {
    const osg::Matrixd shirt = osg::Matrixd::scale(0.35, 0.5, 0.8);
    EXPECT_EQ(misfitsOf(shirt * osg::Matrixd::translate(0, 0.75, 0), {}, true), "");
    test::expectContains(misfitsOf(shirt * osg::Matrixd::translate(0, 1.75, 0), {}, true),
                         " joints lie outside the skin, expected");
}

/// The face's node is its only joint, and may be in the neck.
TEST(Misfit, DoesNotWarnAboutFacesWithoutJoints) {
    test::GltfColumn face;
    face.json.erase("skins");
    face.json["nodes"][face.meshNode].erase("skin");
    face.json["nodes"][face.meshNode]["translation"] = {0, -5, 0};
    for (double& place : face.places) place += 5.0;
    face.attributes() = {{"POSITION", face.accessor("VEC3", face.places)}};
    face.json["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", face.accessor("VEC3", std::vector<double>(face.places.size(), 0.1))}}};
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0}, {0.0, 1.0});
    const test::Notices notices;
    const osgSkin::Character character = osgSkin::loadCharacter(face.save("face.gltf"));
    EXPECT_EQ(notices.text().find("outside"), std::string::npos) << notices.text();
}

TEST(Misfit, DoesNotCompareLengthsOfCoincidentJoints) {
    const std::string channels = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
    const std::string note = misfitsOf(
        osg::Matrixd(),
        "HIERARCHY\nROOT a\n{\nOFFSET 5 1 0\n" + channels + "JOINT b\n{\nOFFSET 0 0 0\n" +
            channels + "End Site\n{\nOFFSET 0 0 0\n}\n}\n}\nMOTION\nFrames: 0\nFrame Time: 1\n");
    test::expectContains(note, "1 of 1 joints lie outside the skin");
}

TEST(Misfit, WarnsAboutSinglePrecisionRounding) {
    const std::string note = misfitsOf(osg::Matrixd::translate(0, 4e6, 0));
    test::expectContains(note, "body.obj: the body is 4e+06 from the origin and ");
    test::expectContains(note, "single precision rounds its vertices by 0.238;");
}

TEST(Misfit, DoesNotWarnAboutMatchingSkeleton) {
    EXPECT_EQ(misfitsOf(osg::Matrixd()), "");
    EXPECT_EQ(misfitsOf(osg::Matrixd::translate(0, 1e3, 0)).find("rounds"), std::string::npos);
}
