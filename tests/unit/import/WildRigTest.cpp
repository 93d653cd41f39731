// SPDX-License-Identifier: MIT
//
// Rigs that are legal and unusual: FBX files with connections of properties, Collada skins and
// morphs of each other, glTF joints outside the scene, Half-Life's bones.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Paths.h"
#include "RiggedModels.h"

#include <osgSkinImport/ImportRig>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace {

using osgSkin::ImportedRig;
using osgSkin::importRig;

std::string saved(const std::string& name, const std::string& bytes) {
    std::string path = testing::TempDir() + name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

// --- FBX ---

/// A record of an FBX file: strings and 64-bit integers, and records inside.
struct Record {
    std::string name;
    std::vector<std::string> properties; ///< encoded, with their type
    std::vector<Record> children;
};

template <typename Number>
std::string bytesOf(Number number) {
    return {reinterpret_cast<const char*>(&number), sizeof number};
}

std::string text(const std::string& value) {
    return 'S' + bytesOf(std::uint32_t(value.size())) + value;
}

std::string id(std::int64_t value) {
    return 'L' + bytesOf(value);
}

template <typename Number>
std::string list(char type, const std::vector<Number>& values) {
    std::string result = type + bytesOf(std::uint32_t(values.size())) + bytesOf(std::uint32_t(0)) +
                         bytesOf(std::uint32_t(values.size() * sizeof(Number)));
    for (const Number value : values) result += bytesOf(value);
    return result;
}

/// Appends a binary record, as of version 7.3.
void append(const Record& record, std::string& file) {
    std::string properties;
    for (const std::string& property : record.properties) properties += property;
    const std::size_t begin = file.size();
    file += bytesOf(std::uint32_t(0)) + bytesOf(std::uint32_t(record.properties.size())) +
            bytesOf(std::uint32_t(properties.size())) + char(record.name.size()) + record.name +
            properties;
    for (const Record& child : record.children) append(child, file);
    if (!record.children.empty()) file += std::string(13, '\0');
    file.replace(begin, 4, bytesOf(std::uint32_t(file.size())));
}

/// A strip of two triangles that follows two bones.
std::vector<Record> fbxRecords(const std::vector<Record>& connections) {
    const auto object = [](const char* kind, std::int64_t number, const std::string& name,
                           const char* type, std::vector<Record> children) {
        children.push_back({"Version", {'I' + bytesOf(std::int32_t(100))}, {}});
        return Record{kind, {id(number), text(name), text(type)}, std::move(children)};
    };
    const auto cluster = [&](std::int64_t number, const std::vector<std::int32_t>& indices,
                             double height) {
        const std::vector<double> ones(indices.size(), 1.0);
        const auto placed = [](double y) {
            return std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, y, 0, 1};
        };
        return object("Deformer", number, std::string("\0\1SubDeformer", 13), "Cluster",
                      {{"Indexes", {list('i', indices)}, {}},
                       {"Weights", {list('d', ones)}, {}},
                       {"Transform", {list('d', placed(-height))}, {}},
                       {"TransformLink", {list('d', placed(height))}, {}}});
    };
    const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 2, 0, 1, 2, 0};
    const auto connect = [](std::int64_t from, std::int64_t to) {
        return Record{"C", {text("OO"), id(from), id(to)}, {}};
    };
    std::vector<Record> all{connect(200, 0),   connect(300, 0),   connect(301, 300),
                            connect(100, 200), connect(400, 100), connect(401, 400),
                            connect(402, 400), connect(300, 401), connect(301, 402)};
    all.insert(all.end(), connections.begin(), connections.end());
    return {{"FBXHeaderExtension", {}, {{"FBXVersion", {'I' + bytesOf(std::int32_t(7300))}, {}}}},
            {"Objects",
             {},
             {object("Geometry", 100, std::string("\0\1Geometry", 10), "Mesh",
                     {{"Vertices", {list('d', corners)}, {}},
                      {"PolygonVertexIndex",
                       {list('i', std::vector<std::int32_t>{0, 1, -3, 1, 3, -3})},
                       {}}}),
              object("Model", 200, std::string("body\0\1Model", 11), "Mesh", {}),
              object("Model", 300, std::string("low\0\1Model", 10), "LimbNode", {}),
              object("Model", 301, std::string("high\0\1Model", 11), "LimbNode", {}),
              object("Deformer", 400, std::string("\0\1Deformer", 10), "Skin", {}),
              cluster(401, {0, 1}, 0.0), cluster(402, {2, 3}, 2.0)}},
            {"Connections", {}, all}};
}

