// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace quality {

struct NamedPose {
    std::string name;                 ///< clip:frame, the frame as its file counts
    std::vector<glm::dmat4> skinning; ///< G_j of each joint of the rig
};

/// The standard poses: walk, pitch, climb and jump of the CMU motions in `folder`, 36 in all.
/// \throw osgSkin::Error where a file is missing or does not fit the rig
std::vector<NamedPose> standardPoses(const std::string& folder, const Subject& subject);

} // namespace quality
