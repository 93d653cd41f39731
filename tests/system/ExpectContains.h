// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace test {

/// Expects that a message contains `part`.
inline void expectContains(const std::string& text, const std::string& part,
                           const std::string& context = {}) {
    EXPECT_NE(text.find(part), std::string::npos) << context << '"' << part << "\" in: " << text;
}

} // namespace test
