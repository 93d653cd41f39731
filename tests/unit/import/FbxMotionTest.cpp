// SPDX-License-Identifier: MIT
// Transforms and curves of FBX files that Assimp does not read, or reads wrongly.
#include "assimp/FbxMotion.h"
#include "assimp/FbxCurve.h"
#include "assimp/FbxModels.h"

#include "FindNodes.h"
#include "Notices.h"

#include <osgSkin/GlmOsg>
#include <osgSkinImport/ImportRig>

#include <gtest/gtest.h>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::ImportedRig;

constexpr double kTicks = 46186158000.0;

struct FbxKey {
    double time, value;
};

/// A text file of a column of three boxes, one for each joint: "base", "middle" and "top", 50 units
/// apart along y.
class FbxColumn {
public:
    std::map<std::string, std::string> properties; ///< of a model, as text
    std::string meshName = "body";
    std::size_t meshes = 1;

    void set(const std::string& model, const std::string& property, const glm::dvec3& v) {
        std::ostringstream text;
        text << " P: \"" << property << "\", \"Vector3D\", \"Vector\", \"\"," << v.x << "," << v.y
             << "," << v.z << "\n";
        properties[model] += text.str();
    }
    void set(const std::string& model, const std::string& property, int value) {
        properties[model] +=
            " P: \"" + property + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n";
    }

    /// Adds a curve of a joint's property, such as 'R' and 'Z'.
    void move(std::size_t joint, char property, char axis, const std::vector<FbxKey>& keys,
              unsigned flags = kLinear, const std::string& slopes = "0,0") {
        std::string times, values;
        for (const FbxKey& key : keys) {
            times += (times.empty() ? "" : ",") + std::to_string(std::llround(key.time * kTicks));
            values += (values.empty() ? "" : ",") + std::to_string(key.value);
        }
        const std::string count = std::to_string(keys.size());
        const char* const full = property == 'R'   ? "Lcl Rotation"
                                 : property == 'S' ? "Lcl Scaling"
                                                   : "Lcl Translation";
        const auto [known, isNew] = _nodes.emplace(std::make_pair(joint, property), _next);
        const std::size_t node = known->second, curve = ++_next;
        ++_next;
        if (isNew) {
            _objects << "AnimationCurveNode: " << node << ", \"AnimCurveNode::" << property
                     << "\", \"\" {\n}\n";
            _connections << "C: \"OO\"," << node << ",91\nC: \"OP\"," << node << "," << 10 + joint
                         << ", \"" << full << "\"\n";
        }
        _objects << "AnimationCurve: " << curve << ", \"AnimCurve::\", \"\" {\nKeyTime: *" << count
                 << " {\n a: " << times << "\n}\nKeyValueFloat: *" << count << " {\n a: " << values
                 << "\n}\nKeyAttrFlags: *1 {\n a: " << flags
                 << "\n}\nKeyAttrDataFloat: *4 {\n a: " << slopes
                 << ",218434821,0\n}\nKeyAttrRefCount: *1 {\n a: " << count << "\n}\n}\n";
        _connections << "C: \"OP\"," << curve << "," << node << ", \"d|" << axis << "\"\n";
    }

    ImportedRig read(const glm::dmat4& mesh = glm::dmat4(1.0)) {
        const std::string path = testing::TempDir() + "column.fbx";
        std::ofstream out(path);
        out << "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\n"
               "FBXVersion: 7400\n}\nObjects: {\n";
        const char* const names[] = {"base", "middle", "top"};
        for (int j = 0; j < 3; ++j) {
            out << "Model: " << 10 + j << ", \"Model::" << names[j] << "\", \"LimbNode\" {\n"
                << "Properties70: {\n";
            if (properties[names[j]].find("Lcl Translation") == std::string::npos)
                out << " P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,"
                    << (j == 0 ? 0 : 50) << ",0\n";
            out << properties[names[j]] << "}\n}\nNodeAttribute: " << 20 + j
                << ", \"NodeAttribute::" << names[j] << "\", \"LimbNode\" {\n}\n";
            _connections << "C: \"OO\"," << 10 + j << "," << (j == 0 ? 0 : 9 + j) << "\nC: \"OO\","
                         << 20 + j << "," << 10 + j << "\n";
        }
        for (std::size_t m = 0; m < meshes; ++m) writeMesh(out, mesh, 1000 * (m + 1), m);
        out << "AnimationStack: 90, \"AnimStack::clip\", \"\" {\n}\n"
               "AnimationLayer: 91, \"AnimLayer::Base\", \"\" {\n}\n"
            << _objects.str() << "}\nConnections: {\nC: \"OO\",91,90\n"
            << _connections.str() << "}\n";
        out.close();
        return osgSkin::importRig(path);
    }

