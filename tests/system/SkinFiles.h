// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <string>

namespace test {

/// The folder of the tests' tube: `body.obj`, `rig.bvh`, `move.bvh` and `good.skin`.
const std::string kTubeFolder = OSGSKIN_TEST_DATA "/character/";

/// Writes a `.skin` file; returns its path.
/// \param members after the skeleton's, each with a comma before it
/// \param skeleton a file, or an object such as {"fit": true}; empty: none
inline std::string saveSkin(const std::string& path, const std::string& members = {},
                            const std::string& mesh = kTubeFolder + "body.obj",
                            const std::string& skeleton = kTubeFolder + "rig.bvh") {
    std::ofstream file(path);
    file << R"({"osgskin": 1, "mesh": ")" << mesh << '"';
    if (!skeleton.empty()) {
        const char* const quote = skeleton[0] == '{' ? "" : "\"";
        file << R"(, "skeleton": )" << quote << skeleton << quote;
    }
    file << members << '}';
    return path;
}

} // namespace test
