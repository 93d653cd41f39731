// SPDX-License-Identifier: MIT
// Any words as a saved model (through SkinModel::create()), and any numbers as a rotation to split.
#include "Attempt.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/BendTwist>

#include <cstdlib>
#include <cstring>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::uint32_t> words(size / 4);
    if (!words.empty()) std::memcpy(words.data(), data, 4 * words.size());
    const osg::ref_ptr<osgSkin::SkinModel> model = new osgSkin::SkinModel;
    fuzz::attempt([&] { osgSkin::unpackSkinModel(words, *model); });
    double numbers[7] = {1, 0, 0, 0, 0, 1, 0};
    std::memcpy(numbers, data, std::min(size, sizeof numbers));
    osgSkin::BendTwist split;
    const glm::dquat rotation(numbers[0], numbers[1], numbers[2], numbers[3]);
    if (osgSkin::trySplitBendTwist(rotation, {numbers[4], numbers[5], numbers[6]}, split) &&
        !(std::isfinite(split.bendAngle) && std::isfinite(split.twistAngle) &&
          osgSkin::isFinite(split.bendAxis)))
        std::abort();
    return 0;
}
