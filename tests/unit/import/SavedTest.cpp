// SPDX-License-Identifier: MIT
// Scenes that OSG saved: read as OSG reads them, and refused where OSG believes what it reads.
#include "ExpectError.h"
#include "Paths.h"
#include "TextFile.h"

#include <osgSkinImport/ReadScene>

#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include <unistd.h>

namespace {

std::string scratch(const std::string& name, const std::string& content) {
    // Tests run beside each other.
    std::string path = testing::TempDir() + std::to_string(::getpid()) + name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

osg::ref_ptr<osg::Node> read(const std::string& path, const std::string& options = {}) {
    const osg::ref_ptr<osgDB::Options> with = new osgDB::Options(options);
    return osgSkin::readScene(path, with.get());
}

/// The scene in a text file, to compare.
std::string textOf(osg::Node& scene) {
    const std::string path = scratch("compared.osgt", {});
    const osg::ref_ptr<osgDB::Options> exact = new osgDB::Options("precision 17");
    osgDB::writeNodeFile(scene, path, exact.get());
    return test::fileText(path);
}

/// A triangle with a material, a picture of 2 x 2 pixels and buffer objects, shown twice.
osg::ref_ptr<osg::Node> makeScene() {
    const osg::ref_ptr<osg::Geometry> triangle = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    for (int i = 0; i < 3; ++i) places->push_back(osg::Vec3(float(i), float(i % 2), 0.125f));
    triangle->setVertexArray(places);
    triangle->setUseVertexBufferObjects(true);
    const osg::ref_ptr<osg::DrawElementsUShort> corners = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (const int i : {0, 2, 1}) corners->push_back(static_cast<unsigned short>(i));
    triangle->addPrimitiveSet(corners);
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    std::fill_n(image->data(), 12, static_cast<unsigned char>(200));
    image->setWriteHint(osg::Image::STORE_INLINE);
    osg::StateSet& state = *triangle->getOrCreateStateSet();
    state.setTextureAttributeAndModes(0, new osg::Texture2D(image));
    state.setAttributeAndModes(new osg::Material);
    triangle->setName("a \"triangle\" {");
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const double x : {1.0, 2.0}) {
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
        place->setMatrix(osg::Matrix::translate(x, 0, 0));
        place->addChild(triangle);
        scene->addChild(place);
    }
    scene->setNodeMask(0xfffffff0u);
    return scene;
}

std::string saved(const std::string& format) {
    const std::string path = scratch("whole." + format, {});
    const osg::ref_ptr<osgDB::Options> inlined = new osgDB::Options("WriteImageHint=IncludeData");
    EXPECT_TRUE(osgDB::writeNodeFile(*makeScene(), path, inlined.get()));
    return test::fileText(path);
}

std::string whyRefused(const std::string& path, const std::string& options = {}) {
    try {
        read(path, options);
        return "read";
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
}

const std::string kHead = "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n";

std::string object(const std::string& name, int id, const std::string& fields) {
    return name + " {\nUniqueID " + std::to_string(id) + "\n" + fields + "}\n";
}

std::string nestedGroups(int deep) {
    std::string text;
    for (int i = 1; i <= deep; ++i)
        text += "osg::Group {\nUniqueID " + std::to_string(i) + "\nChildren 1 {\n";
    text += object("osg::Group", deep + 1, "");
    for (int i = 0; i < deep; ++i) text += "}\n}\n";
    return text;
}

/// Each twice below the one before.
std::string doubled(int levels) {
    std::string text = object("osg::Group", levels, "");
    for (int i = levels - 1; i > 0; --i)
        text = object("osg::Group", i,
                      "Children 2 {\n" + text + object("osg::Group", i + 1, "") + "}\n");
    return text;
}

const std::string kPlaces = "VertexArray TRUE {\n" +
                            object("osg::Vec3Array", 8,
                                   "Binding BIND_PER_VERTEX\nvector 3 {\n"
                                   "0 0 0\n1 0 0\n0 1 0\n}\n") +
                            "}\n";
std::string geometry(const std::string& sets) {
    return object("osg::Geometry", 1, "UseVertexBufferObjects TRUE\n" + sets + kPlaces);
}
std::string elements(const std::string& vector) {
    return geometry("PrimitiveSetList 1 {\n" +
                    object("osg::DrawElementsUInt", 7, "Mode TRIANGLES\n" + vector) + "}\n");
}

std::string animation(const std::string& keys) {
    return object("osgAnimation::Animation", 3,
                  "Name \"a\"\nChannels 1 {\nType Vec3LinearChannel {\nName \"translate\"\n"
                  "TargetName \"b\"\nKeyFrameContainer TRUE 2 {\n" +
                      keys + "}\n}\n}\n");
}

struct Hostile {
    const char* name;
    std::string text;
    const char* message;
};

const Hostile kHostile[] = {
    {"Empty", "", "it ends too early"},
    {"NoNode", object("osg::Material", 1, ""), "no node"},
    {"Deep", nestedGroups(20000), "at most 1000 deep (option maxDepth)"},
    {"Itself", object("osg::Group", 1, "Children 1 {\n" + object("osg::Group", 1, "") + "}\n"),
     "object 1 is a part of itself"},
    {"ItselfWithCallback",
     object("osg::Group", 1,
            "UpdateCallback TRUE {\n" + object("osg::NodeCallback", 2, "") + "}\nChildren 1 {\n" +
                object("osg::Group", 3, "Children 1 {\n" + object("osg::Group", 1, "") + "}\n") +
                "}\n"),
     "object 1 is a part of itself"},
    {"Doubled", doubled(60), "are shown more often than"},
    {"ManyChildren", object("osg::Group", 1, "Children 4000000000 {\n}\n"), "4000000000 elements"},
    {"LongArray",
     object("osg::Geometry", 1,
            "VertexArray TRUE {\n" + object("osg::Vec3Array", 8, "vector 4000000000\n") + "}\n"),
     "4000000000 elements"},
    {"ManySets", object("osg::Geometry", 1, "PrimitiveSetList 4000000000\n"), "4000000000 element"},
    {"SetIsNone", geometry("PrimitiveSetList 1 {\nNULL\n}\n"), "expected a primitive set"},
    {"SetIsANode", geometry("PrimitiveSetList 1 {\n" + object("osg::Group", 7, "") + "}\n"),
     "expected a primitive set"},
    {"SetIsAnArray",
     object("osg::Group", 1,
            "Children 2 {\n" + object("osg::Geometry", 2, kPlaces) +
                object("osg::Geometry", 3,
                       "PrimitiveSetList 1 {\n" + object("osg::DrawArrays", 8, "") + "}\n") +
                "}\n"),
     "expected a primitive set"},
    // OSG goes on without what a serializer refuses.
    {"SetIsRefused",
     geometry("PrimitiveSetList 1 {\n" +
              object("osg::DrawElementsUInt", 7,
                     "BufferObject TRUE {\n" +
                         object("osgSkin::SharedSkinModel", 8, "Model {\n99\n}\n") + "}\n") +
              "}\n"),
     "a row of 99 words"},
    {"TexCoordsAreNone",
     object("osg::Geometry", 1,
            kPlaces + "TexCoordArrayList 2 {\nNULL\n" +
                object("osg::Vec2Array", 9, "Binding BIND_PER_VERTEX\n") + "}\n"),
     "an array of 0 elements"},
    {"FarCorner", elements("vector 3 {\n0 1 3\n}\n"), "names vertex 3, expected less than 3"},
    {"HalfATriangle", elements("vector 2 {\n0 1\n}\n"), "a multiple of 3"},
    {"LongRange",
     geometry("PrimitiveSetList 1 {\n" +
              object("osg::DrawArrays", 7, "Mode TRIANGLES\nCount 2147483647\n") + "}\n"),
     "primitives beyond its 3 vertices"},
    {"KeysOutOfOrder",
     object("osg::Group", 1,
            "UpdateCallback TRUE {\n" +
                object("osgAnimation::BasicAnimationManager", 2,
                       "Animations 1 {\n" + animation("2 0 0 0\n1 0 0 0\n") + "}\n") +
                "}\n"),
     "not in order"},
    {"KeysAtNoTime",
     object("osg::Group", 1,
            "UpdateCallback TRUE {\n" +
                object("osgAnimation::BasicAnimationManager", 2,
                       "Animations 1 {\n" + animation("1 0 0 0\n1e999 0 0 0\n") + "}\n") +
                "}\n"),
     "times of keys"},
    {"CallbackIsANode",
     object("osg::Group", 1, "UpdateCallback TRUE {\n" + object("osg::Group", 2, "") + "}\n"),
     "object 2 of class \"osg::Group\", expected one of a class that can stand there"},
    {"AnimationIsAManager",
     object("osg::Group", 1,
            "UpdateCallback TRUE {\n" +
                object("osgAnimation::BasicAnimationManager", 2,
                       "Animations 1 {\n" + object("osgAnimation::BasicAnimationManager", 3, "") +
                           "}\n") +
                "}\n"),
     "object 3 of class"},
    {"UnknownBinding", object("osg::Vec3Array", 1, "Binding 77\nvector 0\n"),
     "a binding of \"77\""},
    {"NoNumber", object("osg::Vec3Array", 1, "vector 1 {\n0 banana 0\n}\n"),
     "line 7: \"banana\", expected a number"},
    {"DecimalComma", object("osg::Vec3Array", 1, "vector 1 {\n0 -1,5 0\n}\n"),
     "line 7: \"-1,5\", expected a number"},
    {"NotANumber", object("osg::Vec3Array", 1, "vector 1 {\n0 nan 0\n}\n"),
     "line 7: \"nan\", expected a number"},
    {"Infinite", object("osg::Vec3Array", 1, "vector 1 {\n0 -inf 0\n}\n"),
     "line 7: \"-inf\", expected a number"},
    {"NoIndex", elements("vector 3 {\n0 one 2\n}\n"), "\"one\", expected a whole number"},
    {"HalfAnIndex", elements("vector 3 {\n0 1.5 2\n}\n"), "\"1.5\", expected a whole number"},
    {"NoTruth", object("osg::Geometry", 1, "UseVertexBufferObjects yes\n"),
     "line 6: \"yes\", expected TRUE or FALSE"},
    {"NoEnumerator", object("osg::BlendFunc", 1, "SourceRGB BANANAS\n"),
     "line 6: \"BANANAS\", expected a name"},
    {"UnknownClass", object("osg::HeightField", 1, ""), "class \"osg::HeightField\""},
    {"ClassOfAPath", object("../../x::y", 1, ""), "class \"../../x::y\""},
    {"ClassWithoutReader", object("osgAnimation::Nothing", 1, ""),
     "class \"osgAnimation::Nothing\", expected one that"},
    {"ClassOfATerminal", object("osgAnimation::\x1b[31mRED\x07", 1, ""), "class \"osgAnimation::"},
    {"MisspeltProperty", object("osg::Group", 1, "Nmae \"a\"\nNodeMask 0x1\n"),
     "line 6: \"Nmae\", expected a property of osg::Group at its place"},
    {"PropertyTwice", object("osg::Group", 1, "Name \"a\"\nName \"b\"\n"),
     "line 7: \"Name\", expected a property of osg::Group"},
    {"ManyInstances",
     geometry("PrimitiveSetList 1 {\n" +
              object("osg::DrawArrays", 7, "NumInstances 1000000000\nMode TRIANGLES\nCount 3\n") +
              "}\n"),
     "are shown more often than"},
    {"FarVertex",
     object("osg::Geometry", 1,
            "VertexArray TRUE {\n" +
                object("osg::Vec3Array", 8, "Binding BIND_PER_VERTEX\nvector 1 {\n0 1e30 0\n}\n") +
                "}\n"),
     "vertices that are not finite, or beyond -1e18 to 1e18"},
    {"FarTransform",
     object("osg::MatrixTransform", 1, "Matrix {\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1e39 0 0 1\n}\n"),
     "a matrix with numbers that are not finite, or beyond -1e18 to 1e18"},
    {"RotationOfNoLength",
     object("osg::Group", 1,
            "UpdateCallback TRUE {\n" +
                object("osgAnimation::BasicAnimationManager", 2,
                       "Animations 1 {\n" +
                           object("osgAnimation::Animation", 3,
                                  "Name \"a\"\nChannels 1 {\n"
                                  "Type QuatSphericalLinearChannel {\nName \"rotate\"\n"
                                  "TargetName \"b\"\nKeyFrameContainer TRUE 1 {\n"
                                  "0 0 0 0 0\n}\n}\n}\n") +
                           "}\n") +
                "}\n"),
     "rotations that are not of length 1"},
    {"EndsInAText", object("osg::Group", 1, "Name \"no end"), "it ends within a text"},
};

const char* const kFormats[] = {"osgt", "osgb", "osgx"};

} // namespace

TEST(Saved, HostileTextIsRefused) {
    for (const Hostile& file : kHostile) {
        SCOPED_TRACE(file.name);
        const std::string path = scratch("hostile.osgt", kHead + file.text);
        expectError([&] { read(path); }, "hostile.osgt: ");
        expectError([&] { read(path); }, file.message);
    }
}

/// OSG would go on without all that comes after it.
TEST(Saved, MisspeltElementsAreRefused) {
    const std::string whole = saved("osgx");
    for (const std::string property :
         {"<Children ", "<Matrix ", "<PrimitiveSetList ", "<NodeMask "}) {
        std::string changed = whole;
        const std::size_t at = changed.find(property);
        ASSERT_NE(at, std::string::npos) << property;
        changed[at + 2] = 'q';
        const std::string path = scratch("misspelt.osgx", changed);
        expectError([&] { read(path); }, "misspelt.osgx: ");
    }
    const std::string path = scratch("kept.osgx", whole);
    EXPECT_NE(read(path), nullptr);
}

/// What a last child leaves out is not taken from what stands after it, of its parent.
TEST(Saved, ElementsKeepTheirProperties) {
    const osg::ref_ptr<osg::MatrixTransform> outer =
        new osg::MatrixTransform(osg::Matrixd::translate(1, 2, 3));
    const osg::ref_ptr<osg::MatrixTransform> inner = new osg::MatrixTransform;
    const osg::ref_ptr<osg::Switch> off = new osg::Switch, empty = new osg::Switch;
    outer->addChild(inner);
    inner->addChild(off);
    off->addChild(new osg::Node, false);
    off->addChild(empty, true);
    outer->setUserData(new osg::Group);
    for (const std::string format : kFormats) {
        const std::string path = scratch("nested." + format, {});
        ASSERT_TRUE(osgDB::writeNodeFile(*outer, path));
        const osg::ref_ptr<osg::Node> scene = read(path);
        EXPECT_EQ(textOf(*scene), textOf(*outer)) << format;
    }
}

TEST(Saved, ScenesAreReadAsOsgReadsThem) {
    for (const std::string format : kFormats) {
        const std::string path = scratch("same." + format, saved(format));
        const osg::ref_ptr<osg::Node> theirs = osgDB::readRefNodeFile(path);
        ASSERT_TRUE(theirs);
        EXPECT_EQ(textOf(*read(path)), textOf(*theirs));
        // Ours, with a pose, animations and callbacks.
        const std::string tube = testData("saved/tube." + format);
        EXPECT_EQ(textOf(*read(tube)), textOf(*osgDB::readRefNodeFile(tube)));
    }
}

TEST(Saved, ABeginningAloneIsOne) {
    const std::string whole = saved("osgb");
    for (const std::size_t size : {7u, 8u, 15u})
        expectError([&] { read(scratch("begun.osgb", whole.substr(0, size))); },
                    size < 8 ? "it begins with neither" : "it ends too early");
}

TEST(Saved, CutShortIsReadOrRefused) {
    for (const std::string format : kFormats) {
        const std::string whole = saved(format);
        for (std::size_t size = 0; size < whole.size(); size += 1 + size / 20)
            EXPECT_NE(whyRefused(scratch("cut." + format, whole.substr(0, size))), "");
    }
}

TEST(Saved, AlteredIsReadOrRefused) {
    std::mt19937 random(1);
    for (const std::string format : kFormats) {
        const std::string whole = saved(format);
        for (int round = 0; round < 100; ++round) {
            std::string text = whole;
            for (int change = 0; change < 1 + round % 3; ++change)
                text[random() % text.size()] = static_cast<char>(
                    round % 2 ? random() : static_cast<unsigned>("0129{}\" <>"[random() % 10]));
            EXPECT_NE(whyRefused(scratch("altered." + format, text)), "");
        }
    }
}

TEST(Saved, LengthsAreInTheFile) {
    const std::string whole = saved("osgb");
    // Whatever a number stands for: no more time and memory than the file is worth.
    for (std::size_t place = 8; place + 4 < whole.size(); place += 3) {
        std::string text = whole;
        const std::uint32_t number = place % 2 ? 0x7fffffffu : 0xffffffffu;
        std::memcpy(&text[place], &number, sizeof number);
        EXPECT_NE(whyRefused(scratch("long.osgb", text)), "");
    }
}

// OSG unpacks pixels before it looks for their end, and loses them.
TEST(Saved, PixelsEndWithTheirBracket) {
    const std::string whole = saved("osgt");
    const std::size_t pixels = whole.find('"', whole.find("AllocationMode"));
    const std::size_t end = whole.find('"', pixels + 1) + 1, bracket = whole.find('}', end) + 1;
    for (const auto& [place, more] : {std::pair(end, " more"), std::pair(bracket, "more")}) {
        std::string text = whole;
        text.insert(place, more);
        EXPECT_NE(whyRefused(scratch("more.osgt", text)).find("pixels that go on"),
                  std::string::npos);
    }
    std::string text = saved("osgx");
    const std::size_t data = text.find("<Data ", text.find("<AllocationMode "));
    text.replace(text.find("/>", data), 2, "><More attribute=\"1\" /></Data>");
    const std::string why = whyRefused(scratch("more.osgx", text));
    EXPECT_NE(why.find("expected a property"), std::string::npos) << why;
}

TEST(Saved, PicturesThatAreNotThereAreNone) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setFileName("nowhere.png");
    image->setWriteHint(osg::Image::EXTERNAL_FILE);
    scene->getOrCreateStateSet()->setTextureAttribute(0, new osg::Texture2D(image));
    for (const char* format : {"osgt", "osgb", "osgx"}) {
        const std::string path = scratch(std::string("pictured.") + format, {});
        const osg::ref_ptr<osgDB::Options> apart = new osgDB::Options("WriteImageHint=UseExternal");
        ASSERT_TRUE(osgDB::writeNodeFile(*scene, path, apart.get()));
        const osg::ref_ptr<osg::Node> read = osgSkin::readScene(path, nullptr);
        const auto* texture = dynamic_cast<const osg::Texture2D*>(
            read->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        ASSERT_NE(texture, nullptr) << format;
        EXPECT_EQ(texture->getImage(), nullptr) << format;
    }
}

/// What a binary file is to hold is a number, which no enumerator may have.
TEST(Saved, KindsAreScenesAndObjects) {
    const std::string whole = saved("osgb");
    for (const std::uint32_t kind : {0u, 2u, 4u, 0x50001u, 0xffffffffu}) {
        std::string text = whole;
        std::memcpy(&text[8], &kind, sizeof kind);
        expectError([&] { read(scratch("kind.osgb", text)); }, "no scene, expected one");
    }
}

TEST(Saved, ScenesKeepToTheirOptions) {
    const std::string path = scratch("group.osgt", kHead + nestedGroups(5));
    EXPECT_EQ(whyRefused(path), "read");
    EXPECT_EQ(whyRefused(path + ".2.scale"), "read");
    const std::string deep = scratch("itself.osgt", kHead + nestedGroups(2000));
    EXPECT_EQ(whyRefused(deep, "maxDepth=3000"), "read");
    EXPECT_NE(whyRefused(deep + ".2.scale").find("(option maxDepth)"), std::string::npos);
    EXPECT_NE(whyRefused(path, "maxDepth=3").find("at most 3 deep"), std::string::npos);
    const std::string field = scratch("field.osgt", kHead + object("osg::Sequence", 1, ""));
    EXPECT_NE(whyRefused(field).find("(option classes)"), std::string::npos);
    EXPECT_EQ(whyRefused(field, "classes=osgFX,osg::Sequence"), "read");
    EXPECT_EQ(whyRefused(field, "classes=osg"), "read");
    const std::string proxy =
        scratch("proxy.osgt", kHead + object("osg::ProxyNode", 1,
                                             "FileNames 1 {\n\"" + std::to_string(::getpid()) +
                                                 "proxy.osgt\"\n}\n"));
    EXPECT_NE(whyRefused(proxy, "classes=osg").size(), 0u); // ends
}

/// As a hand or OSG itself may write them.
TEST(Saved, NumbersAreReadInEveryFormThatOsgReads) {
    const auto box = [](const std::string& row) {
        const std::string vector = "vector 1 {\n" + row + "\n}\n";
        const std::string path = scratch(
            "numbers.osgt",
            kHead + object("osg::Geometry", 1,
                           "VertexArray TRUE {\n" + object("osg::Vec3Array", 2, vector) + "}\n"));
        const osg::ref_ptr<osg::Node> node = read(path);
        return static_cast<osg::Vec3Array&>(*node->asGeometry()->getVertexArray()).at(0);
    };
    EXPECT_EQ(box("1e1 -.5 +3."), osg::Vec3(10.0f, -0.5f, 3.0f));
    EXPECT_EQ(box("0x10 1E-1 -0"), osg::Vec3(16.0f, 0.1f, 0.0f));
    const std::string masked =
        scratch("mask.osgt", kHead + object("osg::Group", 1, "NodeMask 0xff0f\n"));
    EXPECT_EQ(read(masked)->getNodeMask(), 0xff0fu);
    const std::string shown = scratch(
        "mode.osgt", kHead + geometry("PrimitiveSetList 1 {\n" +
                                      object("osg::DrawArrays", 7, "Mode 4\nCount 3\n") + "}\n"));
    EXPECT_EQ(read(shown)->asGeometry()->getPrimitiveSet(0)->getMode(), GLenum(GL_TRIANGLES));
}
