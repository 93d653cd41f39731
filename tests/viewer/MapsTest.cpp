// SPDX-License-Identifier: MIT
// Pictures of normal, occlusion and emission maps: equal to computed ones, to the fixed pipeline's
// where the maps are neutral, and the same for skins in all their forms.
#include "ColouredMap.h"
#include "FindNodes.h"
#include "GltfBuilder.h"
#include "Pixels.h"
#include "Window.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinImport/ImportMesh>
#include <osgSkinRig/MeshPart>

#include <osg/Light>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

namespace {

using nlohmann::json;
using Colours = std::array<osg::Vec3, 4>;

constexpr double kDistance = 3.0;
const osg::Vec3d kCentre(0, 1, 0), kFront(0, 1, kDistance), kBack(0, 1, -kDistance);
const osg::Vec3 kWhite(1, 1, 1), kBlack;
const Colours kFlat{test::asColour({0, 0, 1}), test::asColour({0, 0, 1}), test::asColour({0, 0, 1}),
                    test::asColour({0, 0, 1})};
const Colours kWhites{kWhite, kWhite, kWhite, kWhite};
const Colours kBumps{test::asColour({0.6f, 0, 1}), test::asColour({-0.6f, 0, 1}),
                     test::asColour({0, 0.6f, 1}), test::asColour({0, -0.6f, 1})};

/// A board that faces +z, x -1 to 1, y 0 to 2, and has one texture all over: its lower half follows
/// a joint, and its upper half a second one.
struct Board : test::GltfBuilder {
    Board() {
        constexpr int kRows = 5, kColumns = 3;
        std::vector<double> positions, normals, texCoords, joints, weights, corners;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const double u = column / double(kColumns - 1), v = row / double(kRows - 1);
                positions.insert(positions.end(), {2 * u - 1, 2 * v, 0});
                normals.insert(normals.end(), {0, 0, 1});
                texCoords.insert(texCoords.end(), {u, 1 - v});
                joints.insert(joints.end(), {0, 1, 0, 0});
                const double upper = std::clamp(2.0 * v - 0.5, 0.0, 1.0);
                weights.insert(weights.end(), {1 - upper, upper, 0, 0});
                const int at = row * kColumns + column;
                if (row + 1 < kRows && column + 1 < kColumns)
                    for (const int corner : {0, 1, kColumns, 1, kColumns + 1, kColumns})
                        corners.push_back(at + corner);
            }
        node({{"name", "lower"}, {"children", {1}}});
        node({{"name", "upper"}, {"translation", {0, 1, 0}}});
        node({{"mesh", 0}, {"skin", 0}});
        const std::vector<double> binds{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
        json["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", accessor("MAT4", binds)}}};
        json["meshes"].push_back({{"primitives",
                                   {{{"attributes",
                                      {{"POSITION", accessor("VEC3", positions)},
                                       {"NORMAL", accessor("VEC3", normals)},
                                       {"TEXCOORD_0", accessor("VEC2", texCoords)},
                                       {"JOINTS_0", accessor("VEC4", joints, 5121)},
                                       {"WEIGHTS_0", accessor("VEC4", weights)}}},
                                     {"indices", accessor("SCALAR", corners, 5123)},
                                     {"material", 0}}}}});
        json["scenes"][0]["nodes"] = {0, 2};
        json["materials"] = {nlohmann::json::object()};
        material()["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    }

    /// Adds a texture; returns its colours as they are in the file.
    Colours map(const char* member, const Colours& quarters) {
        const std::string name =
            std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + member +
            ".bmp";
        material()[member] = {{"index", json["textures"].size()}};
        json["textures"].push_back({{"source", json["images"].size()}});
        json["images"].push_back({{"uri", name}});
        return test::writeMap(name, quarters);
    }

    nlohmann::json& material() { return json["materials"][0]; }
    nlohmann::json& attributes() { return json["meshes"][0]["primitives"][0]["attributes"]; }

    std::string saveAs(const std::string& ending) {
        return save(testing::UnitTest::GetInstance()->current_test_info()->name() + ending);
    }
    osg::ref_ptr<osg::Group> rest() {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (const osgSkin::MeshPart& part : osgSkin::importMesh(saveAs(".gltf")).parts)
            group->addChild(part.geometry);
        return group;
    }
};

struct Lamp {
    osg::Vec4 position;
    osg::Vec3 diffuse, ambient;
};

osg::ref_ptr<osg::Image> pictureOf(osg::Node* node, const Lamp& lamp,
                                   const osg::Vec3d& eye = kFront) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::Light& light = *source->getLight();
    light.setPosition(lamp.position);
    light.setDiffuse({lamp.diffuse, 1.0f});
    light.setSpecular({lamp.diffuse, 1.0f});
    light.setAmbient({0, 0, 0, 1});
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({lamp.ambient, 1.0f});
    osg::StateSet& state = *scene->getOrCreateStateSet();
    state.setAttribute(model);
    state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
    source->setStateSetModes(state, osg::StateAttribute::ON);
    scene->addChild(source);
    scene->addChild(node);
    test::Windows window(scene, eye, kCentre);
    window.viewer.getView(0)->setLightingMode(osg::View::NO_LIGHT);
    window.frame(1.0);
    return window.pictures().front();
}

