// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/DeformJob>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace test {

/// A deformation kernel: an instruction set, or the scalar reference.
struct Way {
    std::string name;
    std::int64_t target; ///< of Highway; 0: the scalar reference
};

inline std::ostream& operator<<(std::ostream& out, const Way& way) {
    return out << way.name;
}

/// The reference and every instruction set of this machine.
inline std::vector<Way> ways() {
    std::vector<Way> result = {{"reference", 0}};
    for (std::int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1)
        result.push_back({hwy::TargetName(rest & -rest), rest & -rest});
    return result;
}

/// Tests that run once per kernel.
class EachTarget : public testing::TestWithParam<Way> {
protected:
    void SetUp() override {
        if (GetParam().target) hwy::SetSupportedTargetsForTest(GetParam().target);
    }
    void TearDown() override { hwy::SetSupportedTargetsForTest(0); }

    bool run(const osgSkin::DeformJob& job) const {
        return GetParam().target ? job.run() : job.runReference();
    }
};

} // namespace test
