// SPDX-License-Identifier: MIT
#include "ExpectError.h"
#include "NamedCase.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>

namespace {

class BadMesh : public testing::TestWithParam<BadFile> {};

TEST_P(BadMesh, IsRefusedWithFileAndPlace) {
    const std::string path = testData(std::string("mesh/") + GetParam().file);
    ASSERT_TRUE(std::filesystem::exists(path));
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadMesh,
    testing::Values(
        BadFile{"empty.obj", "no face, expected at least one"},
        BadFile{"no_faces.obj", "no face, expected at least one"},
        BadFile{"nan_vertex.obj", "line 2: \"nan\" in a \"v\" line, expected 3 finite numbers"},
        BadFile{"word_vertex.obj", "line 2: \"zero\" in a \"v\" line"},
        BadFile{"trailing_letters.obj", "line 2: \"0x\" in a \"v\" line"},
        BadFile{"short_vertex.obj", "line 2: nothing in a \"v\" line"},
        BadFile{"huge_vertex.obj", "line 2: \"1e999\" in a \"v\" line"},
        BadFile{"zero_index.obj", "line 4: \"0\" in a face, expected a vertex from 1 to 3"},
        BadFile{"index_too_large.obj", "line 4: \"4\" in a face, expected a vertex from 1 to 3"},
        BadFile{"index_too_negative.obj", "line 4: \"-4\" in a face"},
        BadFile{"index_beyond_integers.obj", "line 4: \"99999999999999999999\" in a face"},
        BadFile{"word_index.obj", "line 4: \"three\" in a face"},
        BadFile{"texture_index_too_large.obj", "line 5: \"3/2\" in a face"},
        BadFile{"two_corners.obj", "line 4: a face with 2 corners"},
        BadFile{"face_of_256.obj", "line 257: a face with 256 corners"},
        BadFile{"nan_vertex.ply", "mesh: vertex 2 has a coordinate that is not finite"},
        BadFile{"index_too_large.ply", "face 0 names vertex 9, expected less than 4"},
        BadFile{"too_many_elements.ply", "line 3: \"4000000000\" elements, expected no more"},
        BadFile{"list_too_long.ply", "element \"face\" 1: a list of 4294967295 entries"},
        BadFile{"list_too_long_binary.ply", "element \"face\" 0: a list of 4294967295 entries"},
        BadFile{"list_negative_big_endian.ply", "element \"face\" 0: a list of -1 entries"},
        BadFile{"list_by_float.ply", "line 8: \"float\" counts no entries"},
        BadFile{"too_many_vertices.off", "\"353535235358\" vertices, expected no more"},
        BadFile{"too_many_faces.off", "\"99999999999\" faces, expected no more"},
        BadFile{"no_header_end.ply", "the header has no end"},
        BadFile{"truncated.ply", "element \"vertex\" 0: the file ends here"},
        BadFile{"broken.osgt", ""}, BadFile{"unknown.format", ""},
        BadFile{"../bvh/two_joints.bvh", "no face"}),
    nameOf);

TEST(MeshErrors, MissingFileNamesTheReason) {
    for (const char* name : {"mesh/none.obj", "mesh/none.ply", "mesh/none.osgt", "mesh/none.zzz"}) {
        const std::string path = testData(name);
        expectError([&] { osgSkin::importMesh(path); }, path + ": cannot open: No such file");
    }
}

} // namespace
