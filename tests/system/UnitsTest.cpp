// SPDX-License-Identifier: MIT
// A loaded scene is in metres, whatever the unit of its files.
#include "Command.h"
#include "DrawnSkin.h"
#include "ExpectContains.h"
#include "FindNodes.h"
#include "GlbFile.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "QuadRig.h"
#include "SkinFiles.h"
#include "TextFile.h"
#include "VrmFigure.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportMesh>
#include <osgSkinMotion/ClipCharacter>

#include <gtest/gtest.h>
#include <osg/ComputeBoundsVisitor>
#include <osg/MatrixTransform>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;

/// The corners of a post of two storeys: three squares, one above the other.
/// \param storey its height; the post is half as wide
std::string corners(double storey) {
    std::ostringstream out;
    for (int level = 0; level < 3; ++level)
        for (int corner = 0; corner < 4; ++corner)
            out << (level + corner == 0 ? "" : ",")
                << (corner == 1 || corner == 2 ? 0.25 : -0.25) * storey << "," << level * storey
                << "," << (corner > 1 ? 0.25 : -0.25) * storey;
    return out.str();
}

/// The FBX record of a list of numbers.
std::string record(const std::string& name, std::size_t count, const std::string& numbers) {
    return name + ": *" + std::to_string(count) + " {\n a: " + numbers + "\n}\n";
}

/// The FBX record of a bone's weights.
std::string cluster(int id, const std::string& vertices, const std::string& weights,
                    double height) {
    const std::string turn = "1,0,0,0,0,1,0,0,0,0,1,0,0,";
    return "Deformer: " + std::to_string(id) + ", \"SubDeformer::\", \"Cluster\" {\n" +
           record("Indexes", 8, vertices) + record("Weights", 8, weights) +
           record("Transform", 16, turn + std::to_string(-height) + ",0,1") +
           record("TransformLink", 16, turn + std::to_string(height) + ",0,1") + "}\n";
}

/// Writes an FBX file: a post of two bones, "lower" and "upper", 200 units tall.
/// \param centimetres per unit, as the file states it
std::string fbxPost(const std::string& folder, double centimetres) {
    const std::string half = "1,1,1,1,0.5,0.5,0.5,0.5", otherHalf = "0.5,0.5,0.5,0.5,1,1,1,1";
    std::ostringstream out;
    out << "; FBX 7.3.0 project file\nFBXHeaderExtension: {\n FBXHeaderVersion: 1003\n"
           " FBXVersion: 7300\n}\nGlobalSettings: {\n Version: 1000\n Properties70: {\n"
           "  P: \"UpAxis\", \"int\", \"Integer\", \"\",1\n"
           "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\","
        << centimetres << "\n }\n}\nObjects: {\nGeometry: 1, \"Geometry::\", \"Mesh\" {\n"
        << record("Vertices", 36, corners(100.0))
        << record("PolygonVertexIndex", 40,
                  "0,4,5,-2,1,5,6,-3,2,6,7,-4,3,7,4,-1,4,8,9,-6,5,9,10,-7,6,10,11,-8,7,11,8,-5,"
                  "0,1,2,-4,8,11,10,-10")
        << "GeometryVersion: 124\n}\nModel: 2, \"Model::body\", \"Mesh\" {\n}\n"
           "Model: 3, \"Model::lower\", \"LimbNode\" {\n}\n"
           "Model: 4, \"Model::upper\", \"LimbNode\" {\n Properties70: {\n"
           "  P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,100,0\n }\n}\n"
           "NodeAttribute: 5, \"NodeAttribute::lower\", \"LimbNode\" {\n}\n"
           "NodeAttribute: 6, \"NodeAttribute::upper\", \"LimbNode\" {\n}\n"
           "Deformer: 7, \"Deformer::\", \"Skin\" {\n}\n"
        << cluster(8, "0,1,2,3,4,5,6,7", half, 0.0)
        << cluster(9, "4,5,6,7,8,9,10,11", otherHalf, 100.0) << "}\nConnections: {\n";
    for (const auto& [child, parent] : std::vector<std::pair<int, int>>{{2, 0},
                                                                        {3, 0},
                                                                        {4, 3},
                                                                        {5, 3},
                                                                        {6, 4},
                                                                        {1, 2},
                                                                        {7, 1},
                                                                        {8, 7},
                                                                        {9, 7},
                                                                        {3, 8},
                                                                        {4, 9}})
        out << " C: \"OO\"," << child << "," << parent << "\n";
    out << "}\n";
    std::string file = folder + "/post.fbx";
    std::ofstream(file) << out.str();
    return file;
}

