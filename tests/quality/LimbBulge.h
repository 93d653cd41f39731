// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <glm/mat4x4.hpp>

namespace quality {

/// How far limbs swell: over the skin that the painted weights give to upper arms, forearms,
/// thighs and shins most of all, the largest distance to the nearest posed bone over that to the
/// nearest rest bone.
class LimbBulge {
public:
    explicit LimbBulge(const Subject& subject);

    double of(const compare::Points& posed, const std::vector<glm::dmat4>& skinning) const;

private:
    const Subject& _subject;
    std::vector<std::uint32_t> _vertices;
    std::vector<compare::Segment> _bones; ///< at rest
    std::vector<std::size_t> _jointOfBone;
};

} // namespace quality
