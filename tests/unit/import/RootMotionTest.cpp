// SPDX-License-Identifier: MIT
// Which joint's position carries a motion's figure, and what is told of what does not.
#include "GltfBuilder.h"
#include "Notices.h"

#include <osgSkinImport/ImportMotion>

#include <glm/geometric.hpp>

#include <string>
#include <vector>

namespace {

using test::GltfColumn;

constexpr char kOnly[] = "only moves of \"base\" are used";

/// How far the figure goes from its first sample to its last.
double wayOf(const osgSkin::Motion& motion) {
    return glm::distance(motion.rootPositions.front(), motion.rootPositions.back());
}

} // namespace

TEST(RootMotion, NodesMayCountInUnitsOfTheirOwn) {
    for (const double unit : {0.01, 1.0, 100.0, 10000.0}) {
        GltfColumn column;
        const std::size_t armature =
            column.node({{"name", "armature"}, {"children", {0}}, {"scale", {unit, unit, unit}}});
        for (const std::size_t joint : {column.joints[1], column.joints[2]})
            column.json["nodes"][joint]["translation"] = {0, 1.0 / unit, 0};
        column.json["scenes"][0]["nodes"] = {armature};
        column.json.erase("skins"); // a motion only
        column.json.erase("meshes");
        column.json["nodes"][column.meshNode] = {{"name", "empty"}};
        column.animate("walk", column.joints[0], "rotation", {0.0, 1.0},
                       GltfColumn::turns({0, 10}));
        column.animate("walk", column.joints[1], "translation", {0.0, 1.0},
                       {0, 1.0 / unit, 0, 0, 1.05 / unit, 0});
        column.animate("walk", column.joints[2], "rotation", {0.0, 1.0},
                       GltfColumn::turns({0, 10}));
        const osgSkin::Motion motion = osgSkin::importMotion(column.save("units.gltf"));
        ASSERT_EQ(motion.skeleton.joints.front().name, "middle") << unit;
        EXPECT_GT(wayOf(motion), 0.04) << unit;
    }
}

TEST(RootMotion, AnEndCarriesNothing) {
    GltfColumn column;
    column.bend();
    column.animate("bend", column.joints[2], "translation", {0.0, 1.0}, {0, 1, 0, 0, 2, 0});
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(column.save("end.gltf"));
    EXPECT_EQ(motion.skeleton.joints.size(), 3u);
    EXPECT_TRUE(notices.say(kOnly)) << notices.text();
}

TEST(RootMotion, ScalesAreToldOf) {
    for (const double scale : {1.0, 2.0}) {
        GltfColumn column;
        column.bend();
        column.animate("bend", column.joints[2], "scale", {0.0, 1.0},
                       {1, 1, 1, scale, scale, scale});
        const test::Notices notices;
        osgSkin::importMotion(column.save("scaled.gltf"));
        EXPECT_EQ(notices.say("joint \"top\" is scaled, which motions are read without"),
                  scale > 1.0)
            << notices.text();
    }
}