std::string binaryFbx(const std::string& name, const std::vector<Record>& connections) {
    std::string file("Kaydara FBX Binary  \0\x1a\0", 23);
    file += bytesOf(std::uint32_t(7300));
    for (const Record& record : fbxRecords(connections)) append(record, file);
    return saved(name, file + std::string(13, '\0'));
}

/// The same as text.
void append(const Record& record, const std::string& indent, std::string& file) {
    file += indent + record.name + ": ";
    for (std::size_t p = 0; p < record.properties.size(); ++p) {
        const std::string& property = record.properties[p];
        if (p > 0) file += ", ";
        if (property[0] == 'S') {
            const std::string value = property.substr(5);
            const std::size_t mark = value.find('\0');
            file += '"' +
                    (mark == std::string::npos
                         ? value
                         : value.substr(mark + 2) + "::" + value.substr(0, mark)) +
                    '"';
        } else if (property[0] == 'L') {
            std::int64_t number = 0;
            property.copy(reinterpret_cast<char*>(&number), sizeof number, 1);
            file += std::to_string(number);
        } else if (property[0] == 'I') {
            file += "7300";
        } else {
            const bool isInteger = property[0] == 'i';
            const std::size_t width = isInteger ? 4 : 8;
            const std::size_t count = (property.size() - 13) / width;
            file += '*' + std::to_string(count) + " {\n" + indent + "\ta: ";
            for (std::size_t k = 0; k < count; ++k) {
                std::int32_t integer = 0;
                double number = 0.0;
                property.copy(isInteger ? reinterpret_cast<char*>(&integer)
                                        : reinterpret_cast<char*>(&number),
                              width, 13 + k * width);
                file += (k > 0 ? "," : "") +
                        (isInteger ? std::to_string(integer) : std::to_string(number));
            }
            file += '\n' + indent + "}";
        }
    }
    if (!record.children.empty()) {
        file += " {\n";
        for (const Record& child : record.children) append(child, indent + '\t', file);
        file += indent + "}";
    }
    file += '\n';
}

std::string textFbx(const std::string& name, const std::vector<Record>& connections) {
    std::string file = "; FBX 7.3.0 project file\n";
    for (const Record& record : fbxRecords(connections)) append(record, "", file);
    return saved(name, file);
}

/// A constraint's weight drives a bone.
const std::vector<Record> kDriven{{"C", {text("PO"), id(301), text("Lcl Rotation"), id(300)}, {}},
                                  {"C", {text("PO"), id(300), text("Weight"), id(301)}, {}}};

void expectStrip(const ImportedRig& rig) {
    EXPECT_EQ(rig.body.mesh.positions.size(), 6u);
    ASSERT_EQ(rig.rest.joints.size(), 2u);
    EXPECT_EQ(rig.rest.joints[1].name, "high");
    EXPECT_NEAR(rig.rest.joints[1].centre.y, 2.0, 1e-6);
    ASSERT_EQ(rig.body.weights.size(), 2u);
    EXPECT_EQ(rig.body.weights[0].entries.size() + rig.body.weights[1].entries.size(), 6u);
}

// --- Collada ---