/// Writes a Collada file: the same post, 200 units tall.
/// \param metres per unit, as the file states it
std::string colladaPost(const std::string& folder, const std::string& metres) {
    std::string positions = corners(100.0);
    for (char& c : positions)
        if (c == ',') c = ' ';
    const auto source = [](const std::string& id, const std::string& array, const char* name,
                           int count, int stride, const char* type) {
        return "<source id=\"" + id + "\">" + array + "<technique_common><accessor source=\"#" +
               id + "-a\" count=\"" + std::to_string(count) + "\" stride=\"" +
               std::to_string(stride) + "\"><param name=\"" + name + "\" type=\"" + type +
               "\"/></accessor></technique_common></source>";
    };
    const auto floats = [](const std::string& id, int count, const std::string& numbers) {
        return "<float_array id=\"" + id + "-a\" count=\"" + std::to_string(count) + "\">" +
               numbers + "</float_array>";
    };
    std::ostringstream out;
    out << "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
           "version=\"1.4.1\"><asset><unit name=\"own\" meter=\""
        << metres
        << "\"/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id=\"post\"><mesh>"
           "<source id=\"p\">"
        << floats("p", 36, positions)
        << "<technique_common><accessor source=\"#p-a\" count=\"12\" stride=\"3\"><param "
           "name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
           "type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input "
           "semantic=\"POSITION\" source=\"#p\"/></vertices><polylist count=\"10\"><input "
           "semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>4 4 4 4 4 4 4 4 4 4</vcount>"
           "<p>0 4 5 1 1 5 6 2 2 6 7 3 3 7 4 0 4 8 9 5 5 9 10 6 6 10 11 7 7 11 8 4 0 1 2 3 8 11 10 "
           "9</p></polylist></mesh></geometry></library_geometries><library_controllers>"
           "<controller id=\"skin\"><skin source=\"#post\">"
        << source("j", "<Name_array id=\"j-a\" count=\"2\">lower upper</Name_array>", "JOINT", 2, 1,
                  "name")
        << source("b",
                  floats("b", 32,
                         "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 -100 0 0 1 0 0 0 0 1"),
                  "TRANSFORM", 2, 16, "float4x4")
        << source("w", floats("w", 2, "1 0.5"), "WEIGHT", 2, 1, "float")
        << "<joints><input semantic=\"JOINT\" source=\"#j\"/><input semantic=\"INV_BIND_MATRIX\" "
           "source=\"#b\"/></joints><vertex_weights count=\"12\"><input semantic=\"JOINT\" "
           "source=\"#j\" offset=\"0\"/><input semantic=\"WEIGHT\" source=\"#w\" offset=\"1\"/>"
           "<vcount>1 1 1 1 2 2 2 2 1 1 1 1</vcount><v>0 0 0 0 0 0 0 0 0 1 1 1 0 1 1 1 0 1 1 1 0 1 "
           "1 1 1 0 1 0 1 0 1 0</v></vertex_weights></skin></controller></library_controllers>"
           "<library_visual_scenes><visual_scene id=\"scene\"><node id=\"lower\" sid=\"lower\" "
           "name=\"lower\" type=\"JOINT\"><node id=\"upper\" sid=\"upper\" name=\"upper\" "
           "type=\"JOINT\"><translate>0 100 0</translate></node></node><node id=\"body\" "
           "name=\"body\"><instance_controller url=\"#skin\"><skeleton>#lower</skeleton>"
           "</instance_controller></node></visual_scene></library_visual_scenes><scene>"
           "<instance_visual_scene url=\"#scene\"/></scene></COLLADA>";
    std::string file = folder + "/post.dae";
    std::ofstream(file) << out.str();
    return file;
}

