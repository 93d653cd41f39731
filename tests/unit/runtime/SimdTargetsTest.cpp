// SPDX-License-Identifier: MIT
#include "core/SimdTargets.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace {

/// This program is linked with Highway's library, which osgSkin is not.
TEST(SimdTargets, AreThoseThatHighwaysLibraryFinds) {
    const std::int64_t ours = osgSkin::simdTargets() & HWY_TARGETS;
    EXPECT_EQ(ours, hwy::SupportedTargets() & HWY_TARGETS);
    EXPECT_NE(ours, 0);
}

} // namespace
