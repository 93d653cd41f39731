// SPDX-License-Identifier: MIT
// Clips that rotate joints within another joint's uneven scale, which shears its children.
#include "BlendError.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using test::GltfColumn;

/// A column on joints below a base that is longer along one axis, also in its bind pose; "top"
/// rotates about y or x.
GltfColumn uneven(bool isAboutY, double length) {
    GltfColumn column;
    column.json["nodes"][0]["scale"] = {1.0, length, 1.0};
    std::vector<double> matrices;
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 16; ++k)
            matrices.push_back(k == 5       ? 1.0 / length
                               : k == 13    ? -double(j)
                               : k % 5 == 0 ? 1.0
                                            : 0.0);
    column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
    std::vector<double> turns = GltfColumn::turns({0, 60});
    for (std::size_t k = 0; isAboutY && k < turns.size(); k += 4) std::swap(turns[k], turns[k + 1]);
    column.animate("turn", column.joints[2], "rotation", {0.0, 1.0}, turns);
    return column;
}

/// A column below an object, as where a program's armature is scaled as an object.
struct Below : GltfColumn {
    explicit Below(const std::vector<double>& scale) : GltfColumn(uneven(false, 1.0)) {
        object = node({{"name", "Armature"}, {"scale", scale}, {"children", {joints[0]}}});
        json["scenes"][0]["nodes"] = {object, meshNode};
    }
    std::size_t object = 0;
};

std::string notesOf(GltfColumn column, const std::string& options = {}) {
    const test::Notices notices;
    const osgSkin::Character character =
        osgSkin::loadCharacter(column.save("uneven.gltf"), test::loadOptions(options));
    std::string result;
    for (const std::string& note : character.notes) result += note;
    EXPECT_EQ(notices.lines(), character.notes.size()) << notices.text();
    return result;
}

} // namespace

TEST(UnevenGltf, NamesTheObjectAboveTheSkeleton) {
    Below column({1, 2, 1});
    const std::string root = column.json["nodes"][column.joints[0]]["name"];
    test::expectContains(notesOf(column), "the armature or another object above joint \"" + root +
                                              "\" (apply its scale in the program that made the "
                                              "file) scaled");
    column.animate("turn", column.object, "translation", {0.0, 1.0}, {0, 0, 0, 1, 0, 0});
    test::expectContains(notesOf(column),
                         ": \"Armature\" above bone \"top\" in the clip \"turn\" scaled");
}

/// The mesh and all that is below are mirrored then, as they are bound.
TEST(UnevenGltf, MayBeMirroredIfThatStays) {
    for (const std::size_t axis : {0, 1, 2}) {
        SCOPED_TRACE(axis);
        std::vector<double> mirror(3, 1.0);
        mirror[axis] = -1.0;
        Below still(mirror), keyed(mirror), turned(mirror);
        EXPECT_EQ(notesOf(still), "");
        std::vector<double> keys = mirror;
        keys.insert(keys.end(), mirror.begin(), mirror.end());
        keyed.animate("turn", keyed.object, "scale", {0.0, 1.0}, keys);
        EXPECT_EQ(notesOf(keyed), "");
        for (GltfColumn column : {still, keyed})
            EXPECT_LT(test::blendError(column.save("uneven.gltf")).whole, 1e-5);
        keys.insert(keys.end(), {1.0, 1.0, 1.0});
        turned.animate("turn", turned.object, "scale", {0.0, 0.55, 0.75}, keys);
        test::expectContains(notesOf(turned), "bone \"Armature\" in the clip \"turn\" scaled");
    }
}

/// As sockets for weapons and controls of rigs often are. Rigid parts follow any scale.
TEST(UnevenGltf, DoesNotMatterForBonesWithoutSkin) {
    for (const bool hasSkin : {false, true}) {
        GltfColumn column = uneven(false, 1.0);
        if (!hasSkin)
            column.attributes()["JOINTS_0"] =
                column.accessor("VEC4", std::vector<double>(4 * 24, 0.0), 5121);
        column.animate("turn", column.joints[2], "scale", {0.0, 1.0}, {1, 1, 1, 1, 2, 1});
        EXPECT_EQ(notesOf(column).find("scaled non-uniformly") != std::string::npos, hasSkin)
            << notesOf(column);
        EXPECT_EQ(notesOf(column, "rigid=top"), hasSkin ? "" : notesOf(column));
    }
}

TEST(UnevenGltf, WarnsAboutShear) {
    test::expectContains(notesOf(uneven(false, 2.0)),
                         "bone \"top\" in the clip \"turn\" scaled non-uniformly");
    EXPECT_EQ(notesOf(uneven(true, 2.0)), "") << "about the axis that is longer";
    EXPECT_EQ(notesOf(uneven(false, 1.0)), "");
}
