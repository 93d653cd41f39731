// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <ostream>
#include <string>

/// A malformed file and parts of its error message.
struct BadFile {
    const char* file;
    const char* message;
};

inline void PrintTo(const BadFile& bad, std::ostream* out) {
    *out << bad.file;
}

/// Derives a test's name from its file's.
inline std::string nameOf(const testing::TestParamInfo<BadFile>& info) {
    std::string name = info.param.file;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}
