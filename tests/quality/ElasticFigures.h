// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef QUALITY_ELASTICFIGURES_H
#define QUALITY_ELASTICFIGURES_H

#include "Subject.h"

#include <elastic/SolveElastic.h>

#include <string>
#include <vector>

namespace quality {

struct ElasticRun {
    std::vector<std::string> joints{"LeftForeArm", "LeftLeg", "LeftArm", "LeftUpLeg"};
    std::string folder; ///< where OBJs go; empty: none
};

/// A joint as the elastic solver takes it, to compare with what was made of it.
struct ReferenceJoint {
    osgSkin::ElasticJoint joint;
    std::size_t fitted = 0; ///< of its samples, the first: what the shapes were fitted to
};

/// \param shaped bound with elastic shapes
/// \param name of a joint that has some
ReferenceJoint referenceJointOf(const Subject& shaped, const std::string& name);

/// Binds the body with elastic shapes, solves the joints beside that, and prints a line for each
/// bend: how far linear blending, dual quaternions, the plain skin and the shaped one are from the
/// elastic solid.
/// \throw osgSkin::Error or std::runtime_error where a joint is not there or a file cannot be
///        written
void measureElastic(const Subject& subject, const ElasticRun& run);

} // namespace quality

#endif
