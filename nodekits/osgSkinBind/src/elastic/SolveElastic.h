// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SOLVEELASTIC_H
#define OSGSKINBIND_ELASTIC_SOLVEELASTIC_H

#include "elastic/joint/ElasticJoint.h"
#include "elastic/joint/ElasticShapes.h"
#include "elastic/joint/ElasticSkin.h"

#include <osgSkinBind/Progress>

#include <vector>

namespace osgSkin {

/// The shapes that flesh takes around a joint: an elastic solid with bones as soft cores and
/// contact in the fold, of voxel cells a third of the limb's radius wide, pinned where its reach
/// ends to what the skin does without it. Deterministic, on any number of threads.
///
/// What cannot be solved says why in ElasticShapes::reason or ElasticSample::reason.
///
/// \param skin outlives the call
/// \param joint with a ratio for each of the skin's vertices
/// \param progress told of each sample that is done, from the calling thread; what it throws passes
///        through
/// \return the solid's shapes at the joint's samples
ElasticShapes solveElasticJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                                const Progress& progress = {});

/// The same for several joints, at once on all processors where oneTBB is built in. Of two joints
/// that are each other's mirror image, skin and bones included, one is solved and the other gets
/// its shapes mirrored, and no progress of its own.
std::vector<ElasticShapes> solveElasticJoints(const ElasticSkin& skin,
                                              const std::vector<ElasticJoint>& joints,
                                              const Progress& progress = {});

} // namespace osgSkin

#endif
