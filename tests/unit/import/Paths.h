// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

/// A file of tests/data.
inline std::string testData(const std::string& name) {
    return std::string(OSGSKIN_TEST_DATA) + "/" + name;
}

/// A body or motion of others, which the repository does not hold.
inline std::string sharedData(const std::string& name) {
    return std::string(OSGSKIN_SHARED_DATA) + "/" + name;
}

#define OSGSKIN_NEEDS(path)                                                                        \
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << (path) << ", which is missing"
