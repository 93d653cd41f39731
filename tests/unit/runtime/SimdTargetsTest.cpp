// SPDX-License-Identifier: MIT
#include "core/SimdTargets.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace {

/// This program is linked with Highway's library, which osgSkin is not. Its newer versions also
/// know targets of single families of processors, such as AVX3_ZEN4, which osgSkin does not use.
TEST(SimdTargets, AreThoseThatHighwaysLibraryFinds) {
    const std::int64_t known =
        HWY_STATIC_TARGET | HWY_SSSE3 | HWY_SSE4 | HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL;
    const std::int64_t ours = osgSkin::simdTargets() & HWY_TARGETS;
    EXPECT_EQ(ours, hwy::SupportedTargets() & HWY_TARGETS & known);
    EXPECT_NE(ours, 0);
}

} // namespace