/// Writes a `.skin` file of the tests' tube (4 units tall), its motion and a prop.
std::string tubeSkin(const std::string& folder, const std::string& members) {
    const std::string move = test::kTubeFolder + "move.bvh";
    return test::saveSkin(folder + "/tube.skin", R"(, "motions": [{"file": ")" + move +
                                                     R"(", "name": "move"}], )" +
                                                     R"("props": [{"mesh": ")" + test::kTubeFolder +
                                                     R"(body.obj", "motion": "move", "file": ")" +
                                                     move + "\"}]" + members);
}

/// Writes a motion of two frames for the posts.
void saveStill(const std::string& file) {
    const std::string channels = "CHANNELS 3 Zrotation Yrotation Xrotation\n";
    std::ofstream(file) << "HIERARCHY\nROOT lower\n{\nOFFSET 0 0 0\n"
                        << channels << "JOINT upper\n{\nOFFSET 0 100 0\n"
                        << channels << "End Site\n{\nOFFSET 0 100 0\n}\n}\n}\nMOTION\nFrames: 2\n"
                        << "Frame Time: 0.1\n0 0 0 0 0 0\n0 0 0 10 0 0\n";
}

osg::BoundingBox boxOf(osg::Node& scene) {
    osg::ComputeBoundsVisitor visitor;
    scene.accept(visitor);
    return visitor.getBoundingBox();
}

/// Height of the drawn skin and rigid parts in the scene.
double heightOf(const Character& character) {
    osg::BoundingBoxd box;
    test::forEachCopy(character, [&](std::uint32_t, const osg::Vec3d& p) {
        box.expandBy(p * character.toWorld);
    });
    return box.zMax() - box.zMin();
}

double heightOf(const std::string& file, const std::string& options = {}) {
    return heightOf(loadCharacter(file, test::loadOptions(options)));
}

bool normalises(osg::Node& scene) {
    for (const auto& found : test::findNodes<osg::MatrixTransform>(scene))
        if (found.node->getName() == "upright")
            return found.node->getStateSet() != nullptr &&
                   found.node->getStateSet()->getMode(GL_NORMALIZE) == osg::StateAttribute::ON;
    return false;
}

} // namespace

TEST(Units, OfFbxAreRead) {
    const std::string folder = test::makeTestFolder();
    for (const auto& [centimetres, height] :
         std::vector<std::pair<double, double>>{{1.0, 2.0}, {2.54, 5.08}, {100.0, 200.0}}) {
        SCOPED_TRACE(centimetres);
        const std::string file = fbxPost(folder, centimetres);
        EXPECT_NEAR(osgSkin::importUnit(file), 0.01 * centimetres, 1e-9);
        const test::Notices notices;
        const Character character = loadCharacter(file);
        EXPECT_NEAR(heightOf(character), height, 1e-5 * height);
        EXPECT_NEAR(boxOf(*character.root).zMax(), height, 1e-4 * height);
        EXPECT_NEAR(character.metresPerUnit(), 0.01 * centimetres, 1e-9);
        EXPECT_NEAR(character.body.mesh.size(), 200.0, 1e-4); // rest space keeps the file's unit
        EXPECT_EQ(normalises(*character.root), centimetres != 100.0);
        EXPECT_EQ(notices.say("the body is 200 m tall by the unit that its file states"),
                  centimetres == 100.0)
            << notices.text();
        EXPECT_EQ(notices.lines(), centimetres == 100.0 ? 1u : 0u) << notices.text();
    }
}

TEST(Units, OfColladaAreRead) {
    const std::string folder = test::makeTestFolder();
    for (const auto& [metres, height] : std::vector<std::pair<std::string, double>>{
             {"0.01", 2.0}, {"0.0254", 5.08}, {"1", 200.0}}) {
        SCOPED_TRACE(metres);
        const std::string file = colladaPost(folder, metres);
        EXPECT_NEAR(heightOf(file), height, 1e-5 * height);
        EXPECT_EQ(osgSkin::importUnit(file), 1.0);
        EXPECT_NEAR(heightOf(file, "unit=m"), height, 1e-5 * height);
    }
}

