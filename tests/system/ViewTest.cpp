// SPDX-License-Identifier: MIT
//
// The first view of a figure: complete, standing, from the front, and not from far away.
//
// Changes that OSG's programs make to a scene between reading and drawing must leave the posed
// figure at the scene's position.
//
// Characters in OSG's own scenes: bones, rigs and clips of osgAnimation.
#include "Command.h"
#include "FindNodes.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "WhyRefused.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>

#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>
#include <osg/FrameStamp>
#include <osg/Math>
#include <osg/ShapeDrawable>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/Optimizer>
#include <osgUtil/UpdateVisitor>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <ostream>
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
    const std::string file = folder + "/turned.skin";
    std::ofstream(file) << R"({ "osgskin": 1, "mesh": "body.obj", "skeleton": "rig.bvh",
                               "motions": [ { "file": ")" OSGSKIN_DATA R"(/throw.bvh" } ] })";
    return loadCharacter(file);
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
    const std::string folder = test::makeTestFolder(), file = folder + "/sitting.skin";
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
    std::ofstream(file) << R"({ "osgskin": 1, "mesh": ")" OSGSKIN_DATA
                           R"(/thrower.obj", "skeleton": "rig.bvh")"
                        << (played ? R"(, "motions": [ { "file": "motion.bvh" } ] })" : " }");
    return loadCharacter(file);
}

/// Positions of a scene's drawn bones.
std::map<std::string, osg::Vec3d> bonesOf(Character& character) {
    std::map<std::string, osg::Vec3d> result;
    for (const auto& found : test::findNodes<osgAnimation::Bone>(*character.root))
        result[found.node->getName()] = found.toWorld.getTrans();
    return result;
}

} // namespace

TEST(View, CharactersOfASkinFileFaceTheViewer) {
    for (const double degrees : {0.0, 90.0, 180.0, -90.0, 20.0})
        expectFacesViewer(turnedThrower(turnAbout({0, 1, 0}, degrees)));
    // Files with Z up that do not declare it.
    const Character standing = turnedThrower(turnAbout({1, 0, 0}, 90.0));
    expectFacesViewer(standing);
    EXPECT_TRUE(standing.isZUp());
    expectFacesViewer(turnedThrower(turnAbout({1, 0, 0}, 90.0) * turnAbout({0, 0, 1}, 180.0)));
}

/// The thighs of a sitting figure are horizontal, trunk and shins vertical.
TEST(View, WhoSitsAtRestIsNotTipped) {
    for (const Seat seat : {Seat::Chair, Seat::Floor}) {
        const Character character = sittingThrower(seat, 0.0);
        const osg::Vec3d thigh = jointOf(character, "LeftLeg") - jointOf(character, "LeftUpLeg");
        EXPECT_GT(std::abs(thigh.y()), 0.9 * thigh.length());
        EXPECT_GT(jointOf(character, "Head").z(), jointOf(character, "Hips").z());
    }
}

/// For a figure that sits on the floor and lies on its side at rest, the motion decides.
TEST(View, OfWhoIsNotStraightAtRestTheMotionTells) {
    const osg::Matrixd fromY = osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
    EXPECT_EQ(sittingThrower(Seat::Floor, -90.0, 90.0).toWorld.compare(fromY), 0);
    EXPECT_NE(sittingThrower(Seat::Floor, -90.0).toWorld.compare(fromY), 0);
}

