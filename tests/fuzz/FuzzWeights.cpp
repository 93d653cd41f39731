// SPDX-License-Identifier: MIT
// Any bytes as a file of painted weights for a body with two joints.
#include "Attempt.h"
#include "InputFile.h"

#include <osgSkinCharacter/ReadWeights>

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kVertices = 56; // as many as the seed's body has
    static const osgSkin::RestSkeleton skeleton = [] {
        osgSkin::RestSkeleton made;
        made.add("base", -1, glm::dvec3(0.0));
        made.add("arm", 0, glm::dvec3(0.0, 0.0, 1.0));
        return made;
    }();
    fuzz::attempt([&] {
        const osgSkin::VertexWeights weights =
            osgSkin::readWeights(fuzz::save("weights.json", data, size), skeleton, kVertices);
        if (weights.size() != kVertices) std::abort();
        for (const auto& joints : weights)
            for (const auto& [joint, weight] : joints)
                if (joint > 1 || !std::isfinite(weight) || weight < 0.0) std::abort();
    });
    return 0;
}