TEST(Units, OfGltfAreMetres) {
    test::GltfColumn column;
    column.bend();
    const std::string file = column.save("units_column.gltf");
    EXPECT_EQ(osgSkin::importUnit(file), 1.0);
    const Character character = loadCharacter(file);
    EXPECT_NEAR(heightOf(character), 2.9, 1e-5);
    EXPECT_FALSE(normalises(*character.root));
    EXPECT_NEAR(heightOf(file, "unit=0.01"), 0.029, 1e-6);
}

/// A file in centimetres cannot say so.
TEST(Units, OfGltfAreDoubtedForGiants) {
    for (const auto& [scale, isDoubted] : {std::make_pair(30.0, true), {5.0, false}}) {
        test::GltfColumn column;
        column.json["nodes"][0]["scale"] = {scale, scale, scale};
        const std::string file = column.save("units_giant.gltf");
        const test::Notices notices;
        const Character character = loadCharacter(file);
        EXPECT_EQ(notices.say("the body is 87 m tall by the unit that its file states (glTF: "
                              "metres); set \"unit\" if they have another"),
                  isDoubted)
            << notices.text();
        loadCharacter(file, test::loadOptions("unit=m"));
        EXPECT_EQ(notices.lines(), isDoubted ? 1u : 0u) << notices.text();
    }
}

/// The height that is stated is the mesh's, also where the skeleton is taller.
TEST(Units, OfGltfAreNotDoubtedForGloves) {
    for (const auto& [scale, isDoubted] : {std::make_pair(1.0, false), {0.01, true}}) {
        test::VrmFigure figure;
        const double hand = double(figure.bones["leftHand"]);
        figure.json["nodes"][figure.bones["hips"]]["scale"] = {scale, scale, scale};
        nlohmann::json& indices = figure.json["meshes"][0]["primitives"][0]["indices"];
        indices = figure.accessor("SCALAR", {8.0 * hand, 8.0 * hand + 2, 8.0 * hand + 1}, 5123);
        const std::string file = figure.save("units_gloves.vrm");
        const test::Notices notices;
        loadCharacter(file);
        EXPECT_EQ(notices.say("the body is 0.0008 m tall"), isDoubted) << notices.text();
        EXPECT_EQ(notices.say("m tall"), isDoubted) << notices.text();
    }
}

TEST(Units, OfOtherFilesAreSetByOption) {
    const std::string folder = test::makeTestFolder();
    struct Case {
        std::string members, options;
        double height;
    };
    for (const Case& c :
         {Case{"", "", 4.0}, Case{R"(, "unit": "m")", "", 4.0}, Case{R"(, "unit": "cm")", "", 0.04},
          Case{R"(, "unit": "mm")", "", 0.004}, Case{R"(, "unit": "in")", "", 0.1016},
          Case{R"(, "unit": "ft")", "", 1.2192}, Case{R"(, "unit": 0.5)", "", 2.0},
          Case{"", "unit=cm", 0.04}, Case{"", "unit=0.5", 2.0},
          Case{R"(, "unit": "cm")", "unit=in", 0.1016}}) {
        SCOPED_TRACE(c.members + c.options);
        EXPECT_NEAR(heightOf(tubeSkin(folder, c.members), c.options), c.height, 1e-5 * c.height);
    }
}

TEST(Units, NumberOverridesTheFileAndNameDoesNot) {
    const std::string file = fbxPost(test::makeTestFolder(), 1.0);
    EXPECT_NEAR(heightOf(file, "unit=1"), 200.0, 1e-3);
    EXPECT_NEAR(heightOf(file, "unit=0.1"), 20.0, 1e-4);
    const test::Notices notices;
    EXPECT_NEAR(heightOf(file, "unit=cm"), 2.0, 1e-5);
    EXPECT_EQ(notices.text(), "");
    EXPECT_NEAR(heightOf(file, "unit=m"), 2.0, 1e-5);
    EXPECT_TRUE(notices.say("post.fbx: states that its unit is 0.01 m")) << notices.text();
    EXPECT_TRUE(notices.say("a number (\"unit\": 1) would replace it")) << notices.text();
}

