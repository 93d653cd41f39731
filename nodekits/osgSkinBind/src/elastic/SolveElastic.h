// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SOLVEELASTIC_H
#define OSGSKINBIND_ELASTIC_SOLVEELASTIC_H

#include "elastic/ElasticJoint.h"
#include "elastic/ElasticShapes.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace osgSkin {

/// A skin as solveElasticJoint() reads it: welded, so that triangles that touch share vertices.
/// Rest space. May be open and of several shells. Owns nothing.
struct ElasticSkin {
    const std::vector<glm::dvec3>& positions;
    const std::vector<std::array<std::uint32_t, 3>>& triangles;
};

/// Told what is being done and the share of the work that is done, rising from 0 to 1. Called from
/// the threads that work, one at a time. May throw to give up: the exception passes through.
using ElasticProgress = std::function<void(const std::string& what, double share)>;

/// The shapes that flesh takes around a joint: an elastic solid with bones as soft cores and
/// contact in the fold, of voxel cells a third of the limb's radius wide, pinned where its reach
/// ends to what the skin does without it. Deterministic, on any number of threads.
///
/// Never fails by exception: what cannot be solved says why in ElasticShapes::reason or
/// ElasticSample::reason. \pre joint.ratios has an entry for each position
ElasticShapes solveElasticJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                                const ElasticProgress& progress = {});

/// The same for several joints, at once on all processors where oneTBB is built in.
std::vector<ElasticShapes> solveElasticJoints(const ElasticSkin& skin,
                                              const std::vector<ElasticJoint>& joints,
                                              const ElasticProgress& progress = {});

} // namespace osgSkin

#endif
