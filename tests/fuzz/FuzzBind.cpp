// SPDX-License-Identifier: MIT
// Any small mesh of any number of shells and any small skeleton, bound by each method. There are
// few different coordinates, so that points coincide and are collinear or coplanar.
#include "Attempt.h"

#include <osgSkinBind/Bind>

#include <cstdint>
#include <cstdlib>

namespace {

using namespace osgSkin;

constexpr std::uint32_t kMaxJoints = 12, kMaxVertices = 120;

class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : _next(data), _end(data + size) {}
    bool isEmpty() const { return _next == _end; }
    std::uint32_t number(std::uint32_t most) { return _next == _end ? 0 : *_next++ % (most + 1); }
    /// Mostly whole numbers, and some close to them.
    glm::dvec3 point() {
        glm::dvec3 p;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t n = number(255);
            p[i] = n < 192 ? n % 12 : (n % 12) + 1e-3 * (n - 192);
        }
        return p;
    }

private:
    const std::uint8_t *_next, *_end;
};

RestSkeleton skeletonOf(Bytes& bytes) {
    const char* names[] = {"Hips",    "Spine",    "LeftArm",   "LeftForeArm", "LeftHand", "Head",
                           "LeftLeg", "LeftFoot", "RightHand", "RightFoot",   "Neck",     "tail"};
    RestSkeleton skeleton;
    const std::uint32_t count = 1 + bytes.number(kMaxJoints - 1);
    for (std::uint32_t j = 0; j < count; ++j) {
        const int parent = j == 0 ? -1 : static_cast<int>(bytes.number(j - 1));
        skeleton.add(names[j], parent, bytes.point());
        if (bytes.number(3) == 0) skeleton.joints.back().tip = bytes.point();
    }
    return skeleton;
}

SkinMesh meshOf(Bytes& bytes) {
    SkinMesh mesh;
    const std::uint32_t count = 3 + bytes.number(kMaxVertices - 3);
    for (std::uint32_t v = 0; v < count; ++v) mesh.positions.push_back(bytes.point());
    while (!bytes.isEmpty()) {
        mesh.faceSizes.push_back(3);
        for (int k = 0; k < 3; ++k) mesh.faceVertices.push_back(bytes.number(count - 1));
    }
    return mesh;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    BindOptions options;
    const std::uint32_t choice = bytes.number(7);
    if (choice & 1) options.method = BindOptions::Method::Paper;
    if (choice & 2) options.shapes = BindOptions::Shapes::None;
    options.muscles = (choice & 4) != 0;
    const RestSkeleton skeleton = skeletonOf(bytes);
    const SkinMesh mesh = meshOf(bytes);
    fuzz::attempt([&] {
        const Binding binding = bind(mesh, skeleton, options);
        binding.validate();
        if (binding.vertexCount() != mesh.positions.size()) std::abort();
    });
    return 0;
}