    static constexpr unsigned kLinear = 4, kConstant = 2, kUserTangents = 0x408;

private:
    void writeMesh(std::ostream& out, const glm::dmat4& toScene, std::size_t id, std::size_t m) {
        std::ostringstream places, faces;
        for (int v = 0; v < 24; ++v) {
            const int j = v / 8, c = v % 8;
            const glm::dvec3 p(c & 1 ? 10 : -10, 50 * j + (c & 2 ? 45 : 5), c & 4 ? 10 : -10);
            const glm::dvec3 own(glm::inverse(toScene) * glm::dvec4(p, 1.0));
            places << (v == 0 ? "" : ",") << own.x << "," << own.y << "," << own.z;
        }
        for (int j = 0; j < 3; ++j)
            for (const int corner :
                 {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5}) {
                const int v = 8 * j + corner, n = _corner++ % 4;
                faces << (j == 0 && _corner % 72 == 1 ? "" : ",") << (n == 3 ? -v - 1 : v);
            }
        out << "Model: " << id << ", \"Model::" << meshName << (meshes > 1 ? std::to_string(m) : "")
            << "\", \"Mesh\" {\nProperties70: {\n"
            << properties["body"] << "}\n}\nGeometry: " << id + 1
            << ", \"Geometry::\", \"Mesh\" {\nVertices: *72 {\n a: " << places.str()
            << "\n}\nPolygonVertexIndex: *72 {\n a: " << faces.str()
            << "\n}\nGeometryVersion: 124\n}\nDeformer: " << id + 2
            << ", \"Deformer::\", \"Skin\" {\n}\n";
        _connections << "C: \"OO\"," << id << ",0\nC: \"OO\"," << id + 1 << "," << id
                     << "\nC: \"OO\"," << id + 2 << "," << id + 1 << "\n";
        for (std::size_t j = 0; j < 3; ++j) {
            out << "Deformer: " << id + 3 + j
                << ", \"SubDeformer::\", \"Cluster\" {\nIndexes: *8 {\n a: ";
            for (std::size_t v = 0; v < 8; ++v) out << (v == 0 ? "" : ",") << 8 * j + v;
            out << "\n}\nWeights: *8 {\n a: 1,1,1,1,1,1,1,1\n}\nTransform: *16 {\n a: "
                   "1,0,0,0,0,1,0,0,0,0,1,0,0,"
                << -50.0 * double(j)
                << ",0,1\n}\nTransformLink: *16 {\n a: "
                   "1,0,0,0,0,1,0,0,0,0,1,0,0,"
                << 50 * j << ",0,1\n}\n}\n";
            _connections << "C: \"OO\"," << id + 3 + j << "," << id + 2 << "\nC: \"OO\"," << 10 + j
                         << "," << id + 3 + j << "\n";
        }
    }

    std::ostringstream _objects, _connections;
    std::map<std::pair<std::size_t, char>, std::size_t> _nodes; ///< of curves
    std::size_t _next = 100;                                    ///< object
    int _corner = 0;
};

glm::dmat4 moved(double x, double y, double z) {
    return glm::translate(glm::dmat4(1.0), {x, y, z});
}

/// By Euler angles in degrees, about x first.
glm::dmat4 turned(double x, double y, double z) {
    glm::dmat4 result(1.0);
    result = glm::rotate(result, glm::radians(z), {0, 0, 1});
    result = glm::rotate(result, glm::radians(y), {0, 1, 0});
    return glm::rotate(result, glm::radians(x), {1, 0, 0});
}

