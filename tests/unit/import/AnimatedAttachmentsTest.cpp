// SPDX-License-Identifier: MIT
// Objects without a skin that clips animate by their own nodes, with no joint above.
#include "GltfBuilder.h"
#include "Notices.h"

#include <osgSkinImport/ImportRig>

#include <gtest/gtest.h>
#include <osgAnimation/Skeleton>

#include <string>
#include <vector>

namespace {

using test::GltfColumn;

/// A column with a separate box inside it that a clip moves up, or keeps at its position.
std::string saveBox(const std::string& path, const std::vector<double>& values) {
    GltfColumn column;
    column.bend();
    const nlohmann::json own = column.json["meshes"][0]["primitives"][0];
    column.json["meshes"].push_back(
        {{"name", "box"},
         {"primitives",
          {{{"attributes", {{"POSITION", own["attributes"]["POSITION"]}}},
            {"indices", own["indices"]}}}}});
    const std::size_t shown =
        column.node({{"name", "box"}, {"mesh", 1}, {"scale", {0.5, 0.5, 0.5}}});
    const std::size_t lift = column.node({{"name", "lift"},
                                          {"children", {shown}},
                                          {"translation", {0, 1, 0}},
                                          {"rotation", GltfColumn::turn(30)}});
    column.json["scenes"][0]["nodes"].push_back(lift);
    column.animate("bend", lift, path, {0.0, 1.0}, values);
    return column.save("moved_apart.gltf");
}

/// The warnings about a file.
std::string toldOf(const std::string& file) {
    const test::Notices notices;
    EXPECT_EQ(osgSkin::importRig(file).body.mesh.positions.size(), 48u);
    return notices.text();
}

} // namespace

TEST(AnimatedAttachments, WarnsAboutObjectsThatStayStill) {
    const std::string told =
        "1 objects beside the skeleton are moved by clips; they stay still, \"box\" among them";
    EXPECT_NE(toldOf(saveBox("translation", {0, 1, 0, 0, 2, 0})).find(told), std::string::npos);
    EXPECT_NE(toldOf(saveBox("rotation", GltfColumn::turns({30, 40}))).find(told),
              std::string::npos);
    EXPECT_NE(toldOf(saveBox("scale", {1, 1, 1, 1, 2, 1})).find(told), std::string::npos);
    EXPECT_EQ(toldOf(saveBox("translation", {0, 1, 0, 0, 1, 0})), "");
    EXPECT_EQ(toldOf(saveBox("rotation", GltfColumn::turns({30, 390}))), "");
    EXPECT_EQ(toldOf(saveBox("scale", {1, 1, 1, 1, 1, 1})), "");
}
