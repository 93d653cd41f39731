// SPDX-License-Identifier: MIT
// Any bytes as skinning matrices: a pose is refused, or all that comes of it is finite.
#include "Tube.h"

#include <osgSkin/DeformJob>
#include <osgSkin/PoseBounds>

#include <cmath>
#include <cstdlib>
#include <cstring>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const test::Tube tube(5, 4);
    static const osg::ref_ptr<const osgSkin::SkinModel> model = tube.model();
    static std::vector<glm::vec3> positions(model->vertexCount()), normals(model->vertexCount());
    osgSkin::Pose pose(model->joints());
    std::vector<glm::dmat4> matrices(3, glm::dmat4(1.0));
    while (size > 0) {
        // Floats reach more kinds of numbers than doubles do.
        float numbers[48];
        const std::size_t taken = std::min(size, sizeof numbers);
        std::memset(numbers, 0, sizeof numbers);
        std::memcpy(numbers, data, taken);
        for (int m = 0; m < 3; ++m)
            for (int k = 0; k < 16; ++k)
                matrices[std::size_t(m)][k / 4][k % 4] += double(numbers[16 * m + k]);
        data += taken;
        size -= taken;
        if (!pose.set(matrices.data(), matrices.size())) continue;
        osgSkin::DeformJob job;
        job.model = model.get();
        job.pose = &pose;
        job.positions = positions.data();
        job.normals = normals.data();
        job.positionCount = job.normalCount = positions.size();
        job.run();
        const osgSkin::PoseBounds bounds = computePoseBounds(*model, pose);
        for (const glm::vec3& v : {bounds.low, bounds.high})
            if (!std::isfinite(v.x + v.y + v.z)) std::abort();
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const glm::vec3& p = positions[v];
            const glm::vec3& n = normals[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
            if (!std::isfinite(n.x) || !std::isfinite(n.y) || !std::isfinite(n.z)) std::abort();
        }
    }
    return 0;
}