template <typename Channel, typename Value>
Value valueAt(const osgAnimation::Animation& clip, const std::string& joint,
              const std::string& element, double time, const Value& otherwise) {
    for (const auto& channel : clip.getChannels()) {
        if (channel->getTargetName() != joint || channel->getName() != element) continue;
        Value result;
        dynamic_cast<Channel&>(*channel).getSamplerTyped()->getValueAt(time, result);
        return result;
    }
    return otherwise;
}

/// A joint's skinning matrix at a time of the first clip.
glm::dmat4 skinningAt(const ImportedRig& rig, const std::string& joint, double time) {
    using namespace osgAnimation;
    const Animation& clip = *rig.animations.at(0);
    osg::Matrixd world;
    bool isFound = false;
    for (const auto& found : test::findNodes<Bone>(*rig.skeleton)) {
        if (found.node->getName() != joint) continue;
        isFound = true;
        world = found.node->getInvBindMatrixInSkeletonSpace();
        for (const Bone* bone = found.node; bone != nullptr; bone = bone->getBoneParent()) {
            const std::string& name = bone->getName();
            const osg::Matrixd& rest = bone->getMatrix();
            world = world *
                    osg::Matrixd::scale(valueAt<Vec3LinearChannel>(clip, name, "scale", time,
                                                                   osg::Vec3(rest.getScale()))) *
                    osg::Matrixd::rotate(valueAt<QuatSphericalLinearChannel>(
                        clip, name, "quaternion", time, rest.getRotate())) *
                    osg::Matrixd::translate(valueAt<Vec3LinearChannel>(
                        clip, name, "translate", time, osg::Vec3(rest.getTrans())));
        }
    }
    EXPECT_TRUE(isFound) << joint;
    return osgSkin::toGlm(world);
}

/// Compares where a joint moves its box.
void expectMoved(const ImportedRig& rig, const std::string& joint, double time,
                 const glm::dmat4& expected) {
    ASSERT_EQ(rig.animations.size(), 1u);
    const glm::dmat4 skinning = skinningAt(rig, joint, time);
    for (const glm::dvec4& p :
         {glm::dvec4(0, 0, 0, 1), glm::dvec4(10, 50, 10, 1), glm::dvec4(-10, 95, 10, 1)})
        EXPECT_LT(glm::distance(skinning * p, expected * p), 0.01) << joint << " at " << time;
}

} // namespace

TEST(FbxMotion, StepsHoldTheirValue) {
    FbxColumn column;
    column.move(1, 'R', 'Z', {{0, 0}, {0.5, 45}, {1, 90}}, FbxColumn::kConstant);
    const ImportedRig rig = column.read();
    const auto by = [](double z) { return moved(0, 50, 0) * turned(0, 0, z) * moved(0, -50, 0); };
    expectMoved(rig, "middle", 1.0 / 3.0, by(0));
    expectMoved(rig, "middle", 0.5, by(45));
    expectMoved(rig, "middle", 0.9, by(45));
    expectMoved(rig, "middle", 1.0, by(90));
}

TEST(FbxMotion, EulerAnglesAreInterpolatedSeparately) {
    FbxColumn column;
    column.move(1, 'R', 'X', {{0, 0}, {1, 80}});
    column.move(1, 'R', 'Y', {{0, 0}, {1, 90}});
    column.move(1, 'R', 'Z', {{0, 0}, {1, 70}});
    expectMoved(column.read(), "middle", 0.5,
                moved(0, 50, 0) * turned(40, 45, 35) * moved(0, -50, 0));
}

TEST(FbxMotion, RotationsBeyondHalfATurnKeepTheirWay) {
    FbxColumn column;
    column.move(1, 'R', 'Z', {{0, 0}, {1, 720}});
    expectMoved(column.read(), "middle", 0.25,
                moved(0, 50, 0) * turned(0, 0, 180) * moved(0, -50, 0));
}

