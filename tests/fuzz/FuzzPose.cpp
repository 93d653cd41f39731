// SPDX-License-Identifier: MIT
// Any bytes as skinning matrices, then as the joints' own maps: a pose is refused, or all results
// are finite.
#include "Tube.h"

#include <osgSkin/Deform>
#include <osgSkin/PoseBounds>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::size_t kJoints = 3;
constexpr std::size_t kNumbers = 16 * kJoints; ///< of one pose

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void requireFinite(const osgSkin::SkinModel& model, const osgSkin::Pose& pose) {
    osgSkin::DeformOptions options;
    options.normals = true;
    const auto [positions, normals, tangents] = osgSkin::deform(model, pose, options);
    const osgSkin::PoseBounds bounds = computePoseBounds(model, pose);
    if (!isFinite(bounds.low) || !isFinite(bounds.high)) std::abort();
    if (!std::all_of(positions.begin(), positions.end(), isFinite)) std::abort();
    if (!std::all_of(normals.begin(), normals.end(), isFinite)) std::abort();
}

bool setMatrices(osgSkin::Pose& pose, const float* numbers) {
    glm::dmat4 matrices[kJoints] = {glm::dmat4(1.0), glm::dmat4(1.0), glm::dmat4(1.0)};
    for (glm::dmat4& matrix : matrices)
        for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] += double(*numbers++);
    return pose.set(matrices, kJoints);
}

bool setMaps(osgSkin::Pose& pose, const float* numbers) {
    osgSkin::JointMap maps[kJoints];
    for (osgSkin::JointMap& map : maps) {
        map.rotation = glm::normalize(
            glm::dquat(1.0 + double(numbers[0]), numbers[1], numbers[2], numbers[3]));
        map.offset = {numbers[4], numbers[5], numbers[6]};
        map.scale = 1.0 + double(numbers[7]);
        numbers += 8;
    }
    return pose.set(maps, kJoints);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const osg::ref_ptr<const osgSkin::SkinModel> model = test::Tube(5, 4).model();
    osgSkin::Pose pose(model->joints());
    while (size > 0) {
        // Floats reach more kinds of numbers than doubles do.
        float numbers[kNumbers] = {};
        const std::size_t taken = std::min(size, sizeof numbers);
        std::memcpy(numbers, data, taken);
        data += taken;
        size -= taken;
        if (setMatrices(pose, numbers)) requireFinite(*model, pose);
        if (setMaps(pose, numbers)) requireFinite(*model, pose);
    }
    return 0;
}
