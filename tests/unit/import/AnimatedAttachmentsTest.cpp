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

TEST(AnimatedAttachments, FollowTheNodeThatAClipMoves) {
    const struct {
        const char* path;
        std::vector<double> values;
        const char* joint;
    } cases[] = {{"translation", {0, 1, 0, 0, 2, 0}, "lift"},
                 {"rotation", GltfColumn::turns({30, 40}), "lift"},
                 {"scale", {1, 1, 1, 1, 2, 1}, "lift"},
                 {"translation", {0, 1, 0, 0, 1, 0}, "scene"},
                 {"rotation", GltfColumn::turns({30, 390}), "scene"},
                 {"scale", {1, 1, 1, 1, 1, 1}, "scene"}};
    for (const auto& c : cases) {
        const osgSkin::ImportedRig rig = osgSkin::importRig(saveBox(c.path, c.values));
        std::size_t bound = 0;
        for (const osgSkin::BoneWeights& bone : rig.body.weights)
            if (bone.bone == c.joint) bound += bone.entries.size();
        EXPECT_EQ(bound, 24u) << c.path << ": " << c.joint;
    }
}

TEST(AnimatedAttachments, AreReported) {
    EXPECT_NE(
        toldOf(saveBox("translation", {0, 1, 0, 0, 2, 0}))
            .find("objects that are neither skinned nor parented to a joint move as their own "
                  "nodes do in the file's clips: \"box\"\n"),
        std::string::npos);
}