TEST(View, WhatFacesTheViewerIsNotTurned) {
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

TEST(View, BoundsAreWhereTheClipPutsTheFigure) {
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

namespace {

const std::string kThrowerFile = OSGSKIN_DATA "/thrower.skin";

/// World-space positions of a scene's skins and rigid parts.
class Collector : public osg::NodeVisitor {
public:
    std::vector<osg::Vec3d> skin;
    osg::BoundingBox rigid;

    Collector() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        const osg::Matrix toWorld = osg::computeLocalToWorld(getNodePath());
        if (auto* deformable = dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) {
            for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(
                     *deformable->getDeformedGeometry()->getVertexArray()))
                skin.push_back(osg::Vec3d(v) * toWorld);
            return;
        }
        for (osg::Node* node : getNodePath())
            if (dynamic_cast<osgSkin::RigidPart*>(node))
                for (unsigned int corner = 0; corner < 8; ++corner)
                    rigid.expandBy(drawable.getBoundingBox().corner(corner) * toWorld);
    }
};

Collector at(double time, osg::Node& scene) {
    osgUtil::UpdateVisitor update;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    update.setFrameStamp(stamp);
    update.setTraversalNumber(1);
    scene.accept(update);
    Collector collector;
    scene.accept(collector);
    return collector;
}

/// At several times `scene` must equal the plain thrower moved by `move`.
void expectPlaced(osg::Node* scene, const osg::Matrix& move) {
    ASSERT_NE(scene, nullptr);
    const osg::ref_ptr<osg::Node> plain = osgDB::readRefNodeFile(kThrowerFile);
    ASSERT_NE(plain, nullptr);
    for (const double time : {0.0, 0.9, 1.3, 2.1}) {
        const Collector is = at(time, *scene);
        const Collector expected = at(time, *plain);
        ASSERT_EQ(is.skin.size(), expected.skin.size());
        double off = 0.0;
        for (std::size_t v = 0; v < is.skin.size(); ++v)
            off = std::max(off, (is.skin[v] - expected.skin[v] * move).length());
        EXPECT_LE(off, 1e-5) << time;
        osg::BoundingBox rigid;
        for (unsigned int corner = 0; corner < 8; ++corner)
            rigid.expandBy(expected.rigid.corner(corner) * move);
        EXPECT_LE((is.rigid._min - rigid._min).length(), 1e-4) << time;
        EXPECT_LE((is.rigid._max - rigid._max).length(), 1e-4) << time;
    }
}

struct PseudoLoader {
    const char* name;
    const char* suffix;
    osg::Matrix move;
};

void PrintTo(const PseudoLoader& loader, std::ostream* out) {
    *out << loader.name;
}

class Placement : public testing::TestWithParam<PseudoLoader> {};

// Right angles, so that a box of rotated boxes equals the rotated box.
const PseudoLoader kLoaders[] = {
    {"plain", "", osg::Matrix()},
    {"trans", ".2,3,4.trans", osg::Matrix::translate(2, 3, 4)},
    {"scale", ".2.scale", osg::Matrix::scale(2, 2, 2)},
    {"rot", ".0,0,90.rot", osg::Matrix::rotate(osg::PI_2, osg::Vec3(0, 0, 1))},
};

} // namespace

TEST_P(Placement, AsRead) {
    expectPlaced(osgDB::readRefNodeFile(kThrowerFile + GetParam().suffix).get(), GetParam().move);
}

TEST_P(Placement, AfterEveryOptimization) {
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(kThrowerFile + GetParam().suffix);
    ASSERT_NE(scene, nullptr);
    osgUtil::Optimizer().optimize(scene, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    expectPlaced(scene.get(), GetParam().move);
}

TEST_P(Placement, AfterOsgconv) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "osgconv cannot load libraries that were built with sanitizers";
#endif
    const std::string saved = test::makeTestFolder() + "/saved.osgb";
    const std::string command =
        "osgconv '" + kThrowerFile + GetParam().suffix + "' '" + saved + "' >/dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0); // NOLINT(cert-env33-c): our own arguments
    expectPlaced(osgDB::readRefNodeFile(saved).get(), GetParam().move);
}

INSTANTIATE_TEST_SUITE_P(Loaders, Placement, testing::ValuesIn(kLoaders),
                         [](const auto& loader) { return std::string(loader.param.name); });

