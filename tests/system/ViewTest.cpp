// SPDX-License-Identifier: MIT
// The first view of a figure: complete, standing, from the front, and not from far away.
#include "Command.h"
#include "FindNodes.h"
#include "GltfBuilder.h"
#include "SkinFiles.h"

#include <osgSkin/GlmOsg>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>
#include <osg/Math>
#include <osgAnimation/Bone>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;

/// Copies a text file of the thrower with its points and directions mapped.
void copyMapped(const std::string& from, const std::string& to, const osg::Matrixd& map) {
    std::ifstream in(from);
    std::ofstream out(to);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        osg::Vec3d p;
        const bool isPoint = word == "v" || word == "vn" || word == "OFFSET";
        if (isPoint && words >> p.x() >> p.y() >> p.z()) {
            p = osg::Matrixd::transform3x3(p, map);
            out << word << ' ' << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
        } else if (word != "mtllib") {
            out << line << '\n';
        }
    }
}

Character turnedThrower(const osg::Matrixd& map) {
    const std::string folder = test::makeTestFolder();
    copyMapped(OSGSKIN_DATA "/thrower.obj", folder + "/body.obj", map);
    copyMapped(OSGSKIN_DATA "/thrower.bvh", folder + "/rig.bvh", map);
    return loadCharacter(test::saveSkin(
        folder + "/turned.skin", R"(, "motions": [{"file": ")" OSGSKIN_DATA R"(/throw.bvh"}])",
        "body.obj", "rig.bvh"));
}

osg::Matrixd turnAbout(const osg::Vec3d& axis, double degrees) {
    return osg::Matrixd::rotate(osg::DegreesToRadians(degrees), axis);
}

osg::Vec3d jointOf(const Character& character, const std::string& name) {
    const auto joint = static_cast<std::size_t>(character.rest.find(name));
    return osgSkin::toOsg(character.rest.joints.at(joint).centre) * character.toWorld;
}

void expectFacesViewer(const Character& character) {
    const osg::Vec3d up = jointOf(character, "Head") - jointOf(character, "LeftFoot");
    EXPECT_GT(up.z(), 0.8 * up.length());
    const osg::Vec3d toes = jointOf(character, "LeftToeBase") - jointOf(character, "LeftFoot");
    EXPECT_LT(toes.y(), -0.5 * toes.length());
    EXPECT_GT(jointOf(character, "LeftArm").x(), jointOf(character, "RightArm").x());
}

