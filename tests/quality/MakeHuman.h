// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <string>
#include <vector>

namespace quality {

/// The shapes of MakeHuman's bodies in the shared data.
inline const std::vector<std::string> kShapes{"neutral", "male",       "female",
                                              "child",   "female_old", "male_heavy"};

/// The files of a shape with about 4,000 vertices.
/// \param rig "cmu_mb", "game_engine" or "default"
inline SubjectFiles makeHumanFiles(const std::string& shape, const std::string& rig = "cmu_mb") {
    const std::string folder = OSGSKIN_SHARED_DATA "/makehuman/";
    SubjectFiles files;
    files.body = folder + "body/body4k_" + shape + ".obj";
    files.rig = folder + "rig/" + rig + "_" + shape + ".bvh";
    files.weights = folder + "weights/body4k_weights_" + rig + ".json";
    return files;
}

/// The bone heat weights of a shape, for the rig "cmu_mb".
inline std::string makeHumanHeat(const std::string& shape) {
    return OSGSKIN_SHARED_DATA "/makehuman/heat/body4k_" + shape + ".json";
}

/// The shape whose files these are, empty where they are another body's.
inline std::string shapeOf(const SubjectFiles& files) {
    for (const std::string& shape : kShapes)
        if (makeHumanFiles(shape).body == files.body) return shape;
    return {};
}

} // namespace quality