namespace {

using osgSkin::Character;

osg::ref_ptr<osgAnimation::Bone> makeBone(const std::string& name, const osg::Vec3& offset,
                                          const osg::Vec3& place) {
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
    const osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
    auto& stack = update->getStackedTransforms();
    stack.push_back(new osgAnimation::StackedTranslateElement("translate", offset));
    stack.push_back(new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
    bone->setUpdateCallback(update);
    bone->setMatrix(osg::Matrix::translate(offset));
    bone->setMatrixInSkeletonSpace(osg::Matrix::translate(place));
    bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(-place));
    return bone;
}

osg::ref_ptr<osgAnimation::Animation> makeClip(const std::string& name, double degrees) {
    const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
        new osgAnimation::QuatSphericalLinearChannel;
    channel->setName("quaternion");
    channel->setTargetName("upper");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (const double time : {0.0, 1.0})
        keys->push_back(osgAnimation::QuatKeyframe(
            time, osg::Quat(osg::DegreesToRadians(degrees), osg::Vec3(1, 0, 0))));
    osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
    clip->setName(name);
    clip->addChannel(channel);
    return clip;
}

/// A file like those of OSG exporters: a skeleton with two top bones, one of them with a hat before
/// its bone; a skin as a sheet of quads over "lower" and "upper", painted so that the weights
/// change at 3 and not at the joint; and a manager with two clips, none of them playing.
std::string sceneFile(const std::string& name) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setDefaultUpdateCallback();
    const auto lower = makeBone("lower", osg::Vec3(), osg::Vec3());
    const auto upper = makeBone("upper", osg::Vec3(0, 0, 2), osg::Vec3(0, 0, 2));
    const osg::ref_ptr<osg::Geode> hat = new osg::Geode;
    hat->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.2f)));
    lower->addChild(hat);
    lower->addChild(upper);
    skeleton->addChild(lower);
    skeleton->addChild(makeBone("control", osg::Vec3(1, 0, 0), osg::Vec3(1, 0, 0)));

    const osg::ref_ptr<osg::Geometry> sheet = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    const osg::ref_ptr<osg::DrawElementsUInt> quads = new osg::DrawElementsUInt(GL_QUADS);
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (unsigned row = 0; row <= 8; ++row)
        for (unsigned side = 0; side < 2; ++side) {
            const float height = 0.5f * float(row);
            (*map)[height < 3.0f ? "lower" : "upper"].emplace_back(unsigned(places->size()), 1.0f);
            places->push_back(osg::Vec3(side ? 0.5f : -0.5f, 0, height));
        }
    for (unsigned row = 0; row < 8; ++row)
        for (const unsigned corner : {0u, 1u, 3u, 2u}) quads->push_back(2 * row + corner);
    sheet->setVertexArray(places);
    sheet->addPrimitiveSet(quads);
    const osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setName("sheet");
    rig->setSourceGeometry(sheet);
    rig->setInfluenceMap(map);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(rig);
    skeleton->addChild(geode);

    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(skeleton);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    manager->registerAnimation(makeClip("rest", 0));
    manager->registerAnimation(makeClip("lean", 40));
    root->setUpdateCallback(manager);
    std::string file = test::makeTestFolder() + "/" + name;
    EXPECT_TRUE(osgDB::writeNodeFile(*root, file));
    return file;
}

/// The rotation of the bone "upper" after some frames, in degrees.
double leanOf(osg::Node& root) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    for (const double time : {0.0, 0.1, 0.2}) {
        stamp->setSimulationTime(time);
        stamp->setFrameNumber(stamp->getFrameNumber() + 1);
        root.accept(visitor);
    }
    for (const auto& bone : test::findNodes<osgAnimation::Bone>(root)) {
        if (bone.node->getName() != "upper") continue;
        const osg::Vec3d up =
            osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), bone.node->getMatrix());
        return osg::RadiansToDegrees(std::acos(std::min(1.0, up.z())));
    }
    ADD_FAILURE() << "no bone \"upper\"";
    return 0.0;
}

} // namespace