/// The middles of the board's quarters, ordered as those of its texture.
Colours middles(const osg::Image& picture) {
    Colours result;
    const double scale =
        0.5 * picture.t() / (kDistance * std::tan(osg::DegreesToRadians(20.0))); // half of 40
    for (unsigned q = 0; q < 4; ++q) {
        const auto at = [&](bool isFar) {
            return static_cast<int>(0.5 * picture.s() + (isFar ? 0.5 : -0.5) * scale);
        };
        const auto pixel = static_cast<unsigned>(at(q / 2 != 0) * picture.s() + at(q % 2 != 0));
        for (unsigned i = 0; i < 3; ++i)
            result[q][i] = float(test::channel(picture, pixel, i)) / 255.0f;
    }
    return result;
}

void expectEqual(const Colours& found, const Colours& expected) {
    for (unsigned q = 0; q < 4; ++q)
        EXPECT_LT((found[q] - expected[q]).length(), 0.015f) << q << ' ' << found[q].x();
}

/// The largest difference of two pictures' pixels.
int difference(const osg::Image& a, const osg::Image& b) {
    int result = 0;
    for (unsigned pixel = 0; pixel < test::pixelCount(a); ++pixel)
        for (unsigned i = 0; i < 3; ++i)
            result =
                std::max(result, std::abs(test::channel(a, pixel, i) - test::channel(b, pixel, i)));
    return result;
}

const Lamp kAside{{1.0f, 0.5f, 1.0f, 0.0f}, kWhite, kBlack};

} // namespace

TEST(Maps, NormalMapsChangeTheLighting) {
    osg::Vec3 toLight(kAside.position.x(), kAside.position.y(), kAside.position.z());
    toLight.normalize();
    for (const double scale : {1.0, 0.5}) {
        Board board;
        const Colours texels = board.map("normalTexture", kBumps);
        board.material()["normalTexture"]["scale"] = scale;
        Colours expected;
        for (unsigned q = 0; q < 4; ++q) {
            osg::Vec3 normal = texels[q] * 2.0f - osg::Vec3(1, 1, 1);
            normal.x() *= float(scale);
            normal.y() *= float(scale);
            normal.normalize();
            expected[q] = kWhite * (normal * toLight);
        }
        expectEqual(middles(*pictureOf(board.rest(), kAside)), expected);
        EXPECT_GT(expected[0].x() - expected[1].x(), 0.25f) << "bumps that are seen";
        EXPECT_GT(expected[2].x() - expected[3].x(), 0.1f) << "bumps that are seen";
    }
}

TEST(Maps, OcclusionDarkensAmbientLightAndEmissionIsAdded) {
    const Colours shade{osg::Vec3(0.2f, 1, 1), osg::Vec3(0.4f, 1, 1), osg::Vec3(0.6f, 1, 1),
                        kWhite};
    const Colours glow{osg::Vec3(0.1f, 0, 0), osg::Vec3(0, 0.2f, 0), osg::Vec3(0, 0, 0.3f), kBlack};
    Board board;
    const Colours open = board.map("occlusionTexture", shade);
    const Colours light = board.map("emissiveTexture", glow);
    board.material()["occlusionTexture"]["strength"] = 0.5;
    board.material()["emissiveFactor"] = {1, 1, 1};
    const osg::ref_ptr<osg::Group> rest = board.rest();
    const osg::Vec4 ahead(0, 0, 1, 0);
    Colours ambient, direct;
    for (unsigned q = 0; q < 4; ++q) {
        const float share = 1.0f + 0.5f * (open[q].x() - 1.0f);
        ambient[q] = kWhite * 0.5f * share + light[q];
        direct[q] = kWhite * 0.5f + light[q];
    }
    expectEqual(middles(*pictureOf(rest, {ahead, kBlack, kWhite * 0.5f})), ambient);
    expectEqual(middles(*pictureOf(rest, {ahead, kWhite * 0.5f, kBlack})), direct);
    expectEqual(middles(*pictureOf(rest, {ahead, kBlack, kBlack})), light);
}

