// SPDX-License-Identifier: MIT
#pragma once

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

#define OSGSKIN_NEEDS(path)                                                                        \
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << (path) << ", which is missing"