TEST(FbxMotion, TangentsEase) {
    FbxColumn column;
    column.move(1, 'T', 'X', {{0, 0}, {1, 90}}, FbxColumn::kUserTangents);
    const double u = 7.0 / 30.0;
    expectMoved(column.read(), "middle", u, moved(90 * (3 * u * u - 2 * u * u * u), 0, 0));
}

TEST(FbxMotion, PivotsAreKept) {
    FbxColumn column;
    column.set("middle", "RotationPivot", {0, 10, 0});
    column.set("middle", "RotationOffset", {5, 0, 0});
    column.move(1, 'R', 'Z', {{0, 0}, {1, 60}});
    // The bones are bound without the offset.
    expectMoved(column.read(), "middle", 1.0,
                moved(5, 60, 0) * turned(0, 0, 60) * moved(0, -60, 0));
}

/// Maya's segment scale compensate: a joint's place inherits the scale above, its size does not.
TEST(FbxMotion, SegmentScaleIsCompensated) {
    FbxColumn column;
    for (const char* joint : {"middle", "top"}) column.set(joint, "InheritType", 2);
    for (const char axis : {'X', 'Y', 'Z'}) column.move(1, 'S', axis, {{0, 1}, {1, 1.6}});
    const ImportedRig rig = column.read();
    expectMoved(rig, "middle", 1.0,
                moved(0, 50, 0) * glm::scale(glm::dmat4(1.0), glm::dvec3(1.6)) * moved(0, -50, 0));
    expectMoved(rig, "top", 1.0, moved(0, 30, 0));
    expectMoved(rig, "top", 0.5, moved(0, 15, 0));
}

/// Nodes of a scene inherit scale by matrices.
TEST(FbxMotion, OtherInheritanceOfUnevenScaleIsReported) {
    const auto noticesOf = [](double height, int type) {
        FbxColumn column;
        column.set("base", "Lcl Scaling", {1, height, 1});
        for (const char* joint : {"middle", "top"}) column.set(joint, "InheritType", type);
        column.move(2, 'R', 'Z', {{0, 0}, {1, 60}});
        const test::Notices notices;
        column.read();
        return notices.text();
    };
    for (const int other : {0, 2})
        EXPECT_NE(noticesOf(1.5, other).find("uneven scale above \"middle\" and 1 more"),
                  std::string::npos)
            << other;
    EXPECT_EQ(noticesOf(1.5, 1).find("uneven"), std::string::npos);
    for (const int any : {0, 1, 2})
        EXPECT_EQ(noticesOf(1.0, any).find("uneven"), std::string::npos) << any;
}