/// A rigged person with one tetrahedron per joint, in a glTF file: y up, facing +z except for the
/// rotation `turn` of a node above.
struct GltfPerson : test::GltfBuilder {
    explicit GltfPerson(const std::vector<double>& turn) {
        const std::vector<std::tuple<const char*, const char*, std::vector<double>>> parts{
            {"Hips", "", {0, 1, 0}},
            {"Spine", "Hips", {0, 0.2, 0}},
            {"Head", "Spine", {0, 0.4, 0}},
            {"LeftUpLeg", "Hips", {0.1, -0.05, 0}},
            {"LeftLeg", "LeftUpLeg", {0, -0.45, 0}},
            {"LeftFoot", "LeftLeg", {0, -0.42, 0}},
            {"LeftToeBase", "LeftFoot", {0, -0.05, 0.15}},
            {"RightUpLeg", "Hips", {-0.1, -0.05, 0}},
            {"RightLeg", "RightUpLeg", {0, -0.45, 0}},
            {"RightFoot", "RightLeg", {0, -0.42, 0}},
            {"RightToeBase", "RightFoot", {0, -0.05, 0.15}},
            {"LeftArm", "Spine", {0.2, 0.3, 0}},
            {"LeftForeArm", "LeftArm", {0.28, 0, 0}},
            {"LeftHand", "LeftForeArm", {0.26, 0, 0}},
            {"RightArm", "Spine", {-0.2, 0.3, 0}},
            {"RightForeArm", "RightArm", {-0.28, 0, 0}},
            {"RightHand", "RightForeArm", {-0.26, 0, 0}}};
        std::map<std::string, std::vector<double>> centres;
        std::map<std::string, std::size_t> nodes;
        std::vector<double> places, joints, weights, matrices, faces;
        std::vector<std::size_t> skin;
        for (const auto& [name, parent, offset] : parts) {
            std::vector<double> centre = offset;
            nodes[name] = node({{"name", name}, {"translation", offset}});
            if (*parent != '\0') {
                for (std::size_t i = 0; i < 3; ++i) centre[i] += centres[parent][i];
                json["nodes"][nodes[parent]]["children"].push_back(nodes[name]);
            }
            centres[name] = centre;
            const double first = double(places.size()) / 3.0;
            for (int corner = 0; corner < 4; ++corner) {
                for (int i = 0; i < 3; ++i)
                    places.push_back(centre[std::size_t(i)] + (corner == i ? 0.05 : 0.0));
                joints.insert(joints.end(), {double(skin.size()), 0, 0, 0});
                weights.insert(weights.end(), {1, 0, 0, 0});
            }
            for (const int corner : {0, 1, 2, 3, 1, 0, 3, 2, 1, 3, 0, 2})
                faces.push_back(first + corner);
            for (int k = 0; k < 16; ++k)
                matrices.push_back(k > 11 && k < 15 ? -centre[std::size_t(k - 12)]
                                                    : (k % 5 == 0 ? 1.0 : 0.0));
            skin.push_back(nodes[name]);
        }
        json["meshes"].push_back({{"name", "person"},
                                  {"primitives",
                                   {{{"attributes",
                                      {{"POSITION", accessor("VEC3", places)},
                                       {"JOINTS_0", accessor("VEC4", joints, 5121)},
                                       {"WEIGHTS_0", accessor("VEC4", weights)}}},
                                     {"indices", accessor("SCALAR", faces, 5123)}}}}});
        json["skins"] = {{{"joints", skin}, {"inverseBindMatrices", accessor("MAT4", matrices)}}};
        const std::size_t above =
            node({{"name", "above"}, {"rotation", turn}, {"children", {nodes["Hips"]}}});
        const std::size_t body = node({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
        json["scenes"][0]["nodes"] = {above, body};
        animate("nod", nodes["Head"], "rotation", {0.0, 1.0},
                {0, 0, 0, 1, std::sqrt(0.5), 0, 0, std::sqrt(0.5)});
    }
};

enum class Seat { Chair, Floor };

/// The thrower's rig with its thighs forward, and on the floor its shins too, rotated about z; and
/// a motion of one sample that may be rotated.
Character sittingThrower(Seat seat, double turned, std::optional<double> played = std::nullopt) {
    const std::string folder = test::makeTestFolder();
    const osg::Matrixd map = turnAbout({0, 0, 1}, turned);
    std::ifstream in(OSGSKIN_DATA "/thrower.bvh");
    std::ofstream rig(folder + "/rig.bvh"), motion(folder + "/motion.bvh");
    std::string joint;
    bool isLastLine = false;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string word, moved;
        osg::Vec3d p;
        words >> word;
        if (word == "JOINT") words >> joint;
        const bool isAhead = joint == "LeftLeg" || joint == "RightLeg" ||
                             (seat == Seat::Floor && (joint == "LeftFoot" || joint == "RightFoot"));
        if (word == "OFFSET" && words >> p.x() >> p.y() >> p.z()) {
            if (isAhead) p.set(p.x(), 0.0, -p.y());
            p = osg::Matrixd::transform3x3(p, map);
            std::ostringstream text;
            text << "OFFSET " << p.x() << ' ' << p.y() << ' ' << p.z();
            line = text.str();
        }
        moved = line;
        if (isLastLine && played) // the root's first channel rotates about z
            moved = std::to_string(*played) + line.substr(line.find(' '));
        isLastLine = word == "Frame";
        rig << line << '\n';
        motion << moved << '\n';
    }
    rig.close();
    motion.close();
    return loadCharacter(test::saveSkin(folder + "/sitting.skin",
                                        played ? R"(, "motions": [{"file": "motion.bvh"}])" : "",
                                        OSGSKIN_DATA "/thrower.obj", "rig.bvh"));
}

/// Positions of a scene's drawn bones.
std::map<std::string, osg::Vec3d> bonesOf(Character& character) {
    std::map<std::string, osg::Vec3d> result;
    for (const auto& found : test::findNodes<osgAnimation::Bone>(*character.root))
        result[found.node->getName()] = found.toWorld.getTrans();
    return result;
}

} // namespace

TEST(View, SkinFilesFaceTheViewer) {
    for (const double degrees : {0.0, 90.0, 180.0, -90.0, 20.0})
        expectFacesViewer(turnedThrower(turnAbout({0, 1, 0}, degrees)));
    // Files with Z up that do not declare it.
    const Character standing = turnedThrower(turnAbout({1, 0, 0}, 90.0));
    expectFacesViewer(standing);
    EXPECT_TRUE(standing.isZUp());
    expectFacesViewer(turnedThrower(turnAbout({1, 0, 0}, 90.0) * turnAbout({0, 0, 1}, 180.0)));
}

