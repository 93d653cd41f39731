// SPDX-License-Identifier: MIT
#pragma once

#include "core/SimdTargets.h"

#include <osgSkin/Deform>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace test {

/// A deformation kernel: an instruction set, or the scalar reference.
struct Target {
    std::string name;
    std::int64_t bit; ///< of Highway; 0: the scalar reference
};

inline std::ostream& operator<<(std::ostream& out, const Target& target) {
    return out << target.name;
}

/// The reference and every instruction set of this machine.
inline std::vector<Target> allTargets() {
    std::vector<Target> result = {{"reference", 0}};
    for (std::int64_t rest = osgSkin::simdTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1)
        result.push_back({hwy::TargetName(rest & -rest), rest & -rest});
    return result;
}

/// Tests that run once per kernel.
class EachTarget : public testing::TestWithParam<Target> {
protected:
    void SetUp() override { osgSkin::setSimdTargets(GetParam().bit); }
    void TearDown() override { osgSkin::setSimdTargets(0); }

    bool isReference() const { return GetParam().bit == 0; }

    osgSkin::DeformedVertices deform(const osgSkin::SkinModel& model, const osgSkin::Pose& pose,
                                     osgSkin::DeformOptions options = {}) const {
        options.reference = isReference();
        return osgSkin::deform(model, pose, options);
    }
};

/// Deforms part by part, the last one first.
inline osgSkin::DeformedVertices deformInParts(const osgSkin::SkinModel& model,
                                               const osgSkin::Pose& pose,
                                               const osgSkin::DeformOptions& options = {}) {
    const std::size_t count = model.vertexCount();
    osgSkin::DeformedVertices result;
    result.positions.resize(count);
    result.normals.resize(options.normals ? count : 0);
    result.tangents.resize(options.restTangents ? count : 0);
    osgSkin::DeformJob job;
    job.model = &model;
    job.pose = &pose;
    job.positions = result.positions.data();
    job.normals = options.normals ? result.normals.data() : nullptr;
    job.restTangents = options.restTangents;
    job.tangents = options.restTangents ? result.tangents.data() : nullptr;
    job.positionCount = job.normalCount = job.tangentCount = count;
    EXPECT_GE(job.partCount(), 2u);
    for (std::size_t part = job.partCount(); part-- > 0;) EXPECT_TRUE(job.runPart(part));
    EXPECT_FALSE(job.runPart(job.partCount())) << "no such part";
    return result;
}

} // namespace test
