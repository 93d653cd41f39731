// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/version.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

/// The path of a file in tests/data.
inline std::string testData(const std::string& name) {
    return std::string(OSGSKIN_TEST_DATA) + "/" + name;
}

/// The path of a third-party body or motion, which is not in the repository.
inline std::string sharedData(const std::string& name) {
    return std::string(OSGSKIN_SHARED_DATA) + "/" + name;
}

/// For tests that hold Assimp's reading of a file against ours. Later versions number the vertices
/// of glTF files anew, and read more of Assimp's own test models.
inline bool isAssimp52() {
    return aiGetVersionMajor() == 5 && aiGetVersionMinor() == 2;
}

#define OSGSKIN_NEEDS(path)                                                                        \
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << (path) << ", which is missing"