TEST(OsgScene, PlaysItsFirstClipWithoutWarnings) {
    for (const char* format : {"scene.osgt", "scene.osgb"}) {
        const std::string file = sceneFile(format);
        const test::Notices notices;
        const Character character = osgSkin::loadCharacter(file);
        ASSERT_NE(character.manager, nullptr);
        ASSERT_EQ(character.motions.size(), 2u);
        EXPECT_TRUE(character.manager->isPlaying("rest"));
        EXPECT_NEAR(leanOf(*character.root), 0.0, 1e-3);
        EXPECT_EQ(notices.warnings(), "");
    }
}

TEST(OsgScene, PlaysEachOfSeveralManagers) {
    const std::string file = sceneFile("scene.osgt");
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int copy = 0; copy < 3; ++copy) root->addChild(osgDB::readRefNodeFile(file));
    ASSERT_TRUE(osgDB::writeNodeFile(*root, file));
    const Character character = osgSkin::loadCharacter(file);
    ASSERT_EQ(character.root->getNumChildren(), 3u);
    for (unsigned c = 0; c < 3; ++c) {
        auto* manager = dynamic_cast<osgAnimation::BasicAnimationManager*>(
            character.root->getChild(c)->getUpdateCallback());
        ASSERT_NE(manager, nullptr);
        EXPECT_TRUE(manager->isPlaying("rest")) << c;
    }
}

TEST(OsgScene, HonoursOptions) {
    const std::string file = sceneFile("scene.osgt");
    const Character leaning = osgSkin::loadCharacter(file, test::loadOptions("motion=lean"));
    EXPECT_EQ(leaning.motions.front().name(), "lean");
    EXPECT_NEAR(leanOf(*leaning.root), 40.0, 1e-3);
    const Character still = osgSkin::loadCharacter(file, test::loadOptions("motion=none"));
    EXPECT_EQ(still.manager, nullptr);
    EXPECT_NEAR(leanOf(*still.root), 0.0, 1e-3);
    // A vertex between the joint and the change of the weights.
    const auto region = [](const Character& character) {
        return character.binding.joints.at(character.binding.regions.at(10)).name;
    };
    EXPECT_EQ(region(osgSkin::loadCharacter(file, test::loadOptions("bind=weights"))), "lower");
    EXPECT_NE(region(osgSkin::loadCharacter(file, test::loadOptions("bind=smooth"))), "lower");

    const std::string why = test::whyRefused(file, test::loadOptions("motion=run"));
    EXPECT_NE(why.find(R"("run" is none of the scene's, expected one of "rest", "lean")"),
              std::string::npos)
        << why;
    EXPECT_NE(
        test::whyRefused(file, test::loadOptions("motion=" OSGSKIN_TEST_DATA "/character/move.bvh"))
            .find("not carried"),
        std::string::npos);
}

TEST(OsgScene, PlaysAgainWhenSaved) {
    const std::string file = sceneFile("scene.osgt");
    const std::string saved = file + ".saved.osgb";
    {
        const Character leaning = osgSkin::loadCharacter(file, test::loadOptions("motion=lean"));
        ASSERT_TRUE(osgDB::writeNodeFile(*leaning.root, saved));
    }
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(saved);
    ASSERT_NE(read, nullptr);
    EXPECT_NEAR(leanOf(*read), 40.0, 1e-3);
}

TEST(OsgScene, IsBaked) {
    const std::string file = sceneFile("scene.osgt");
    const std::string folder = std::filesystem::path(file).parent_path().string();
    const test::CommandResult result = test::runBake(
        file + " --motion lean --frames 0:0:1 --out frame_%02d.obj --rest rest.obj", folder);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder + "/frame_00.obj"));
    EXPECT_TRUE(std::filesystem::exists(folder + "/rest.obj"));
    const Character character = osgSkin::loadCharacter(file);
    EXPECT_TRUE(character.hasBody());
    EXPECT_EQ(character.body.mesh.positions.size(), 18u);
}