/// Colours, highlights, lamps near by, textures, both sides, vertex colours, transparency.
TEST(Maps, NeutralMapsMatchTheFixedPipeline) {
    struct Case {
        const char* name;
        json material;
        bool hasColours;
        Lamp lamp;
        osg::Vec3d eye;
    };
    const json glossy = {{"pbrMetallicRoughness",
                          {{"roughnessFactor", 0.7}, {"baseColorFactor", {0.5, 0.2, 0.8, 0.6}}}}};
    json both = glossy, mask = glossy, blend = glossy;
    both["doubleSided"] = true;
    mask["alphaMode"] = "MASK";
    mask["alphaCutoff"] = 0.7;
    blend["alphaMode"] = "BLEND";
    const Lamp dim{{1, 0.5f, 1, 0}, {0.5f, 0.6f, 0.4f}, {0.2f, 0.3f, 0.1f}};
    const Lamp behind{{1, 0.5f, -1, 0}, {0.5f, 0.6f, 0.4f}, {0.2f, 0.3f, 0.1f}};
    const Lamp far{{300, 200, 300, 1}, {0.5f, 0.6f, 0.4f}, {0.2f, 0.3f, 0.1f}};
    const Case cases[] = {
        {"plain", json::object(), false, dim, kFront}, {"glossy", glossy, false, dim, kFront},
        {"one_sided", glossy, false, behind, kBack},   {"both_sides", both, false, behind, kBack},
        {"far_lamp", glossy, false, far, kFront},      {"coloured", glossy, true, dim, kFront},
        {"masked", mask, false, dim, kFront},          {"blended", blend, false, dim, kFront}};
    for (const Case& each : cases) {
        Board board;
        board.material() = each.material;
        if (each.hasColours)
            board.attributes()["COLOR_0"] = board.accessor("VEC3", [] {
                std::vector<double> colours;
                for (int v = 0; v < 15; ++v) colours.insert(colours.end(), {1, v / 14.0, 0.5});
                return colours;
            }());
        const auto plain = pictureOf(board.rest(), each.lamp, each.eye);
        board.map("normalTexture", kFlat);
        board.map("occlusionTexture", kWhites);
        const auto mapped = pictureOf(board.rest(), each.lamp, each.eye);
        // The flat normal of eight bits is tilted by a third of a degree.
        EXPECT_LE(difference(*plain, *mapped), 3) << each.name;
        const std::string name = each.name;
        const bool isSeen = name != "one_sided" && name != "masked";
        EXPECT_EQ(test::seenPixels(*plain) > 10000, isSeen) << each.name;
    }
}

/// A skin whose joint rotates all of it, deformed by the processor, by the card, and saved.
TEST(Maps, NormalMapsRotateWithTheSkin) {
    Board board;
    board.map("normalTexture", kBumps);
    const double half = 0.5 * osg::DegreesToRadians(90.0);
    const std::vector<double> turn{0, 0, std::sin(half), std::cos(half)};
    std::vector<double> turns(turn);
    turns.insert(turns.end(), turn.begin(), turn.end());
    board.animate("turn", 0, "rotation", {0.0, 9.0}, turns);
    // About the board's middle.
    board.animate("turn", 0, "translation", {0.0, 9.0}, {1, 1, 0, 1, 1, 0});

    const osg::Matrixd rotation =
        osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(1, 1, 0);
    const osg::ref_ptr<osg::MatrixTransform> reference = new osg::MatrixTransform(rotation);
    reference->addChild(board.rest());
    const auto expected = pictureOf(reference, kAside);
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    EXPECT_GT(test::unlikePixels(*expected, *pictureOf(board.rest(), kAside)), 1000u);

    const std::string file = board.saveAs(".gltf") + ".skin";
    // The character stands on the ground with z up.
    const osg::ref_ptr<osg::MatrixTransform> upright =
        new osg::MatrixTransform(osg::Matrixd::rotate(-osg::PI_2, osg::Vec3d(1, 0, 0)));
    const auto show = [&](const std::string& path, const char* options) {
        upright->removeChildren(0, upright->getNumChildren());
        const osg::ref_ptr<osg::Node> node =
            osgDB::readRefNodeFile(path, new osgDB::Options(options));
        if (!node) {
            ADD_FAILURE() << path;
            return osg::ref_ptr<osg::Image>(new osg::Image(*expected));
        }
        upright->addChild(node);
        const auto skins = test::findNodes<osgSkin::DeformableSkin>(*node);
        EXPECT_EQ(skins.size(), 1u);
        for (const auto& skin : skins) {
            EXPECT_EQ(skin.node->getTangentAttribute(), int(osgSkin::MeshPart::kTangentAttribute));
            EXPECT_EQ(skin.node->getDrawBackend() != nullptr, std::string(options) == "gpu=on");
        }
        return pictureOf(upright, kAside);
    };
    EXPECT_EQ(test::unlikePixels(*show(file, ""), *expected), 0u);
    EXPECT_EQ(test::unlikePixels(*show(file, "gpu=on"), *expected), 0u);
    for (const char* ending : {".osgb", ".osgt", ".osgx"}) {
        const std::string saved = file + ending;
        ASSERT_TRUE(osgDB::writeNodeFile(*osgDB::readRefNodeFile(file), saved));
        EXPECT_EQ(test::unlikePixels(*show(saved, ""), *expected), 0u) << ending;
    }
}