/// 3ds Max's object offset moves the mesh, whose node stands elsewhere.
TEST(FbxMotion, GeometricTransformsPlaceTheMesh) {
    FbxColumn column;
    column.set("body", "Lcl Translation", {-28, 3, -8});
    column.set("body", "Lcl Rotation", {90, -44, 20});
    column.set("body", "GeometricTranslation", {-9, 23, 4});
    column.set("body", "GeometricRotation", {0, 0, 135});
    column.move(1, 'R', 'Z', {{0, 0}, {1, 40}});
    const ImportedRig rig =
        column.read(moved(-28, 3, -8) * turned(90, -44, 20) * moved(-9, 23, 4) * turned(0, 0, 135));
    glm::dvec3 low(1e9), high(-1e9);
    for (const glm::dvec3& p : rig.body.mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    EXPECT_LT(glm::distance(low, glm::dvec3(-10, 5, -10)), 0.01);
    EXPECT_LT(glm::distance(high, glm::dvec3(10, 145, 10)), 0.01);
    expectMoved(rig, "middle", 1.0, moved(0, 50, 0) * turned(0, 0, 40) * moved(0, -50, 0));
}

/// Blender writes the frame that it shows into the nodes; the mesh is bound in the rest pose.
TEST(FbxMotion, FrameShownAtExportIsNotTheRestPose) {
    for (const double degrees : {30.0, 60.0, 180.0}) {
        FbxColumn column;
        column.set("base", "Lcl Rotation", {0, degrees, 0});
        column.move(0, 'R', 'Y', {{0, 0}, {1, degrees}});
        const ImportedRig rig = column.read();
        expectMoved(rig, "base", 0.0, glm::dmat4(1.0));
        expectMoved(rig, "base", 1.0, turned(0, degrees, 0));
    }
    FbxColumn lying;
    lying.set("base", "Lcl Rotation", {90, 0, 0});
    lying.set("base", "Lcl Translation", {400, 0, 0});
    lying.move(0, 'R', 'X', {{0, 0}, {1, 90}});
    lying.move(0, 'T', 'X', {{0, 0}, {1, 400}});
    const ImportedRig rig = lying.read();
    expectMoved(rig, "base", 0.0, glm::dmat4(1.0));
    expectMoved(rig, "base", 1.0, moved(400, 0, 0) * turned(90, 0, 0));
}

/// A clip that never comes near the bind pose shows another place of the figure, not a pose.
TEST(FbxMotion, FigureInAnotherPlaceRestsThere) {
    FbxColumn column;
    column.set("base", "Lcl Translation", {400, 0, 0});
    column.move(0, 'T', 'X', {{0, 400}, {1, 420}});
    expectMoved(column.read(), "base", 0.0, glm::dmat4(1.0));
}

TEST(FbxMotion, VerticesAreShared) {
    EXPECT_EQ(FbxColumn().read().body.mesh.positions.size(), 24u);
}

TEST(FbxMotion, CoarserLevelsAreLeftOut) {
    FbxColumn column;
    column.meshes = 3;
    column.meshName = "Body_LOD";
    const test::Notices notices;
    EXPECT_EQ(column.read().body.mesh.positions.size(), 24u);
    EXPECT_TRUE(notices.say("2 coarser levels of detail are left out, \"Body_LOD1\" among them"))
        << notices.text();
}

/// Assimp 5.4 keeps nine of 31 keys of a rotation.
TEST(FbxMotion, KeysThatAssimpLosesAreRead) {
    FbxColumn column;
    std::vector<FbxKey> keys;
    for (int k = 0; k <= 30; ++k) keys.push_back({k / 30.0, 40.0 * k / 30.0});
    column.move(1, 'R', 'Z', keys);
    column.read();
    std::ifstream file(testing::TempDir() + "column.fbx");
    std::stringstream bytes;
    bytes << file.rdbuf();

    osgSkin::SourceScene scene;
    scene.addNode("root", -1, glm::dmat4(1.0));
    scene.addNode("base", 0, glm::dmat4(1.0));
    scene.addNode("middle", 1, moved(0, 50, 0));
    const auto clip = std::make_shared<osgSkin::SourceAnimation>();
    clip->name = "clip";
    clip->ticksPerSecond = 1000.0;
    clip->tracks.push_back({"middle", {}, {{0.0, glm::quat(1, 0, 0, 0)}}, {}});
    scene.animations.push_back(clip);
    osgSkin::FbxModels models(osgSkin::FbxDocument::read(bytes.str(), "column.fbx"));
    osgSkin::correctFbx(models, "column.fbx", {}, scene);
    const auto& rotations = scene.animations.at(0)->tracks.at(0).rotations;
    ASSERT_GE(rotations.size(), keys.size());
    EXPECT_NEAR(rotations.back().time, 1000.0, 1e-6);
    EXPECT_NEAR(glm::degrees(glm::angle(rotations.back().value)), 40.0, 1e-3);
}

TEST(FbxMotion, UnknownBytesChangeNothing) {
    osgSkin::SourceScene scene;
    scene.addNode("root", -1, glm::dmat4(3.0));
    for (const char* bytes : {"", "Objects: {", "Objects: { Model: 1"}) {
        osgSkin::FbxModels models(osgSkin::FbxDocument::read(bytes, "x.fbx"));
        osgSkin::correctFbx(models, "x.fbx", {}, scene);
    }
    ASSERT_EQ(scene.nodes.size(), 1u);
    EXPECT_EQ(scene.nodes[0].matrix, glm::dmat4(3.0));
}

TEST(FbxModels, AreConnected) {
    const osgSkin::FbxDocument document = osgSkin::FbxDocument::read(
        "; FBX 7.4.0 project file\nFBXVersion: 7400\nObjects: {\n"
        "Model: 1, \"Model::upper\", \"LimbNode\" {\n}\n"
        "Model: 2, \"Model::lower\", \"LimbNode\" {\nProperties70: {\n"
        " P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,5,0\n"
        " P: \"RotationPivot\", \"Vector3D\", \"Vector\", \"\",0,2,0\n}\n}\n}\n"
        "Connections: {\nC: \"OO\",1,0\nC: \"OO\",2,1\n}\n",
        "x.fbx");
    const osgSkin::FbxModels models(document);
    ASSERT_EQ(models.models.size(), 2u);
    ASSERT_EQ(models.roots.size(), 1u);
    EXPECT_EQ(models.roots[0]->name, "upper");
    ASSERT_EQ(models.roots[0]->children.size(), 1u);
    const osgSkin::FbxModel& lower = *models.roots[0]->children[0];
    EXPECT_EQ(lower.parent, models.roots[0]);
    EXPECT_TRUE(lower.hasPivots());
    // A half turn about the pivot, at 7: the origin goes from 5 to 9.
    const osgSkin::NodeTransform turned =
        lower.transform({lower.own[0], glm::dvec3(0, 0, 180), glm::dvec3(1.0)}, glm::dvec3(1.0));
    EXPECT_LT(glm::distance(turned.translation, glm::dvec3(0, 9, 0)), 1e-9);
}

namespace {

osgSkin::FbxRecord curveOf(const std::vector<double>& seconds, const std::vector<double>& values,
                           const std::vector<double>& flags, const std::vector<double>& data) {
    std::vector<double> times, counts(flags.size(), 1.0);
    for (const double second : seconds) times.push_back(second * kTicks);
    osgSkin::FbxRecord result;
    const auto add = [&result](const char* name, const std::vector<double>& list) {
        osgSkin::FbxRecord& record = result.records.emplace_back();
        record.name = name;
        record.numbers = list;
    };
    add("KeyTime", times);
    add("KeyValueFloat", values);
    add("KeyAttrFlags", flags);
    add("KeyAttrDataFloat", data);
    add("KeyAttrRefCount", counts);
    return result;
}

} // namespace

TEST(FbxCurve, AutomaticTangentsFollowTheNeighbours) {
    const double smooth = 0x108, flat = 0x4108;
    const std::vector<double> none(12, 0.0);
    const osgSkin::FbxCurve line(curveOf({0, 1, 2}, {0, 1, 2}, {smooth, smooth, smooth}, none));
    EXPECT_NEAR(line.at(0.25), 0.25, 1e-9);
    EXPECT_FALSE(line.isCurved(0));
    const osgSkin::FbxCurve hill(curveOf({0, 1, 2}, {0, 1, 0}, {flat, flat, flat}, none));
    EXPECT_NEAR(hill.at(0.5), 0.5, 1e-9);
    EXPECT_LE(hill.at(0.99), 1.0);
    EXPECT_TRUE(hill.isCurved(0));
}

TEST(FbxCurve, WeightedTangentsBendTime) {
    const double weights = 0x2fcc0000 + 0x2fcc; // 1.2236 of 9999 for both tangents
    const osgSkin::FbxCurve plain(
        curveOf({0, 1}, {0, 1}, {0x408, 0x408}, std::vector<double>(8, 0)));
    const osgSkin::FbxCurve strong(
        curveOf({0, 1}, {0, 1}, {0x3000408, 0x3000408}, {0, 0, weights, 0, 0, 0, weights, 0}));
    EXPECT_NEAR(plain.at(0.5), 0.5, 1e-9);
    EXPECT_NEAR(strong.at(0.5), 0.5, 1e-9);
    EXPECT_LT(strong.at(0.2), plain.at(0.2));
}
