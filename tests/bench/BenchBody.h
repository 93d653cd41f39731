// SPDX-License-Identifier: MIT
#pragma once

#include "PaintedWeights.h"

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>
#include <osgSkinRig/Clip>
#include <osgSkinRig/RestSkeleton>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace bench {

/// A whole body (no rigid parts) in one motion, as finely meshed as asked for.
struct Body {
    std::string name;
    osgSkin::RestSkeleton rig;
    osgSkin::Clip clip;
    osgSkin::Binding binding;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> triangles;
    Weights weights;
    /// Skinning matrices of every sample of the clip, [frame][joint].
    std::vector<std::vector<glm::dmat4>> skinning;

    osg::ref_ptr<const osgSkin::SkinModel> model() const;

    /// Mean number of joints that a vertex follows in part: what the deformation's cost depends on.
    double partialPerVertex() const;
};

/// body4k_neutral in a walk where the third-party data is there, else our own thrower.
/// `parts` splits every edge (Subdivide.h); ratios, weights and normals are interpolated.
/// Made once for each kind and kept. `shaped` ones are bound with the shapes "fast".
const Body& body(std::uint32_t parts, bool shaped = false);

} // namespace bench
