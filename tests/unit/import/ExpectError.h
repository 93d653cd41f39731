// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Error>

#include <gtest/gtest.h>

#include <string>

/// Expects `action` to throw an osgSkin::Error with a one-line message that contains `part`.
template <typename Action>
void expectError(const Action& action, const std::string& part) {
    try {
        action();
        ADD_FAILURE() << "nothing was thrown, expected an error with: " << part;
    } catch (const osgSkin::Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(part), std::string::npos) << what << "\nexpected in it: " << part;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
}