TEST(Units, OfTheSkeletonAreUsedWhereTheMeshHasNone) {
    const std::string folder = test::makeTestFolder(), fbx = fbxPost(folder, 1.0);
    std::ofstream obj(folder + "/post.obj");
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(fbx);
    for (const glm::dvec3& p : mesh.mesh.positions)
        obj << "v " << p.x << " " << p.y << " " << p.z << "\n";
    const std::uint32_t* corner = mesh.mesh.faceVertices.data();
    for (const std::uint32_t size : mesh.mesh.faceSizes) {
        obj << "f";
        for (std::uint32_t k = 0; k < size; ++k) obj << " " << *corner++ + 1;
        obj << "\n";
    }
    obj.close();
    EXPECT_NEAR(heightOf(test::saveSkin(folder + "/post.skin", {}, "post.obj", "post.fbx")), 2.0,
                1e-5);
}

TEST(Units, RejectsUnknownUnits) {
    const std::string folder = test::makeTestFolder();
    for (const char* bad : {"\"furlong\"", "0", "-1", "1e30", "true", "\"\"", "[1]"}) {
        const std::string why =
            test::whyRefused(tubeSkin(folder, std::string(R"(, "unit": )") + bad));
        test::expectContains(why, "tube.skin: unit: expected", bad);
    }
    for (const char* bad : {"unit=furlong", "unit=0", "unit=nan", "unit=1m", "unit="})
        EXPECT_THROW(test::loadOptions(bad), osgSkin::Error) << bad;
}

/// Motion, root motion, rigid parts, props, bounds, saved files and crowds.
TEST(Units, ScaleEverythingInTheScene) {
    const std::string folder = test::makeTestFolder();
    Character metres = loadCharacter(tubeSkin(folder, ""));
    Character centimetres = loadCharacter(tubeSkin(folder, R"(, "unit": "cm")"));
    EXPECT_NEAR(double(centimetres.root->getBound().radius()),
                0.01 * double(metres.root->getBound().radius()), 1e-6);
    for (std::size_t frame = 0; frame < metres.motions[0].clip.frames; ++frame) {
        metres.pose(metres.motions[0], frame);
        centimetres.pose(centimetres.motions[0], frame);
        const osg::BoundingBox a = boxOf(*metres.root), b = boxOf(*centimetres.root);
        for (unsigned corner = 0; corner < 8; ++corner)
            EXPECT_LT((b.corner(corner) - a.corner(corner) * 0.01f).length(), 1e-6f) << frame;
    }
    const auto saved = folder + "/saved.osgb";
    ASSERT_TRUE(osgDB::writeNodeFile(*centimetres.root, saved));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(saved);
    ASSERT_TRUE(read.valid());
    EXPECT_NEAR(double(boxOf(*read).zMax()), double(boxOf(*centimetres.root).zMax()), 1e-6);
    EXPECT_TRUE(normalises(*read));

    const auto bakedHeight = [](osg::Node& scene) {
        const osg::ref_ptr<osgSkin::ClipCharacter> crowd = osgSkin::ClipCharacter::create(scene);
        crowd->bake(crowd->sample(*crowd->animations().front()));
        const osg::BoundingBox& box = crowd->bakedBounds();
        return double(box.zMax() - box.zMin());
    };
    EXPECT_NEAR(bakedHeight(*centimetres.root), 0.01 * bakedHeight(*metres.root), 1e-6);
}

/// The prop is 2.9 m tall beside a post in centimetres.
TEST(Units, OfPropsAreRead) {
    const std::string folder = test::makeTestFolder();
    fbxPost(folder, 1.0);
    saveStill(folder + "/prop.bvh");
    test::GltfColumn column;
    const std::string prop = column.save("units_prop.gltf");
    const auto heightOfProp = [&](const std::string& options) {
        const std::string file =
            test::saveSkin(folder + "/post.skin",
                           R"(, "motions": [{"file": "prop.bvh"}], "props": [{"mesh": ")" + prop +
                               R"(", "motion": "prop", "file": "prop.bvh"}])",
                           "post.fbx", "");
        const Character character = loadCharacter(file, test::loadOptions(options));
        for (const auto& found : test::findNodes<osg::MatrixTransform>(*character.root))
            if (found.node->getName() == "prop:prop:0") {
                const osg::BoundingBox box = boxOf(*found.node); // in skeleton space
                return double(box.yMax() - box.yMin()) * character.metresPerUnit();
            }
        return 0.0;
    };
    EXPECT_NEAR(heightOfProp(""), 2.9, 1e-4);
    EXPECT_NEAR(heightOfProp("unit=0.5"), 1.45, 1e-4); // a number is for all files
}