/// The thighs of a sitting figure are horizontal, trunk and shins vertical.
TEST(View, SittingBodiesStayUpright) {
    for (const Seat seat : {Seat::Chair, Seat::Floor}) {
        const Character character = sittingThrower(seat, 0.0);
        const osg::Vec3d thigh = jointOf(character, "LeftLeg") - jointOf(character, "LeftUpLeg");
        EXPECT_GT(std::abs(thigh.y()), 0.9 * thigh.length());
        EXPECT_GT(jointOf(character, "Head").z(), jointOf(character, "Hips").z());
    }
}

/// For a figure that sits on the floor and lies on its side at rest, the motion decides.
TEST(View, MotionDecidesForBodiesNotStraightAtRest) {
    const osg::Matrixd fromY = osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
    EXPECT_EQ(sittingThrower(Seat::Floor, -90.0, 90.0).toWorld.compare(fromY), 0);
    EXPECT_NE(sittingThrower(Seat::Floor, -90.0).toWorld.compare(fromY), 0);
}

TEST(View, DoesNotRotateBodiesFacingTheViewer) {
    const Character character = loadCharacter(OSGSKIN_DATA "/thrower.skin");
    const osg::Matrixd fromY = osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
    EXPECT_EQ(character.toWorld.compare(fromY), 0);
}

TEST(View, RiggedModelsFaceTheViewer) {
    const double h = std::sqrt(0.5);
    for (const std::vector<double>& turn :
         {std::vector<double>{0, 0, 0, 1}, {0, 1, 0, 0}, {0, h, 0, h}, {-h, 0, 0, h}}) {
        GltfPerson person(turn);
        Character character = loadCharacter(person.save("person.gltf"));
        auto bones = bonesOf(character);
        EXPECT_GT(bones["Head"].z(), bones["LeftFoot"].z() + 1.0) << turn[0] << " " << turn[1];
        EXPECT_LT(bones["LeftToeBase"].y(), bones["LeftFoot"].y() - 0.1) << turn[1];
        EXPECT_GT(bones["LeftArm"].x(), bones["RightArm"].x() + 0.3) << turn[1];
        // Bounds computed before the rotation would be elsewhere.
        osg::ComputeBoundsVisitor bounds;
        character.root->accept(bounds);
        const osg::BoundingSphere& seen = character.root->getBound();
        EXPECT_LT((bounds.getBoundingBox().center() - seen.center()).length(), 0.3 * seen.radius());
    }
}

/// Joints without known names are told apart by the skeleton's shape.
TEST(View, ModelsWithoutKnownNamesFaceTheViewer) {
    const double h = std::sqrt(0.5);
    for (const std::vector<double>& turn :
         {std::vector<double>{0, 0, 0, 1}, {0, 1, 0, 0}, {0, h, 0, h}, {0, -h, 0, h}}) {
        GltfPerson person(turn);
        for (std::size_t n = 0; n < person.json["nodes"].size(); ++n)
            person.json["nodes"][n]["name"] = "j" + std::to_string(n);
        Character character = loadCharacter(person.save("unnamed.gltf"));
        auto bones = bonesOf(character);
        EXPECT_LT(bones["j6"].y(), bones["j5"].y() - 0.1) << "toes before the foot, " << turn[1];
        EXPECT_GT(bones["j11"].x(), bones["j14"].x() + 0.3) << "left arm, " << turn[1];
    }
}

TEST(View, BoundsFollowTheClip) {
    GltfPerson person({0, 0, 0, 1});
    const double height = 1.63; // from the toes to the top of the head, which nods
    const double near = loadCharacter(person.save("near.gltf")).root->getBound().radius();
    EXPECT_LT(near, 0.9 * height);
    // Far from the nodes' own positions, and sometimes farther, as in motion captures.
    person.json.erase("buffers");
    person.animate("nod", 0, "translation", {0.0, 0.5, 1.0}, {50, 1, 0, 50, 1, 0.5, 50, 1, 0});
    const osg::BoundingSphere far = loadCharacter(person.save("far.gltf")).root->getBound();
    EXPECT_NEAR(far.center().x(), 50.0, 0.5);
    EXPECT_LT(double(far.radius()), near + 0.5);
}
