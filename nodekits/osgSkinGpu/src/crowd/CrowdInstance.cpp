// SPDX-License-Identifier: MIT
#include <osgSkinGpu/CrowdInstance>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgSkin {
namespace {

unsigned int bitsOf(double number) {
    const auto rounded = static_cast<float>(number);
    unsigned int word;
    std::memcpy(&word, &rounded, sizeof word);
    return word;
}

unsigned int byteOf(float share) {
    return static_cast<unsigned int>(std::lround(std::clamp(share, 0.0f, 1.0f) * 255.0f));
}

} // namespace

void CrowdInstance::pack(osg::Vec4ui* texels) const {
    texels[0] = {bitsOf(position.x()), bitsOf(position.y()), bitsOf(position.z()),
                 bitsOf(double(scale))};
    texels[1] = {bitsOf(rotation.x()), bitsOf(rotation.y()), bitsOf(rotation.z()),
                 bitsOf(rotation.w())};
    texels[2] = {bitsOf(phase), bitsOf(double(speed)), bitsOf(otherPhase),
                 bitsOf(double(otherSpeed))};
    texels[3] = {(clip & 0xffffu) | otherClip << 16, bitsOf(double(blend)),
                 byteOf(colour.x()) | byteOf(colour.y()) << 8 | byteOf(colour.z()) << 16 |
                     byteOf(colour.w()) << 24,
                 0};
}

} // namespace osgSkin