/// A triangle with a bone, a morph controller, and a skin; `shown` is the id of the controller in
/// the scene.
std::string collada(const std::string& name, const std::string& morphOf, const std::string& skinOf,
                    const std::string& shown) {
    const auto source = [](const std::string& id, const std::string& numbers, int count,
                           const std::string& kind, int stride, const std::string& type) {
        return "<source id='" + id + "'><" + kind + " id='" + id + "-a' count='" +
               std::to_string(count * stride) + "'>" + numbers + "</" + kind +
               "><technique_common><accessor source='#" + id + "-a' count='" +
               std::to_string(count) + "' stride='" + std::to_string(stride) + "'>" +
               (stride == 3 ? std::string("<param name='X' type='float'/><param name='Y' "
                                          "type='float'/><param name='Z' type='float'/>")
                            : "<param name='P' type='" + type + "'/>") +
               "</accessor></technique_common></source>";
    };
    const auto geometry = [&](const std::string& id, const std::string& corners) {
        return "<geometry id='" + id + "'><mesh>" +
               source(id + "-p", corners, 3, "float_array", 3, "float") + "<vertices id='" + id +
               "-v'><input semantic='POSITION' source='#" + id +
               "-p'/></vertices><triangles count='1'><input semantic='VERTEX' source='#" + id +
               "-v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>\n";
    };
    const std::string unit = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    return saved(
        name,
        "<?xml version='1.0'?>\n<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
        "version='1.4.1'><asset><up_axis>Y_UP</up_axis></asset>\n<library_geometries>" +
            geometry("base", "0 0 0 1 0 0 0 1 0") + geometry("smile", "0 0 0 1 0 0 0 2 0") +
            "</library_geometries>\n<library_controllers>\n<controller id='face'><morph "
            "method='NORMALIZED' source='" +
            morphOf + "'>" + source("targets", "smile", 1, "IDREF_array", 1, "IDREF") +
            source("amounts", "0", 1, "float_array", 1, "float") +
            "<targets><input semantic='MORPH_TARGET' source='#targets'/><input "
            "semantic='MORPH_WEIGHT' source='#amounts'/></targets></morph></controller>\n"
            "<controller id='bound' name='skin'>\n<skin source = \"" +
            skinOf + "\"><bind_shape_matrix>" + unit + "</bind_shape_matrix>" +
            source("names", "bone", 1, "Name_array", 1, "name") +
            source("binds", unit, 1, "float_array", 16, "float4x4") +
            source("weights", "1", 1, "float_array", 1, "float") +
            "<joints><input semantic='JOINT' source='#names'/><input "
            "semantic='INV_BIND_MATRIX' source='#binds'/></joints><vertex_weights count='3'>"
            "<input semantic='JOINT' source='#names' offset='0'/><input semantic='WEIGHT' "
            "source='#weights' offset='1'/><vcount>1 1 1</vcount><v>0 0 0 0 0 0</v>"
            "</vertex_weights></skin></controller>\n</library_controllers>\n"
            "<library_visual_scenes><visual_scene id='scene'><node id='bone' sid='bone' "
            "name='bone' type='JOINT'/><node id='body'><instance_controller url='" +
            shown +
            "'><skeleton>#bone</skeleton></instance_controller></node></visual_scene>"
            "</library_visual_scenes><scene><instance_visual_scene url='#scene'/></scene>"
            "</COLLADA>\n");
}

} // namespace

TEST(WildRig, FbxPropertyConnections) {
    for (const std::vector<Record>& connections : {std::vector<Record>(), kDriven}) {
        expectStrip(importRig(binaryFbx("properties_binary.fbx", connections)));
        expectStrip(importRig(textFbx("properties_text.fbx", connections)));
    }
}

TEST(WildRig, ColladaSkinOfMorph) {
    for (const auto& [morphOf, skinOf, shown] :
         {std::array<const char*, 3>{"#base", "#base", "#bound"},
          {"#base", "#face", "#bound"},
          {"#bound", "#base", "#face"}}) {
        SCOPED_TRACE(shown);
        const ImportedRig rig = importRig(collada("chain.dae", morphOf, skinOf, shown));
        ASSERT_EQ(rig.body.weights.size(), 1u);
        EXPECT_EQ(rig.body.weights[0].bone, "bone");
        EXPECT_EQ(rig.body.weights[0].entries.size(), 3u);
    }
}

TEST(WildRig, RejectsCyclicColladaControllers) {
    expectError([] { importRig(collada("cycle.dae", "#bound", "#face", "#bound")); },
                "expected one of a mesh");
}

TEST(WildRig, JointsOutsideTheScene) {
    test::GltfColumn column;
    column.bend();
    column.json["scenes"][0]["nodes"] = {column.meshNode};
    const ImportedRig rig = importRig(column.save("outside.gltf"));
    ASSERT_EQ(rig.rest.joints.size(), 3u);
    EXPECT_EQ(rig.rest.joints[2].name, "top");
    EXPECT_LT(glm::distance(rig.rest.joints[2].centre, glm::dvec3(0, 2, 0)), 1e-6);
    EXPECT_EQ(rig.body.weights.size(), 3u);
    EXPECT_EQ(rig.animations.size(), 1u);
}

/// Assimp lists all bones of such a model as children of one node.
TEST(WildRig, HalfLifeBoneHierarchy) {
    const std::string path = std::string(test::kModels) + "MDL/MDL (HL1)/man.mdl";
    OSGSKIN_NEEDS(path);
    const osgSkin::RestSkeleton rest = importRig(path).rest;
    std::size_t deepest = 0;
    for (const osgSkin::RestJoint& joint : rest.joints) {
        std::size_t depth = 0;
        for (int up = joint.parent; up >= 0; up = rest.joints[std::size_t(up)].parent) ++depth;
        deepest = std::max(deepest, depth);
    }
    EXPECT_GE(deepest, 2u);
}
