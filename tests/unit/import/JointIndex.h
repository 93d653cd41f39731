// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

/// Where a joint that must be there is; 0 where it is not, which is a failure.
inline std::size_t jointIndex(const osgSkin::RestSkeleton& skeleton, const std::string& name) {
    const int j = skeleton.find(name);
    EXPECT_GE(j, 0) << name;
    return static_cast<std::size_t>(std::max(j, 0));
}