TEST(Units, OfBakedGlbAreMetres) {
    const std::string folder = test::makeTestFolder();
    fbxPost(folder, 1.0);
    saveStill(folder + "/still.bvh");
    test::saveSkin(folder + "/post.skin", R"(, "motions": [{"file": "still.bvh"}])", "post.fbx",
                   "");
    ASSERT_EQ(test::runBake("post.skin --out post.glb --rest rest.obj", folder).status, 0);
    const test::Glb glb(folder + "/post.glb");
    const nlohmann::json& node = glb.json["nodes"][0];
    ASSERT_TRUE(node.contains("scale")) << node;
    EXPECT_NEAR(node["scale"][1].get<double>(), 0.01, 1e-9);
    EXPECT_NEAR(osgSkin::importMesh(folder + "/post.glb").mesh.size(), 2.0, 1e-5);
    EXPECT_NEAR(osgSkin::importMesh(folder + "/rest.obj").mesh.size(), 200.0, 1e-3);
}

/// Copies a text file, with the vectors of its lines that begin with a word multiplied.
void copyScaled(const std::string& from, const std::string& to, const std::string& word,
                double factor) {
    std::istringstream in(test::fileText(from));
    std::ofstream out(to);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string first;
        double x = 0.0, y = 0.0, z = 0.0;
        if (words >> first >> x >> y >> z && first == word)
            out << word << ' ' << factor * x << ' ' << factor * y << ' ' << factor * z << '\n';
        else
            out << line << '\n';
    }
}

/// The thrower, eight times as large in files that state no unit.
TEST(Units, MissingOnesAreReportedForLargeBodies) {
    const std::string folder = test::makeTestFolder();
    copyScaled(OSGSKIN_DATA "/thrower.obj", folder + "/thrower.obj", "v", 8.0);
    copyScaled(OSGSKIN_DATA "/thrower.bvh", folder + "/thrower.bvh", "OFFSET", 8.0);
    const auto notesOf = [&](const std::string& unit) {
        std::ofstream(folder + "/a.skin")
            << R"({"osgskin": 1, "mesh": "thrower.obj", "skeleton": "thrower.bvh")" << unit << "}";
        return loadCharacter(folder + "/a.skin").notes;
    };
    ASSERT_EQ(notesOf("").size(), 1u);
    test::expectContains(notesOf("").front(), "the body is 14");
    EXPECT_TRUE(notesOf(R"(, "unit": 0.125)").empty());
    EXPECT_TRUE(loadCharacter(OSGSKIN_DATA "/thrower.skin").notes.empty());
}

/// Also of bodies whose joints are not recognised, if they are huge.
TEST(Units, MissingOnesAreReportedForHugeBodies) {
    const std::string folder = test::makeTestFolder();
    for (const auto& [size, notes] : {std::pair(1.0, 0u), {100.0, 1u}}) {
        copyScaled(test::kTubeFolder + "body.obj", folder + "/body.obj", "v", size);
        copyScaled(test::kTubeFolder + "rig.bvh", folder + "/rig.bvh", "OFFSET", size);
        const Character character =
            loadCharacter(test::saveSkin(folder + "/tube.skin", "", "body.obj", "rig.bvh"));
        EXPECT_EQ(character.notes.size(), notes) << size;
    }
}

TEST(Units, OfOsgScenesAreSetByOption) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("bone");
    skeleton->addChild(bone);
    osgAnimation::VertexInfluenceMap map;
    map["bone"].assign({{0, 1.0f}, {1, 1.0f}, {2, 1.0f}, {3, 1.0f}});
    skeleton->addChild(test::makeQuadRig(map));
    const std::string file = test::makeTestFolder() + "/quad.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*skeleton, file));
    const Character own = loadCharacter(file);
    const Character scaled = loadCharacter(file, test::loadOptions("unit=cm"));
    EXPECT_NEAR(double(boxOf(*scaled.root).radius()), 0.01 * double(boxOf(*own.root).radius()),
                1e-6);
    EXPECT_NEAR(scaled.metresPerUnit(), 0.01 * own.metresPerUnit(), 1e-9);
}
