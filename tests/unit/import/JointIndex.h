// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

/// Index of a joint that must exist; if it does not, fails and returns 0.
inline std::size_t jointIndex(const osgSkin::RestSkeleton& skeleton, const std::string& name) {
    const int j = skeleton.find(name);
    EXPECT_GE(j, 0) << name;
    return static_cast<std::size_t>(std::max(j, 0));
}
